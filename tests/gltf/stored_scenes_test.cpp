#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "gltf/files.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/names.h"
#include "tandem/gltf/load_scene.h"

namespace tandem {
namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIR) + "/assets/scenes/";

TEST(PaperFile, HoldsTheSceneOfTheSameName) {
    const Scene file = load_scene(scenes + "paper.gltf");
    const Scene named = load_scene("named:paper");
    EXPECT_EQ(file.name, named.name);
    ASSERT_EQ(file.nodes.size(), named.nodes.size());
    for (std::size_t i = 0; i < named.nodes.size(); ++i) EXPECT_EQ(file.nodes[i].name, named.nodes[i].name);
    for (std::size_t i = 0; i < named.materials.size(); ++i) {
        EXPECT_EQ(file.materials[i].name, named.materials[i].name);
    }
    EXPECT_EQ(frame_count(file), 120);
    EXPECT_EQ(file.display, named.display);
    EXPECT_EQ(named.display, (Display{TransferFunction::linear})) << "the paper's mapping: clamped, no gamma";
    for (int frame = 0; frame < 120; ++frame) {
        ASSERT_EQ(scene_hash(prepare(file, {frame, ""})), scene_hash(prepare(named, {frame, ""}))) << "frame " << frame;
    }
}

/// The scenes beside their scripts, and what each calls for.
struct StoredScene {
    const char* name;
    EffectMask effects;
};
void PrintTo(const StoredScene& scene, std::ostream* out) { *out << scene.name; }

const EffectMask emissive = Effect::emission | Effect::area_lights | Effect::shadows;
const StoredScene stored_scenes[] = {
    {"paper", {}},
    {"plain", {}},
    {"mirrors", Effect::shadows | Effect::reflection},
    {"glass", Effect::shadows | Effect::refraction | Effect::absorption | Effect::nested_media},
    {"lens", emissive | Effect::lens},
    {"soft-shadows", emissive},
    {"textured", Effect::shadows | Effect::textures | Effect::normal_maps | Effect::cutouts},
    {"motion", Effect::shadows | Effect::motion_blur},
    {"whitted", emissive | Effect::inverse_square | Effect::spot_lights | Effect::directional_lights |
                    Effect::reflection | Effect::refraction | Effect::absorption | Effect::nested_media |
                    Effect::textures | Effect::normal_maps | Effect::cutouts | Effect::environment_light |
                    Effect::indirect | Effect::roulette | Effect::lens},
    {"metals", emissive | Effect::microfacets | Effect::textures | Effect::inverse_square | Effect::environment_light |
                   Effect::indirect | Effect::roulette},
};

class SceneScript : public test::GltfFiles, public ::testing::WithParamInterface<StoredScene> {};

// The compressed pictures in a file may differ between versions of zlib, the scene may not.
TEST_P(SceneScript, WritesTheStoredScene) {
    const std::string python = TANDEM_PYTHON;
    if (python.empty()) GTEST_SKIP() << "no python3 was found when configuring";
    const std::string name = GetParam().name;
    const auto target = folder_ / (name + ".gltf");
    const std::string command = "'" + python + "' -B '" + scenes + name + ".py' '" + target.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const Scene written = load_scene(target.string()), stored = load_scene(scenes + name + ".gltf");
    const PreparedScene prepared = prepare(stored);
    EXPECT_EQ(scene_hash(prepare(written)), scene_hash(prepared))
        << "run assets/scenes/" << name << ".py and commit what it writes";
    EXPECT_EQ(written.display, stored.display);
    EXPECT_EQ(to_string(mask_of(derive_effects(stored, prepared))), to_string(GetParam().effects));
}

INSTANTIATE_TEST_SUITE_P(Assets, SceneScript, ::testing::ValuesIn(stored_scenes), [](const auto& info) {
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace tandem

// The names of effects, and what calls for them.

#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/names.h"
#include "tandem/effects/variants.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

std::string reasons(const Scene& scene) {
    std::string text;
    for (const EffectNeed& need : derive_effects(scene, prepare(scene))) {
        text += std::string(to_string(need.effect)) + ": " + need.reason + "\n";
    }
    return text;
}

TEST(Effects, HaveTheirNames) {
    EXPECT_EQ(effect_names().size(), effect_count);
    EXPECT_EQ(to_string(EffectMask()), "none");
    EXPECT_EQ(to_string(Effect::shadows | Effect::refraction), "shadows, refraction");
    for (const EffectName& entry : effect_names())
        EXPECT_EQ(parse_effects(std::string("+") + entry.name).on, entry.effect);
}

TEST(Effects, AreForcedByWords) {
    EXPECT_EQ(parse_effects(""), ForcedEffects{});
    const ForcedEffects mixed = parse_effects("-shadows,+refraction");
    EXPECT_EQ(mixed.off, EffectMask(Effect::shadows));
    EXPECT_EQ(mixed.on, EffectMask(Effect::refraction));
    EXPECT_EQ(to_string(mixed), "+refraction,-shadows");
    EXPECT_EQ(parse_effects("all").on, all_effects);
    const ForcedEffects later = parse_effects("none,+shadows");
    EXPECT_EQ(later.on, EffectMask(Effect::shadows));
    EXPECT_EQ(later.off, all_effects - Effect::shadows);
    const auto message = test::thrown_message<InputError>([] { (void)parse_effects("+fog"); });
    EXPECT_EQ(message.substr(0, 58), "there is no effect 'fog'; the effects are shadows, inverse");
    EXPECT_TRUE(message.ends_with(", all or none")) << message;
    for (const EffectName& entry : effect_names())
        EXPECT_NE(message.find(std::string(" ") + entry.name + ","), std::string::npos);
    EXPECT_THROW((void)parse_effects("shadows"), InputError);
    EXPECT_THROW((void)parse_effects("+shadows,,"), InputError);
}

TEST(Effects, OfNamedScenesAreNone) {
    for (const char* name : {"paper", "spheres/100", "mixed/64"}) EXPECT_EQ(reasons(named_scene(name)), "") << name;
}

TEST(Effects, NameWhatNeedsThem) {
    Scene scene = named_scene("paper");
    scene.nodes.back().light->casts_shadows = true;
    scene.materials[1].optics.mirror = {0, 0.5F, 0};
    scene.materials[2].optics.transmission = 0.25F;
    scene.materials[3].optics = {.transmission = 1, .absorption = {0, 2, 0}};
    EXPECT_EQ(reasons(scene),
              "shadows: light 'light' casts shadows\n"
              "reflection: material 'green' is a mirror with reflectance 0.5\n"
              "refraction: material 'blue' has transmission 0.25, and 1 more\n"
              "absorption: material 'yellow' absorbs up to 2 per metre\n"
              "nested_media: a solid of material 'blue' may touch or contain another one, or the camera, and 1 more\n");
}

/// The camera 'eye' with an open shutter, and a light that moves from 0 s to 3 s.
Scene moving_scene() {
    Scene scene = test::small_scene();
    scene.nodes[2].light->casts_shadows = false;
    shutter_of(*scene.nodes[0].camera) = {0, 0.02};
    return scene;
}

TEST(Effects, OfMotionNameWhatMoves) {
    Scene scene = moving_scene();
    const std::string camera = "motion_blur: camera 'eye' has its shutter open for 0.02 s, during which ";
    EXPECT_EQ(reasons(scene), camera + "node 'lamp' moves\n");
    scene.nodes[1].parent = 2;
    EXPECT_EQ(reasons(scene), camera + "node 'body' moves, and 1 more\n");
    scene.nodes[2].light->intensity = 0;
    EXPECT_EQ(reasons(scene), camera + "node 'body' moves\n");
    scene.animation[0].node = 0;
    EXPECT_EQ(reasons(scene), camera + "it moves\n");
    EXPECT_TRUE(prepare(scene).effects.empty()) << "kernels have nothing to do with it";
    EXPECT_EQ(reasons(without_effects(scene, Effect::motion_blur)), "");
}

TEST(Effects, OfMotionNeedAShutterAndSomethingThatMoves) {
    Scene scene = moving_scene();
    shutter_of(*scene.nodes[0].camera).close = 0;
    EXPECT_EQ(reasons(scene), "") << "it is closed";
    shutter_of(*scene.nodes[0].camera) = {3, 4};
    EXPECT_EQ(reasons(scene), "") << "the motion is over";
    shutter_of(*scene.nodes[0].camera) = {-1, 0};
    EXPECT_EQ(reasons(scene), "") << "it has not begun";
    shutter_of(*scene.nodes[0].camera) = {-1, 0.001};
    EXPECT_NE(reasons(scene), "");
    scene.nodes[1].geometry.clear();
    EXPECT_EQ(reasons(scene), "") << "the light shines on nothing";
}

TEST(Effects, IgnoreWhatNoRayHits) {
    Scene scene = named_scene("paper");
    scene.nodes.back().light->casts_shadows = true;
    scene.nodes.back().light->intensity = 0;
    scene.materials.push_back({.name = "unused", .phong = {}, .optics = {.mirror = {1, 1, 1}, .transmission = 1}});
    EXPECT_EQ(reasons(scene), "");
    Scene empty;
    empty.nodes = {scene.nodes[0], scene.nodes.back()};
    empty.nodes.back().light->intensity = 1;
    EXPECT_EQ(reasons(empty), "");
}

TEST(Effects, FindBodiesThatTouchOneAnother) {
    const auto overlaps = [](const Vec3d& second, double radius) {
        Scene scene;
        scene.materials = {{.name = "glass", .phong = {}, .optics = {.transmission = 1}},
                           {.name = "diffuse", .phong = {}}};
        scene.nodes.push_back({.name = "eye", .trs = {.translation = {0, 0, 20}}, .camera = PerspectiveCamera{}});
        Node ball{.name = "ball"};
        ball.geometry.push_back({SphereShape{1}, 0, {}});
        Node other{.name = "other", .trs = {.translation = second}};
        other.geometry.push_back({SphereShape{radius}, 1, {}});
        scene.nodes.insert(scene.nodes.end(), {ball, other});
        return prepare(scene).media_overlap;
    };
    EXPECT_FALSE(overlaps({3, 0, 0}, 1));
    EXPECT_FALSE(overlaps({1.5, 1.5, 0}, 1.1));  // their bounds overlap, they do not
    EXPECT_TRUE(overlaps({2, 0, 0}, 1));         // they touch
    EXPECT_TRUE(overlaps({0.2, 0, 0}, 0.1));
}

TEST(Effects, FindTheMediaOfTheCamera) {
    Scene scene;
    scene.materials = {{.name = "water", .phong = {}, .optics = {.transmission = 1}},
                       {.name = "glass", .phong = {}, .optics = {.transmission = 1}}};
    const Scene icosphere = named_scene("icosphere/1");
    scene.meshes = icosphere.meshes;
    scene.nodes.push_back({.name = "eye", .camera = PerspectiveCamera{}});
    const auto add = [&](const Shape& shape, std::uint32_t material, double size) {
        Node node{.name = "body", .trs = {.translation = {0.05, 0.02, 0.01}, .scale = Vec3d{1, 1, 1} * size}};
        node.geometry.push_back({shape, material, {}});
        scene.nodes.push_back(node);
    };
    add(SphereShape{1}, 1, 1);
    add(MeshShape{0}, 0, 8);
    add(BoxShape{{1, 1, 1}}, 0, 0.01);
    const PreparedScene prepared = prepare(scene);
    ASSERT_EQ(prepared.camera_media.count, 2U);
    EXPECT_EQ(prepared.camera_media.material[0], 0U);  // the larger, as if it had been entered first
    EXPECT_EQ(prepared.camera_media.material[1], 1U);
}

TEST(Effects, AreServedByTheFirstVariantThatCoversThem) {
    static constexpr KernelVariant variants[] = {{"none", {}}, {"shadows", Effect::shadows}, {"all", all_effects}};
    EXPECT_EQ(variant_for(variants, {}), 0U);
    EXPECT_EQ(variant_for(variants, Effect::shadows), 1U);
    EXPECT_EQ(variant_for(variants, Effect::reflection), 2U);
}

}  // namespace
}  // namespace tandem

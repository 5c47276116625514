#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <functional>
#include <limits>

#include "support/scenes.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::contains;
using test::small_scene;

struct Flaw {
    const char* name;
    std::function<void(Scene&)> make;
    const char* sentence;  ///< a part of it
};

void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.name; }

class Validate : public testing::TestWithParam<Flaw> {};

TEST_P(Validate, NamesTheFlaw) {
    Scene scene = small_scene();
    GetParam().make(scene);
    const auto problems = validate(scene);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_TRUE(contains(problems[0], GetParam().sentence));
    EXPECT_TRUE(contains(test::input_error([&] { (void)prepare(scene); }), GetParam().sentence));
}

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Flaws, Validate,
    testing::Values(
        Flaw{"translation", [](Scene& s) { s.nodes[1].trs.translation.x = inf; }, "node 'body' has a translation"},
        Flaw{"scale", [](Scene& s) { s.nodes[1].trs.scale.y = 1e19; }, "node 'body' has a scale"},
        Flaw{"rotation", [](Scene& s) { s.nodes[1].trs.rotation.w = double{nan_f}; }, "node 'body' has a rotation"},
        Flaw{"no_rotation",
             [](Scene& s) {
                 s.nodes[1].trs.rotation = {0, 0, 0, 0};
             },
             "node 'body' has the rotation (0, 0, 0, 0)"},
        Flaw{"nameless", [](Scene& s) { s.nodes[1].name.clear(), s.nodes[1].trs.translation.x = inf; },
             "node 1 has a translation"},
        Flaw{"matrix",
             [](Scene& s) {
                 s.nodes[1].matrix = Transform{{}, {inf, 0, 0}};
             },
             "node 'body' has a matrix"},
        Flaw{"no_parent", [](Scene& s) { s.nodes[1].parent = 7; }, "node 'body' has a parent that does not exist"},
        Flaw{"odd_parent", [](Scene& s) { s.nodes[1].parent = -2; }, "node 'body' has a parent that does not exist"},
        Flaw{"own_parent", [](Scene& s) { s.nodes[1].parent = 1; }, "node 'body' is its own ancestor"},
        Flaw{"cycle", [](Scene& s) { s.nodes[1].parent = 2, s.nodes[2].parent = 1; }, "is its own ancestor"},
        Flaw{"below_cycle", [](Scene& s) { s.nodes[0].parent = 1, s.nodes[1].parent = 2, s.nodes[2].parent = 1; },
             "is its own ancestor"},
        Flaw{"shutter_order",
             [](Scene& s) {
                 shutter_of(*s.nodes[0].camera) = {0.1, 0.05};
             },
             "node 'eye' has a shutter that closes before it opens"},
        Flaw{"shutter_time", [](Scene& s) { shutter_of(*s.nodes[0].camera).close = inf; },
             "node 'eye' has a shutter that opens or closes at a time that is not finite"},
        Flaw{"shutter_instants", [](Scene& s) { shutter_of(*s.nodes[0].camera).instants = 0; },
             "node 'eye' has a shutter whose number of instants"},
        Flaw{"material", [](Scene& s) { s.nodes[1].geometry[0].material = 1; }, "uses a material that does not exist"},
        Flaw{"radius", [](Scene& s) { s.nodes[1].geometry[0].shape = SphereShape{0}; }, "radius is not above 0"},
        Flaw{"size",
             [](Scene& s) {
                 s.nodes[1].geometry[0].shape = BoxShape{{1, -1, 1}};
             },
             "a box whose size"},
        Flaw{"mesh", [](Scene& s) { s.nodes[1].geometry[0].shape = MeshShape{0}; }, "shows a mesh that does not exist"},
        Flaw{"position",
             [](Scene& s) {
                 s.meshes = {{"cup", {{nan_f, 0, 0}}}};
             },
             "mesh 'cup' has a position"},
        Flaw{"far_position",
             [](Scene& s) {
                 s.meshes = {{"", {{2e18F, 0, 0}}}};
             },
             "mesh 0 has a position"},
        Flaw{"normal_count",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}}};
             },
             "mesh 'cup' does not have one normal per position"},
        Flaw{"normal",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {{0, 0, nan_f}}}};
             },
             "mesh 'cup' has a normal"},
        Flaw{"texcoord_count",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {{{0, 0}, {0, 1}}}}};
             },
             "mesh 'cup' does not have one texture coordinate per position"},
        Flaw{"texcoord",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {{{0, nan_f}}}}};
             },
             "mesh 'cup' has a texture coordinate"},
        Flaw{"colour_count",
             [](Scene& s) {
                 s.meshes = {{.name = "cup", .positions = {{0, 0, 0}}, .colours = {{}, {}}}};
             },
             "mesh 'cup' does not have one colour per position"},
        Flaw{"colour",
             [](Scene& s) {
                 s.meshes = {{.name = "cup", .positions = {{0, 0, 0}}, .colours = {{{0, 2, 0}, 1}}}};
             },
             "mesh 'cup' has a vertex colour outside [0, 1]"},
        Flaw{"triangle_count",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {}, {0, 0, 0, 0}}};
             },
             "mesh 'cup' has triangle indices whose number is not a multiple of 3"},
        Flaw{"quad_count",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {}, {}, {0, 0, 0}}};
             },
             "mesh 'cup' has quad indices whose number is not a multiple of 4"},
        Flaw{"triangle_index",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {}, {0, 0, 1}}};
             },
             "mesh 'cup' has a face with vertex 1, but 1 positions"},
        Flaw{"quad_index",
             [](Scene& s) {
                 s.meshes = {{"cup", {{0, 0, 0}}, {}, {}, {}, {0, 9, 0, 0}}};
             },
             "mesh 'cup' has a face with vertex 9"},
        Flaw{"instance",
             [](Scene& s) {
                 s.nodes[1].geometry[0].instances = {{}, {{inf, 0, 0}, {}, {1, 1, 1}}};
             },
             "node 'body', instance 1, has a translation"},
        Flaw{"yfov", [](Scene& s) { s.nodes[0].camera = PerspectiveCamera{4}; }, "node 'eye' has a camera"},
        Flaw{"ymag", [](Scene& s) { s.nodes[0].camera = OrthographicCamera{0}; }, "node 'eye' has an orthographic"},
        Flaw{"light_colour", [](Scene& s) { s.nodes[2].light->colour.y = -1; }, "node 'lamp' has a light whose colour"},
        Flaw{"intensity", [](Scene& s) { s.nodes[2].light->intensity = nan_f; }, "node 'lamp' has a light whose inten"},
        Flaw{"ambient", [](Scene& s) { s.materials[0].phong.ambient.x = 2; }, "material 'plain' has an ambient"},
        Flaw{"diffuse", [](Scene& s) { s.materials[0].phong.diffuse.x = nan_f; }, "material 'plain' has a diffuse"},
        Flaw{"specular", [](Scene& s) { s.materials[0].phong.specular.z = -1; }, "material 'plain' has a specular"},
        Flaw{"shininess", [](Scene& s) { s.materials[0].phong.shininess = 1e9F; }, "has a shininess"},
        Flaw{"channel_node", [](Scene& s) { s.animation[0].node = 3; }, "drives a node that does not exist"},
        Flaw{"channel_matrix", [](Scene& s) { s.nodes[2].matrix = Transform{}; }, "of node 'lamp' drives a node that"},
        Flaw{"no_keys", [](Scene& s) { s.animation[0].times.clear(), s.animation[0].values.clear(); }, "has no keys"},
        Flaw{"key_order", [](Scene& s) { s.animation[0].times[2] = 1; }, "strictly increasing"},
        Flaw{"key_sign", [](Scene& s) { s.animation[0].times[0] = -1; }, "strictly increasing"},
        Flaw{"key_values", [](Scene& s) { s.animation[0].values.pop_back(); },
             "does not have the number of values that its keys need"},
        Flaw{"key_nan", [](Scene& s) { s.animation[0].values[4] = nan_f; }, "values that are not finite"},
        Flaw{"key_rotation",
             [](Scene& s) {
                 s.animation[0].path = AnimatedPath::rotation;
                 s.animation[0].values = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
             },
             "a key with the rotation (0, 0, 0, 0)"},
        Flaw{"environment", [](Scene& s) { s.environment.top.x = -1; }, "the environment has a colour"},
        Flaw{"picture_without_texels",
             [](Scene& s) {
                 s.environment_image = EnvironmentImage{{2, 1, {}}};
             },
             "the environment's picture has 2 x 1 texels"},
        Flaw{"dark_picture",
             [](Scene& s) {
                 s.environment_image = EnvironmentImage{{1, 1, {{0, -1, 0}}}};
             },
             "the environment's picture has values"},
        Flaw{"picture_intensity",
             [](Scene& s) {
                 s.environment_image = EnvironmentImage{{1, 1, {{1, 1, 1}}}, 0, -1};
             },
             "the environment's picture has an intensity"},
        Flaw{"picture_rotation",
             [](Scene& s) {
                 s.environment_image = EnvironmentImage{{1, 1, {{1, 1, 1}}}, HUGE_VAL, 1};
             },
             "the environment's picture has a rotation"},
        Flaw{"exposure", [](Scene& s) { s.display.exposure_stops = 101; }, "the display has an exposure outside"},
        Flaw{"frame_rate", [](Scene& s) { s.frames_per_second = 0; }, "a frame rate that is not positive"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ValidateScene, FindsNothingInAGoodScene) { EXPECT_TRUE(validate(small_scene()).empty()); }

TEST(ValidateScene, SaysAllAtOnce) {
    Scene scene = small_scene();
    scene.nodes[1].geometry[0].shape = SphereShape{-1};
    scene.frames_per_second = -1;
    EXPECT_EQ(validate(scene).size(), 2U);
}

TEST(ValidateScene, ZeroTangentsOfRotationsAreFine) {
    Scene scene = small_scene();
    scene.animation[0].path = AnimatedPath::rotation;
    scene.animation[0].interpolation = Interpolation::cubic;
    scene.animation[0].times = {0};
    scene.animation[0].values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0};
    EXPECT_TRUE(validate(scene).empty());
}

TEST(ValidateScene, IsLinearInTheDepthOfTheTree) {
    Scene scene = small_scene();
    constexpr std::int32_t depth = 200'000;  // quadratic work would not end
    for (std::int32_t i = 0; i < depth; ++i) {
        Node node;
        node.parent = static_cast<std::int32_t>(scene.nodes.size()) - 1;
        node.trs.translation.x = 1;
        scene.nodes.push_back(node);
    }
    scene.nodes.back().geometry = {{SphereShape{1}, 0, {}}};
    EXPECT_EQ(prepare(scene).spheres.back().centre.x, static_cast<float>(depth));
}

TEST(FrameCount, CountsToTheLastKeyAndDoesNotOverflow) {
    Scene scene = small_scene();
    EXPECT_EQ(frame_count(scene), 72);
    scene.animation[0].times[2] = std::numeric_limits<float>::max();
    EXPECT_EQ(frame_count(scene), std::numeric_limits<std::int32_t>::max());
    scene.animation.clear();
    EXPECT_EQ(frame_count(scene), 1);
}

template <class Part>
void expect_ranges(std::optional<Part> Material::*part, const std::string& is) {
    const Part defaults;
    Part::visit_numbers(defaults, [&](const char* number, const auto&, float least, float most) {
        for (const float wrong : {nan_f, std::nextafter(least, -FLT_MAX), std::nextafter(most, FLT_MAX)}) {
            Scene scene = small_scene();
            Part& of_material = (scene.materials[0].*part).emplace();
            Part::visit_numbers(of_material, [&](const char* other, auto& value, float, float) {
                if (std::string(other) == number) value = std::decay_t<decltype(value)>(wrong);
            });
            const auto problems = validate(scene);
            ASSERT_EQ(problems.size(), 1U) << is << ", " << number << " " << wrong;
            EXPECT_TRUE(contains(problems[0], "has " + is + " whose " + number + " is outside"));
        }
    });
    Scene scene = small_scene();
    (scene.materials[0].*part).emplace();
    EXPECT_TRUE(validate(scene).empty()) << is << " by default";
    scene.materials[0].optics.mirror = {1, 1, 1};
    EXPECT_EQ(validate(scene).size(), Part::is_opaque ? 1U : 0U) << is;
}

TEST(ValidateMaterials, CheckEveryNumberOfTheOptionalPartsOfMaterials) {
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) expect_ranges(&Material::name, is);
#include "tandem/kernel/bsdf/lobes.def"
}

}  // namespace
}  // namespace tandem

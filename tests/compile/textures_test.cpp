// From an author's textures to what the kernels read.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/scenes.h"
#include "tandem/compile/prepare_textures.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/levels.h"
#include "tandem/kernel/shapes/parametrisation.h"

namespace tandem {
namespace {

using test::contains;
using test::small_scene;

constexpr std::uint32_t red = 0xFF0000FFU;
constexpr std::uint32_t half_blue = 0xFFBC0000U;  // level 188
constexpr std::uint32_t masked_out = 0x00FFFFFFU;

/// small_scene() whose body shows 2 x 1 texels.
Scene textured_scene(std::uint32_t left = red, std::uint32_t right = half_blue) {
    Scene scene = small_scene();
    scene.images = {{"picture", 2, 1, {left, right}}};
    scene.textures = {{0, Wrap::clamp_to_edge, Wrap::repeat, Filter::nearest}};
    scene.materials[0].diffuse_texture = TextureReference{};
    return scene;
}

TEST(PrepareTextures, GivesFlatArrays) {
    Scene scene = textured_scene();
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].diffuse_texture.reset();
    scene.materials[1].normal_texture = TextureReference{};
    scene.materials[1].normal_scale = 0.5F;
    scene.materials.push_back({"plain", {}});
    const PreparedTextures found = prepare(scene).textures;
    EXPECT_EQ(found.texels, (std::vector<std::uint32_t>{red, half_blue})) << "once for both uses";
    ASSERT_EQ(found.textures.size(), 2U);
    EXPECT_EQ(found.textures[0].width, 2U);
    EXPECT_EQ(found.textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(found.textures[0].filter, Filter::nearest);
    EXPECT_EQ(found.textures[0].space, ColourSpace::srgb);
    EXPECT_EQ(found.textures[1].space, ColourSpace::linear) << "normals are no colours";
    ASSERT_EQ(found.materials.size(), 3U);
    EXPECT_EQ(found.materials[0].diffuse.texture, 0U);
    EXPECT_EQ(found.materials[0].normal.texture, no_texture);
    EXPECT_EQ(found.materials[1].normal.texture, 1U);
    EXPECT_EQ(found.materials[1].normal_scale, 0.5F);
    EXPECT_FALSE(has_texture(found, 2));
    const TextureSet set = view(found);
    const Rgba<float> seen = sample<float>(set, found.materials[0].diffuse, 0.75, 0.0);
    EXPECT_EQ(seen.r, 0);
    EXPECT_NEAR(seen.b, 0.5028865, 1e-6) << "sRGB level 188";
    EXPECT_EQ(seen.a, 1);
}

TEST(PrepareTextures, LeavesAPlainSceneAsItIs) {
    const PreparedScene prepared = prepare(small_scene());
    EXPECT_TRUE(prepared.textures.materials.empty() && prepared.textures.levels.empty());
    EXPECT_FALSE(has_textures(view(prepared.textures)));
}

TEST(PrepareTextures, TurnsOneColourIntoAFactor) {
    Scene scene = textured_scene(half_blue | red, half_blue | red);
    scene.materials[0].phong.diffuse = {0.5F, 0.25F, 0.75F};
    scene.materials[0].phong.ambient = {0.25F, 0.125F, 0.5F};
    const PreparedScene prepared = prepare(scene);
    EXPECT_TRUE(prepared.textures.materials.empty());
    const float level = texture_levels()[188];
    EXPECT_EQ(prepared.materials[0].diffuse, Vec3f(0.5F, 0, 0.75F * level));
    EXPECT_EQ(prepared.materials[0].ambient, Vec3f(0.25F, 0, 0.5F * level));
    EXPECT_EQ(prepared.materials[0].specular, scene.materials[0].phong.specular) << "not of the texture";
}

TEST(PrepareTextures, MakesANormalMapOfOneColourOneTexel) {
    Scene scene = textured_scene(0xFFFF8080U, 0xFFFF8080U);
    scene.materials[0].diffuse_texture.reset();
    scene.materials[0].normal_texture = TextureReference{};
    const PreparedTextures found = prepare(scene).textures;
    ASSERT_EQ(found.textures.size(), 1U);
    EXPECT_EQ(found.textures[0].width, 1U);
    EXPECT_EQ(found.texels.size(), 1U);
}

TEST(PrepareTextures, KeepsAMaskThatCutsAndNoOther) {
    Scene scene = textured_scene(red, masked_out);
    const auto of_material = [&] { return prepare(scene).textures.materials.at(0); };
    EXPECT_EQ(of_material().alpha_cutoff, 0) << "opaque";
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(of_material().alpha_cutoff, 0.5F);
    scene.images[0].texels[1] = half_blue;
    EXPECT_EQ(of_material().alpha_cutoff, 0) << "no texel is below the cutoff";
    scene.materials[0].alpha = 0.25F;
    EXPECT_EQ(of_material().alpha_cutoff, 0.5F) << "all are";
    EXPECT_EQ(of_material().alpha, 0.25F);
    scene.materials[0].diffuse_texture.reset();
    EXPECT_FALSE(is_opaque<float>(of_material(), 1.0F)) << "without a texture as well";
    scene.materials[0].alpha = 1;
    EXPECT_TRUE(prepare(scene).textures.materials.empty());
}

TEST(PrepareTextures, AMaskThatLeavesNothingDropsThePrimitive) {
    constexpr std::uint32_t faint = 0x40BC0000U;
    Scene scene = textured_scene(red, faint);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    const auto counts = [&] {
        const PreparedScene prepared = prepare(scene);
        EXPECT_EQ(prepared.material_of.empty(), prepared.dropped_primitives == 1);
        EXPECT_EQ(prepared.effects.has(Effect::cutouts), !prepared.material_of.empty());
        return prepared.dropped_primitives;
    };
    scene.materials[0].alpha = 0.75F;
    EXPECT_EQ(counts(), 0U) << "one texel is below the cutoff, one above";
    scene.materials[0].alpha = 0.5F;
    EXPECT_EQ(counts(), 0U) << "the other is at the cutoff";
    scene.materials[0].alpha = 0.49F;
    EXPECT_EQ(counts(), 1U);
    scene.materials[0].alpha_mode = AlphaMode::opaque;
    EXPECT_EQ(prepare(scene).dropped_primitives, 0U);
}

TEST(PrepareTextures, MovesScalesAndTurns) {
    Scene scene = textured_scene();
    TextureReference& reference = *scene.materials[0].diffuse_texture;
    const auto moved = [&](float u, float v) {
        const TextureUse use = prepare(scene).textures.materials.at(0).diffuse;
        return Vec2f(use.u_row[0] * u + use.u_row[1] * v + use.u_row[2],
                     use.v_row[0] * u + use.v_row[1] * v + use.v_row[2]);
    };
    EXPECT_EQ(moved(0.3F, 0.7F), Vec2f(0.3F, 0.7F));
    reference.scale = {2, 4};
    EXPECT_EQ(moved(0.5F, 0.5F), Vec2f(1, 2));
    reference.rotation = 1.5707963F;
    EXPECT_NEAR(moved(0.5F, 0.5F).x, 2, 1e-6) << "a quarter turn takes (u, v) to (v, -u), scaled before";
    EXPECT_NEAR(moved(0.5F, 0.5F).y, -1, 1e-6);
    reference.offset = {10, 20};
    EXPECT_NEAR(moved(0.5F, 0.5F).x, 12, 1e-5) << "moved last";
    EXPECT_NEAR(moved(0.5F, 0.5F).y, 19, 1e-5);
}

TEST(PrepareTextures, MakesDirectionsOnlyForAnisotropicMaterials) {
    Scene scene = small_scene();
    scene.materials.push_back({"isotropic", {}});
    scene.materials[1].microfacets = Microfacets{};
    scene.materials[0].microfacets = Microfacets{.rotation = 2};
    EXPECT_TRUE(prepare(scene).anisotropies.empty());
    scene.materials[0].microfacets->anisotropy = 0.5F;
    const PreparedScene prepared = prepare(scene);
    ASSERT_EQ(prepared.anisotropies.size(), 2U);
    EXPECT_NEAR(prepared.anisotropies[0].x, std::cos(2), 1e-7);
    EXPECT_NEAR(prepared.anisotropies[0].y, std::sin(2), 1e-7);
    EXPECT_TRUE(prepared.textures.materials.empty());
    // a picture without strength leaves nothing of it
    scene.images = {{"none", 1, 1, {0xFF00FF00U}}};
    scene.textures = {{0}};
    scene.materials[0].anisotropy_texture = TextureReference{};
    const PreparedScene none = prepare(scene);
    EXPECT_TRUE(none.anisotropies.empty() && none.textures.materials.empty());
    EXPECT_FALSE(none.effects.has(Effect::anisotropy));
    scene.images = {{"directions", 2, 1, {0xFF00FF00U, 0xFFFF00FFU}}};
    const PreparedScene pictured = prepare(scene);
    ASSERT_EQ(pictured.textures.textures.size(), 1U);
    EXPECT_EQ(pictured.textures.textures[0].space, ColourSpace::linear);
    EXPECT_EQ(pictured.anisotropies[0].texture.texture, 0U);
    EXPECT_TRUE(pictured.effects.has(Effect::textures) && pictured.effects.has(Effect::anisotropy));
}

// That of the normal texture, else that of the directions, else the first; a mesh need not have the first.
TEST(PrepareTextures, TakesTheTangentFromASetOfCoordinates) {
    Scene scene = small_scene();
    scene.images = {{"picture", 2, 1, {red, half_blue}}};
    scene.textures = {{0}};
    Mesh face{.name = "face", .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {0, 1, 2}};
    scene.meshes = {face};
    scene.nodes[1].geometry[0].shape = MeshShape{0};
    Material& material = scene.materials[0];
    material.microfacets = Microfacets{.anisotropy = 1};
    EXPECT_TRUE(validate(scene).empty());
    EXPECT_EQ(prepare(scene).texcoords, std::vector<Vec2f>(3, Vec2f{0, 0}));
    const auto set = [](float a) { return std::vector<Vec2f>{{a, 0}, {a, 1}, {a, 2}}; };
    scene.meshes[0].texcoords = {set(1), set(2), set(3)};
    EXPECT_EQ(prepare(scene).texcoords, set(1));
    material.diffuse_texture = TextureReference{};
    material.anisotropy_texture = TextureReference{.texcoord = 1};
    EXPECT_EQ(prepare(scene).anisotropies[0].slot, 1U);
    EXPECT_EQ(prepare(scene).anisotropies[0].texture.slot, 1U);
    EXPECT_TRUE(prepare(scene).several_slots);
    material.normal_texture = TextureReference{.texcoord = 2};
    EXPECT_EQ(prepare(scene).anisotropies[0].slot, 2U);
    material.anisotropy_texture->texcoord = 3;
    EXPECT_FALSE(validate(scene).empty());
}

// What a sphere and a box do not know of, a body with its own space does.
TEST(PrepareTextures, KeepsPicturesOnTurnedAndMirroredBodies) {
    const Trs turned{{1, 2, 3}, {0.1, 0.2, 0.3, 0.9}, {2, 2, 2}};
    const Trs mirrored{{1, 2, 3}, {}, {-2, 2, 2}};
    const Trs scaled{{1, 2, 3}, {}, {2, 2, 2}};
    const auto prepare_as = [](const Shape& shape, const Trs& trs, bool textured) {
        Scene scene = textured ? textured_scene() : small_scene();
        scene.nodes[1].geometry[0].shape = shape;
        scene.nodes[1].trs = trs;
        return prepare(scene);
    };
    EXPECT_EQ(prepare_as(SphereShape{1}, turned, false).spheres.size(), 1U);
    EXPECT_EQ(prepare_as(SphereShape{1}, scaled, true).spheres.size(), 1U);
    EXPECT_EQ(prepare_as(SphereShape{1}, turned, true).ellipsoids.size(), 1U);
    EXPECT_EQ(prepare_as(SphereShape{1}, mirrored, true).ellipsoids.size(), 1U);
    const auto brushed = [&](float strength) {
        Scene scene = small_scene();
        scene.nodes[1].trs = turned;
        scene.materials[0].microfacets = Microfacets{.anisotropy = strength};
        return prepare(scene).ellipsoids.size();
    };
    EXPECT_EQ(brushed(0), 0U);
    EXPECT_EQ(brushed(0.5F), 1U) << "the grooves turn with it";
    EXPECT_EQ(prepare_as(BoxShape{}, mirrored, false).boxes.size(), 1U);
    EXPECT_EQ(prepare_as(BoxShape{}, scaled, true).boxes.size(), 1U);
    EXPECT_EQ(prepare_as(BoxShape{}, mirrored, true).parallelepipeds.size(), 1U);
    EXPECT_EQ(prepare_as(BoxShape{{1, 0, 1}}, scaled, true).boxes.size(), 1U);
    EXPECT_TRUE(contains(test::input_error([&] {
                             (void)prepare_as(BoxShape{{1, 0, 1}}, mirrored, true);
                         }),
                         "node 1 'body' has a mirrored box that is flat and has a texture"));
}

TEST(PrepareTextures, ListsTheKindsWithAlphaMasks) {
    Scene scene = textured_scene(red, masked_out);
    scene.nodes[1].geometry[0].material = 0;
    EXPECT_EQ(prepare(scene).cutout_kinds, 0U) << "opaque";
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(prepare(scene).cutout_kinds, PrimitiveKinds::sphere);
    scene.materials.push_back({"plain", {}});
    scene.nodes[1].geometry.push_back({BoxShape{}, 1, {}});
    EXPECT_EQ(prepare(scene).cutout_kinds, PrimitiveKinds::sphere) << "the box has another material";
    scene.nodes[1].geometry[1].material = 0;
    EXPECT_EQ(prepare(scene).cutout_kinds, PrimitiveKinds::sphere | PrimitiveKinds::box);
    EXPECT_EQ(prepare(scene).masked_kinds, PrimitiveKinds::sphere | PrimitiveKinds::box);
}

TEST(PrepareTextures, TurnsThePictureWithItsSphere) {
    // half a turn around x: the picture's top is below, and what looked to +z looks to -z
    Scene scene = textured_scene();
    scene.nodes[1].trs.rotation = {1, 0, 0, 0};
    const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
    ASSERT_EQ(prepared.ellipsoids.size(), 1U);
    const auto at = [&](const Vec3d& n) {
        const Ray<double> ray = {n * 3.0, -n};
        double t = 0;
        EXPECT_TRUE(first_hit(prepared.ellipsoids[0], ray, t));
        const Ellipsoid& body = prepared.ellipsoids[0];
        return parametrisation(body, record_hit(body, ray, t, false, true), nullptr, ray, t, true);
    };
    EXPECT_NEAR(at({0, -1, 0}).v, 0, 1e-7);
    EXPECT_NEAR(at({0, 0, -1}).u, 0.5, 1e-12);
    EXPECT_NEAR(at({1, 0, 0}).u, 0.75, 1e-12);
}

struct Flaw {
    const char* name;
    std::function<void(Scene&)> make;
    const char* sentence;
};
void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.name; }

class ValidateTextures : public testing::TestWithParam<Flaw> {};

TEST_P(ValidateTextures, NamesTheFlaw) {
    Scene scene = textured_scene();
    ASSERT_TRUE(validate(scene).empty());
    GetParam().make(scene);
    const auto problems = validate(scene);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_TRUE(contains(problems[0], GetParam().sentence));
}

INSTANTIATE_TEST_SUITE_P(
    Flaws, ValidateTextures,
    testing::Values(
        Flaw{"no_width", [](Scene& s) { s.images[0].width = 0; }, "image 'picture' has a width or height"},
        Flaw{"too_wide", [](Scene& s) { s.images[0].width = 16385; }, "image 'picture' has a width or height"},
        Flaw{"texels", [](Scene& s) { s.images[0].texels.pop_back(); },
             "image 'picture' does not have width times height texels"},
        Flaw{"nameless", [](Scene& s) { s.images[0].name.clear(), s.images[0].texels.clear(); },
             "image 0 does not have width"},
        Flaw{"image", [](Scene& s) { s.textures[0].image = 1; }, "texture 0 shows an image that does not exist"},
        Flaw{"texture", [](Scene& s) { s.materials[0].diffuse_texture->texture = 1; },
             "material 'plain', diffuse texture, uses a texture that does not exist"},
        Flaw{"normals", [](Scene& s) { s.materials[0].normal_texture = TextureReference{7}; },
             "material 'plain', normal texture, uses a texture that does not exist"},
        Flaw{"offset", [](Scene& s) { s.materials[0].diffuse_texture->offset.y = 1e19F; }, "has an offset, a rotation"},
        Flaw{"normal_scale", [](Scene& s) { s.materials[0].normal_scale = std::numeric_limits<float>::infinity(); },
             "has a normal scale"},
        Flaw{"alpha", [](Scene& s) { s.materials[0].alpha = 1.5F; }, "material 'plain' has an alpha outside [0, 1]"},
        Flaw{"cutoff", [](Scene& s) { s.materials[0].alpha_cutoff = -1; }, "material 'plain' has an alpha cutoff"},
        Flaw{"texcoords",
             [](Scene& s) {
                 s.meshes = {{"sheet", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2}, {}}};
                 s.nodes[1].geometry = {{MeshShape{0}, 0, {}}, {MeshShape{0}, 0, {}}};
             },
             "node 'body' shows a mesh without set 0 of texture coordinates under the textures of material 'plain'"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace tandem

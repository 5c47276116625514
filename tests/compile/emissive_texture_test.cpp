// How bright an emissive texture is over a light: its chance to be drawn.
#include "tandem/compile/emissive_texture.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

/// A triangle with the texture coordinates `uv` under an emissive texture.
Scene lamp(const std::vector<Vec2f>& uv, const Image& image, Wrap wrap) {
    Scene scene;
    scene.images = {image};
    scene.textures = {{0, wrap, wrap, Filter::linear}};
    Material material{"lamp", {}};
    material.optics.emission = {2, 2, 2};
    material.emissive_texture = TextureReference{};
    scene.materials = {material};
    scene.meshes = {{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .texcoords = {uv}, .triangles = {0, 1, 2}}};
    Node body{.name = "lamp"};
    body.geometry.push_back({MeshShape{0}, 0, {}});
    scene.nodes = {body, Node{.name = "eye", .trs = {.translation = {0, 0, 3}}, .camera = PerspectiveCamera{}}};
    return scene;
}

/// Black, but for one white texel.
Image spark(std::uint32_t x, std::uint32_t y) {
    Image image{"spark", 64, 64, std::vector<std::uint32_t>(64 * 64, 0xFF000000U)};
    image.texels[y * 64 + x] = 0xFFFFFFFFU;
    return image;
}

/// Does the texture, looked up at many points of the triangle, show anything?
bool shines(const PreparedScene& scene, const std::vector<Vec2f>& uv) {
    const TextureSet set = view(scene.textures);
    constexpr int steps = 96;
    for (int i = 0; i <= steps; ++i) {
        for (int k = 0; k <= steps - i; ++k) {
            const double b = 1.0 * i / steps, c = 1.0 * k / steps, a = 1 - b - c;
            const auto along = [&](auto member) { return a * member(uv[0]) + b * member(uv[1]) + c * member(uv[2]); };
            const double u = along([](const Vec2f& p) { return double{p.x}; });
            const double v = along([](const Vec2f& p) { return double{p.y}; });
            if (sample<double>(set, scene.textures.materials[0].emission, u, v).r > 0) return true;
        }
    }
    return false;
}

TEST(EmissiveTexture, WhatShinesSomewhereIsALight) {
    for (std::uint32_t number = 0; number < 300; ++number) {
        test::Random random(number);
        const auto wrap = static_cast<Wrap>(number % 3);
        const double reach = number % 2 == 0 ? 0.3 : 3.0;
        const double u = random.uniform(-2.0, 2.0), v = random.uniform(-2.0, 2.0);
        std::vector<Vec2f> uv(3);
        for (Vec2f& at : uv) {
            at = {static_cast<float>(u + random.uniform(0.0, reach)),
                  static_cast<float>(v + random.uniform(0.0, reach))};
        }
        const std::uint32_t x = random.below(64), y = random.below(64);
        const PreparedScene scene = prepare(lamp(uv, spark(x, y), wrap));
        if (shines(scene, uv)) {
            EXPECT_EQ(scene.area_lights.size(), 1U) << "lamp " << number;
        }
    }
}

TEST(EmissiveTexture, WhatIsBlackIsNone) {
    const std::vector<Vec2f> corner = {{0.7F, 0.7F}, {0.9F, 0.7F}, {0.7F, 0.9F}};
    EXPECT_TRUE(prepare(lamp(corner, spark(3, 3), Wrap::repeat)).area_lights.empty());
    EXPECT_EQ(prepare(lamp(corner, spark(50, 50), Wrap::repeat)).area_lights.size(), 1U);
    Image black = spark(0, 0);
    black.texels[0] = 0xFF000000U;
    EXPECT_TRUE(prepare(lamp(corner, black, Wrap::repeat)).area_lights.empty());
}

TEST(EmissiveTexture, ItsBrightnessIsAboutTheMean) {
    Image image{"ramp", 64, 64, {}};
    for (std::uint32_t i = 0; i < 64 * 64; ++i) image.texels.push_back(0xFF000000U | (i % 64 < 32 ? 0xFFFFFFU : 0U));
    const PreparedScene scene = prepare(lamp({{0, 0}, {1, 0}, {0, 1}}, image, Wrap::clamp_to_edge));
    const SceneView scene_view = view(scene);
    EXPECT_NEAR(EmissiveTextures(scene_view).brightness(0), 0.75, 0.05) << "three quarters of the triangle are white";
}

}  // namespace
}  // namespace tandem

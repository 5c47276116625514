// Anisotropic microfacets: the direction of highlights, and their brightness by the formulas of
// KHR_materials_anisotropy, on every backend and tier that promises bits.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "support/backend_list.h"
#include "support/pixel_index.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

constexpr double quarter = std::numbers::pi / 2;

/// A white metal.
Material brushed(float roughness, float strength, double rotation) {
    Material material{"brushed", {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 1}};
    material.microfacets = Microfacets{
        .metallic = 1, .roughness = roughness, .anisotropy = strength, .rotation = static_cast<float>(rotation)};
    return material;
}

/// Something with material 0 at the origin, seen along -z by an orthographic camera, under a light from `to_light`.
Scene under_light(const Material& material, const Shape& shape, double ymag, const Vec3d& to_light = {0, 0, 1}) {
    Scene scene;
    scene.environment = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    scene.materials = {material};
    Node body{.name = "body"};
    body.geometry.push_back({shape, 0, {}});
    const Quaternion turn = {-to_light.y, to_light.x, 0, 1 + to_light.z};
    const double length = std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.w * turn.w);
    const Quaternion unit = {turn.x / length, turn.y / length, 0, turn.w / length};
    scene.nodes = {{.name = "eye", .trs = {.translation = {0, 0, 3}}, .camera = OrthographicCamera{ymag}},
                   body,
                   {.name = "sun", .trs = {.rotation = unit}, .light = LightSource{.kind = LightKind::directional}}};
    scene.nodes[2].light->casts_shadows = false;
    return scene;
}

/// A square in the plane z = 0; its corners' coordinates go round from the lower left.
Mesh sheet(std::vector<Vec2f> texcoords) {
    Mesh mesh{.name = "sheet", .positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, .quads = {0, 1, 2, 3}};
    if (!texcoords.empty()) mesh.texcoords = {std::move(texcoords)};
    return mesh;
}
const std::vector<Vec2f> upright = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
const std::vector<Vec2f> turned_over = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};  // u grows to the left
const std::vector<Vec2f> turned = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};       // u grows upwards, v to the right

/// pi f cos of a white metal seen along the normal z: the sample implementation of KHR_materials_anisotropy.
double reflected(double roughness, double strength, const Vec3d& t, const Vec3d& l) {
    const Vec3d n = {0, 0, 1}, v = n, b = cross(n, t), h = normalize(l + v);
    const double ab = roughness * roughness, at = ab + (1 - ab) * strength * strength;
    const Vec3d f = {ab * dot(t, h), at * dot(b, h), at * ab * dot(n, h)};
    const double w2 = at * ab / dot(f, f);
    const double density = at * ab * w2 * w2 / std::numbers::pi;
    const auto length = [&](const Vec3d& w) { return std::hypot(at * dot(t, w), ab * dot(b, w), dot(n, w)); };
    const double visibility = 0.5 / (dot(n, l) * length(v) + dot(n, v) * length(l));
    return std::numbers::pi * density * visibility * dot(n, l);
}

class Anisotropic : public test::ExactBackend {
  protected:
    [[nodiscard]] Film film_of(const Scene& scene, int samples = 1, int size = 4) {
        RenderJob job;
        job.width = job.height = size;
        job.samples = samples;
        job.tier = GetParam().tier;
        return backend_->render(load(prepare(scene)), job).film;
    }

    void expect_level(const Scene& scene, double expected) {
        const Film film = film_of(scene);
        for (const Vec3d& pixel : film.sums()) EXPECT_NEAR(pixel.x, expected, 1e-5 * expected);
    }

    /// The extent of what is bright, along x over along y.
    [[nodiscard]] double elongation(const Scene& scene) {
        constexpr int size = 40;
        const Film film = film_of(scene, 4, size);
        double along_x = 0, along_y = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const double level = film.sums()[test::pixel_index(x, y, size)].x;
                along_x += level * std::pow(x + 0.5 - size / 2.0, 2);
                along_y += level * std::pow(y + 0.5 - size / 2.0, 2);
            }
        }
        return std::sqrt(along_x / along_y);
    }
};

TEST_P(Anisotropic, AFaceReflectsAsTheFormulaSays) {
    for (const auto& [texcoords, right, up] :
         {std::tuple{upright, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}, std::tuple{turned_over, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}},
          std::tuple{turned, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}}) {
        for (const double rotation : {0.0, 0.5, quarter, 4.0}) {
            for (const double azimuth : {0.0, 0.9, quarter, 2.5}) {
                const Vec3d to_light = {std::sin(0.6) * std::cos(azimuth), std::sin(0.6) * std::sin(azimuth),
                                        std::cos(0.6)};
                Scene scene = under_light(brushed(0.5F, 0.7F, rotation), MeshShape{0}, 0.01, to_light);
                scene.meshes = {sheet(texcoords)};
                const Vec3d tangent = right * std::cos(rotation) + up * std::sin(rotation);
                const double expected = reflected(0.5F, 0.7F, tangent, to_light);
                expect_level(scene, expected);
            }
        }
    }
}

// A picture of one colour is a factor; one with two, which differ where the camera does not look, is a texture.
TEST_P(Anisotropic, APictureTurnsAndWeakensIt) {
    const Vec3d to_light = {std::sin(0.6), 0, std::cos(0.6)};
    const std::uint32_t texel = 0xFF80D040;  // red 0x40, green 0xD0, blue 0x80
    const Vec3d said = normalize(Vec3d{2 * (0x40 / 255.0) - 1, 2 * (0xD0 / 255.0) - 1, 0});
    const double rotation = 0.5;
    const Vec3d tangent = said * std::cos(rotation) + cross(Vec3d{0, 0, 1}, said) * std::sin(rotation);
    const double expected = reflected(0.5F, 0.7F * (0x80 / 255.0), tangent, to_light);
    for (const std::uint32_t other : {texel, 0xFFFFFFFFU}) {
        Scene scene = under_light(brushed(0.5F, 0.7F, rotation), MeshShape{0}, 0.01, to_light);
        scene.meshes = {sheet(upright)};
        scene.images = {{"picture", 2, 1, {texel, other}}};
        scene.textures = {{0, Wrap::repeat, Wrap::repeat, Filter::nearest}};
        scene.materials[0].anisotropy_texture = TextureReference{.offset = {-0.25F, 0}};
        EXPECT_EQ(prepare(scene).effects.has(Effect::textures), other != texel);
        expect_level(scene, expected);
    }
}

TEST_P(Anisotropic, HighlightsAreLongInTheDirectionOfTheTangent) {
    const auto ball = [](double rotation) { return under_light(brushed(0.3F, 0.5F, rotation), SphereShape{0.5}, 0.5); };
    const double along = elongation(ball(0));
    EXPECT_NEAR(along, 2.37, 0.1) << "u grows to the east; the formula, summed over the ball";
    EXPECT_NEAR(elongation(ball(quarter)), 0.341, 0.02) << "the meridians meet at the poles";
    EXPECT_NEAR(elongation(ball(2 * quarter)), along, 1e-3) << "grooves have no sign";
    // a ball turned about the axis of the camera
    Scene turned_ball = ball(0);
    turned_ball.nodes[1].trs.rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    EXPECT_NEAR(elongation(turned_ball), 1 / along, 0.05 / along);
}

TEST_P(Anisotropic, OfStrengthZeroIsNone) {
    const auto ball = [](float strength) {
        Scene scene = under_light(brushed(0.4F, strength, 1), SphereShape{0.5}, 0.5);
        scene.environment = {{0.2F, 0.3F, 0.4F}, {0.9F, 0.8F, 0.7F}, {0, 0, 0}, 1};
        scene.indirect_light = true;
        return scene;
    };
    const Scene none = ball(0);
    EXPECT_FALSE(prepare(none).effects.has(Effect::anisotropy));
    EXPECT_TRUE(prepare(ball(0.5F)).effects.has(Effect::anisotropy));
    Scene without = none;
    without.materials[0].microfacets = Microfacets{1, 0.4F};
    EXPECT_EQ(film_hash(film_of(none, 4, 16)), film_hash(film_of(without, 4, 16)));
    EXPECT_NE(film_hash(film_of(ball(0.5F), 4, 16)), film_hash(film_of(without, 4, 16)));
}

TEST_P(Anisotropic, WithoutUsableCoordinatesTheDirectionIsThatOfTheFrame) {
    const std::vector<Vec2f> same(4, Vec2f{0.3F, 0.3F});
    const Vec3d to_light = {std::sin(0.6), 0, std::cos(0.6)};
    for (const auto& texcoords : {std::vector<Vec2f>{}, same}) {
        Scene scene = under_light(brushed(0.5F, 0.7F, 0), MeshShape{0}, 0.01, to_light);
        scene.meshes = {sheet(texcoords)};
        const double expected = reflected(0.5F, 0.7F, {1, 0, 0}, to_light);
        expect_level(scene, expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Anisotropic, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem

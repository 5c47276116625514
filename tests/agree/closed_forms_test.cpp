// Images whose values have a closed form, on every backend and exact tier.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "support/backend_list.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

Material black(std::string name) { return {std::move(name), {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1}}; }

Node body(const Shape& shape, const Vec3d& at, std::uint32_t material) {
    Node node{.name = "body", .trs = {.translation = at}};
    node.geometry.push_back({shape, material, {}});
    return node;
}

/// An orthographic camera at `at` that looks along -z, or straight down. Its film is 2 * ymag high.
Node camera(const Vec3d& at, double ymag, bool down = false) {
    Node eye{.name = "eye", .trs = {.translation = at}, .camera = OrthographicCamera{ymag}};
    if (down) eye.trs.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    return eye;
}

Scene uniform_light(const Vec3f& colour) {
    Scene scene;
    scene.environment = {colour, colour, {1, 1, 1}};
    return scene;
}

class ClosedForms : public test::ExactBackend {
  protected:
    /// Checks first that no path crossed interfaces out of order.
    [[nodiscard]] RenderResult render(const Scene& scene, int samples, const PathLimits& limits, int size = 16) {
        RenderJob job;
        job.width = job.height = size;
        job.samples = samples;
        job.tier = GetParam().tier;
        job.limits = limits;
        RenderResult result = backend_->render(load(prepare(scene)), job);
        EXPECT_EQ(result.stats.counters, RenderCounters{});
        return result;
    }
    [[nodiscard]] Film film_of(const Scene& scene, int samples, const PathLimits& limits, int size = 16) {
        return render(scene, samples, limits, size).film;
    }

    /// The mean of all pixels' means.
    [[nodiscard]] Vec3d mean_of(const Scene& scene, int samples, const PathLimits& limits, int size = 16) {
        const Film film = film_of(scene, samples, limits, size);
        Vec3d sum{0, 0, 0};
        for (const Vec3d& pixel : film.sums()) sum = sum + pixel;
        return sum * (1.0 / (static_cast<double>(film.pixel_count()) * samples));
    }

    /// Expects the mean of red within 5 standard errors of `expected`. The pixels are samples of one value.
    void expect_mean(const Scene& scene, int samples, const PathLimits& limits, double expected) {
        const Film film = film_of(scene, samples, limits, 24);
        double sum = 0, squares = 0;
        for (const Vec3d& pixel : film.sums()) {
            sum += pixel.x / samples;
            squares += pixel.x / samples * (pixel.x / samples);
        }
        const auto count = static_cast<double>(film.pixel_count());
        const double mean = sum / count;
        const double error = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
        EXPECT_NEAR(mean, expected, 5 * error + 1e-6);
        EXPECT_LT(error, 0.02 * expected);  // or the test would say nothing
    }
};

// Every ray is counted: of the camera, of mirrors, and to lights that a surface would reflect if nothing stopped it.
TEST_P(ClosedForms, RaysAreCounted) {
    Scene scene = uniform_light({0, 0, 0});
    Material mirror = black("mirror");
    mirror.optics.mirror = {0.5F, 0.5F, 0.5F};
    Material lambertian = black("diffuse");
    lambertian.phong.diffuse = {0.5F, 0.5F, 0.5F};
    scene.materials = {mirror, lambertian};
    scene.nodes = {camera({0, 0, 0}, 0.1), body(BoxShape{{2, 2, 1}}, {0, 0, -2}, 1)};
    constexpr std::uint64_t samples = 16 * 16 * 3;
    EXPECT_EQ(render(scene, 3, {}).stats.rays, samples);
    scene.nodes.push_back({.name = "lamp", .trs = {.translation = {0, 0.5, 0}}, .light = LightSource{}});
    EXPECT_EQ(render(scene, 3, {}).stats.rays, 2 * samples) << "a light that all of it sees";
    // mirrors before and behind the camera: one ray for each of five reflections, none to a lamp that they do not show
    scene.nodes[1] = body(BoxShape{{2, 2, 1}}, {0, 0, -2}, 0);
    scene.nodes[2] = body(BoxShape{{2, 2, 1}}, {0, 0, 3}, 0);
    EXPECT_EQ(render(scene, 3, {.reflection = 5, .refraction = 0}).stats.rays, 6 * samples);
}

// Between two facing mirrors of reflectance r, each of which adds a: a sum over r^k. Ends at the limit of reflections.
TEST_P(ClosedForms, FacingMirrorsMakeAGeometricSeries) {
    Scene scene = uniform_light({0, 0, 0});
    Material mirror = black("mirror");
    mirror.phong.ambient = {0.5F, 0.25F, 0.125F};
    mirror.optics.mirror = {0.5F, 0.75F, 0.9F};
    scene.materials = {mirror};
    scene.nodes = {camera({0, 0, 0}, 0.1), body(BoxShape{{2, 2, 1}}, {0, 0, -2}, 0),
                   body(BoxShape{{2, 2, 1}}, {0, 0, 3}, 0)};
    for (const std::uint32_t limit : {0U, 1U, 7U, 100U}) {
        const Vec3d mean = mean_of(scene, 1, {.reflection = limit, .refraction = 0});
        for (int channel = 0; channel < 3; ++channel) {
            const double a = double{mirror.phong.ambient[channel]}, r = double{mirror.optics.mirror[channel]};
            EXPECT_NEAR(mean[channel], a * (1 - std::pow(r, limit + 1.0)) / (1 - r), 4e-6) << limit;
        }
    }
}

// Furnace test: in uniform light clear glass of any shape is invisible. R + T = 1 at every interface.
TEST_P(ClosedForms, ClearGlassVanishesInUniformLight) {
    Scene scene = uniform_light({1, 1, 1});
    Material glass = black("glass");
    glass.optics.transmission = 1;
    glass.optics.ior = 1.5F;
    Material diamond = glass;
    diamond.optics.ior = 2.4F;
    scene.materials = {glass, diamond};
    scene.nodes = {camera({0, 0, 4}, 1.5), body(SphereShape{0.7}, {-0.7, 0, 0}, 0),
                   body(SphereShape{0.5}, {0.65, 0.5, 0}, 1), body(BoxShape{{0.8, 0.5, 0.6}}, {0.7, -0.7, 0}, 0)};
    scene.nodes.back().trs.rotation = {0.2, 0.3, 0.1, 0.9};
    const Vec3d mean = mean_of(scene, 8, {.reflection = 255, .refraction = 255}, 48);
    // a path in the block may be reflected for long; those that are cut off at 255 are lost
    EXPECT_NEAR(mean.x, 1, 1e-6);
    EXPECT_NEAR(mean.y, 1, 1e-6);
}

// Beer's law: straight through a solid with the index of air.
TEST_P(ClosedForms, AbsorptionIsExponentialInTheWay) {
    Scene scene = uniform_light({1, 1, 1});
    Material tinted = black("tinted");
    tinted.optics = {.transmission = 1, .ior = 1, .absorption = {0, 0.3F, 2}};
    scene.materials = {tinted};
    scene.nodes = {camera({0, 0, 4}, 0.1), body(BoxShape{{2, 2, 1.75}}, {0, 0, 0}, 0)};
    const Vec3d mean = mean_of(scene, 1, {});
    EXPECT_NEAR(mean.x, 1, 1e-7);
    EXPECT_NEAR(mean.y, std::exp(-0.3 * 1.75), 1e-7);
    EXPECT_NEAR(mean.z, std::exp(-2 * 1.75), 1e-7);
}

// A slab seen from above, between a bright sky and a dark ground: 2 R / (1 + R) of the light comes from above, with
// Fresnel's R at normal incidence.
TEST_P(ClosedForms, ASlabReflectsAsFresnelSays) {
    for (const float ior : {1.33F, 1.5F, 2.4F}) {
        Scene scene = uniform_light({0, 0, 0});
        scene.environment.top = {1, 1, 1};
        Material glass = black("glass");
        glass.optics = {.transmission = 1, .ior = ior};
        scene.materials = {glass};
        scene.nodes = {camera({0, 4, 0}, 0.1, true), body(BoxShape{{2, 1, 2}}, {0, 0, 0}, 0)};
        const double r = std::pow((double{ior} - 1) / (double{ior} + 1), 2);
        const double expected = 2 * r / (1 + r);
        const int samples = 256;
        const double deviation = std::sqrt(expected * (1 - expected) / (16.0 * 16 * samples));
        const Vec3d mean = mean_of(scene, samples, {.reflection = 64, .refraction = 64});
        EXPECT_NEAR(mean.x, expected, 5 * deviation) << ior;
    }
}

// A ball of index n focuses rays along its axis at n r / (2 (n - 1)) from its centre.
TEST_P(ClosedForms, ABallLensFocusesWhereItShould) {
    const double ior = 1.5, radius = 1, focus = ior * radius / (2 * (ior - 1));
    Material glass = black("glass");
    glass.optics = {.transmission = 1, .ior = static_cast<float>(ior)};
    Material target = black("target");
    target.phong.ambient = {1, 1, 1};
    for (const double offset : {0.0, 0.25}) {  // of the target, along the axis
        Scene scene = uniform_light({0, 0, 0});
        scene.materials = {glass, target};
        scene.nodes = {camera({0, 0, 4}, 0.05), body(SphereShape{radius}, {0, 0, 0}, 0),
                       body(SphereShape{0.002}, {0, 0, -focus - offset}, 1)};
        // 4 % are reflected at each of the two borders
        const Vec3d mean = mean_of(scene, 64, {});
        if (offset == 0) {
            EXPECT_NEAR(mean.x, 0.96 * 0.96, 0.01);
        } else {
            EXPECT_LT(mean.x, 0.1);
        }
    }
}

// A point light of I candela over pi at distance d: kd I / d^2 from a surface that faces it.
TEST_P(ClosedForms, LightFallsOffWithTheSquareOfTheDistance) {
    for (const double height : {0.5, 2.0, 20.0}) {
        Scene scene = uniform_light({0, 0, 0});
        Material lambertian = black("diffuse");
        lambertian.phong.diffuse = {0.8F, 0.5F, 0.1F};
        scene.materials = {lambertian};
        scene.nodes = {camera({0, 0, 40}, 1e-4), body(BoxShape{{4, 4, 1}}, {0, 0, -0.5}, 0)};
        scene.nodes.push_back({.name = "lamp",
                               .trs = {.translation = {0, 0, height}},
                               .light = LightSource{.intensity = 3, .inverse_square = true}});
        const Vec3d mean = mean_of(scene, 1, {});
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = double{lambertian.phong.diffuse[channel]} * 3 / (height * height);
            EXPECT_NEAR(mean[channel] / expected, 1, 1e-6) << height;
        }
    }
}

// Under a sphere of radius r and radiance L at distance d: kd L (r / d)^2 from a Lambertian surface.
TEST_P(ClosedForms, ASphereLightsAsItsSolidAngleSays) {
    for (const double distance : {1.5, 4.0, 30.0}) {
        Scene scene = uniform_light({0, 0, 0});
        Material lambertian = black("diffuse"), lamp = black("lamp");
        lambertian.phong.diffuse = {0.6F, 0.6F, 0.6F};
        lamp.optics.emission = {5, 5, 5};
        scene.materials = {lambertian, lamp};
        scene.nodes = {camera({0, 0, 0.4}, 1e-4), body(BoxShape{{9, 9, 1}}, {0, 0, -0.5}, 0),
                       body(SphereShape{1}, {0, 0, distance}, 1)};
        expect_mean(scene, 64, {}, 0.6F * 5 / (distance * distance));
    }
}

// A ball of albedo kd in uniform light is kd all over.
TEST_P(ClosedForms, AConvexBodyInUniformLightShowsItsAlbedo) {
    Scene scene = uniform_light({1, 1, 1});
    Material lambertian = black("diffuse");
    lambertian.phong.diffuse = {0.7F, 0.7F, 0.7F};
    scene.materials = {lambertian};
    scene.nodes = {camera({0, 0, 4}, 0.3), body(SphereShape{1}, {0, 0, 0}, 0)};
    scene.environment.illuminates = 1;
    for (const bool indirect : {false, true}) {
        scene.indirect_light = indirect;
        EXPECT_NEAR(mean_of(scene, 16, {}).x, 0.7, 1e-6) << indirect;
    }
}

// Within walls of albedo a that emit e: e times the sum of a^k, up to one more than the limit of diffuse bounces, since
// the last vertex samples a light too. Paths and sampled lights share the light; Russian roulette does not change the
// mean.
TEST_P(ClosedForms, AnEmissiveRoomIsAGeometricSeries) {
    Scene scene = uniform_light({0, 0, 0});
    Material wall = black("wall");
    wall.phong.diffuse = {0.6F, 0.6F, 0.6F};
    wall.optics.emission = {2, 2, 2};
    scene.materials = {wall};
    scene.indirect_light = true;
    Mesh room{.name = "room",  // the fronts of its faces are within
              .positions =
                  {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
              .quads = {0, 1, 2, 3, 5, 4, 7, 6, 4, 0, 3, 7, 1, 5, 6, 2, 4, 5, 1, 0, 3, 2, 6, 7}};
    scene.meshes = {room};
    scene.nodes = {camera({0.1, 0.2, 0.5}, 0.4), body(MeshShape{0}, {0, 0, 0}, 0)};
    const double a = double{0.6F};
    for (const std::uint32_t limit : {0U, 1U, 3U, 12U}) {
        expect_mean(scene, 64, {.diffuse = limit}, 2 * (1 - std::pow(a, limit + 2.0)) / (1 - a));
    }
}

// A ball that is lit from the camera: kd cos, in the mean 2 / 3 kd of the disk that it covers.
TEST_P(ClosedForms, ALambertianBallIsTwoThirdsAsBright) {
    Scene scene = uniform_light({0, 0, 0});
    Material lambertian = black("diffuse");
    lambertian.phong.diffuse = {0.9F, 0.9F, 0.9F};
    scene.materials = {lambertian};
    scene.nodes = {camera({0, 0, 4}, 1),
                   body(SphereShape{1}, {0, 0, 0}, 0),
                   {.name = "sun", .light = LightSource{.kind = LightKind::directional}}};
    EXPECT_NEAR(mean_of(scene, 64, {}, 64).x, 0.9 * 2 / 3 * std::numbers::pi / 4, 1e-3);
}

// A small light out of focus: a disk of radius R |1 / d - 1 / f| on the film at distance 1, of which the mean square of
// the distance from the middle is half the square of its radius.
TEST_P(ClosedForms, ALensBlursAsItsCircleOfConfusionSays) {
    const double radius = 0.1, focus = 2, distance = 8, size = 64;
    Scene scene = uniform_light({0, 0, 0});
    Material lamp = black("lamp");
    lamp.optics.emission = {1000, 1000, 1000};
    scene.materials = {lamp};
    const double half_height = 0.06;
    Node eye{.name = "eye", .camera = PerspectiveCamera{2 * std::atan(half_height), {radius, focus}}};
    scene.nodes = {eye, body(SphereShape{0.004}, {0, 0, -distance}, 0)};
    const Film film = film_of(scene, 256, {}, 64);
    double weight = 0, square = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double x = (static_cast<double>(i % 64) + 0.5) / size * 2 - 1;
        const double y = (static_cast<double>(i / 64) + 0.5) / size * 2 - 1;
        weight += film.sums()[i].x;
        square += film.sums()[i].x * (x * x + y * y) * half_height * half_height;
    }
    const double circle = radius * (1 / focus - 1 / distance);
    EXPECT_NEAR(std::sqrt(2 * square / weight) / circle, 1, 0.03);
}

// The white furnace: a smooth metal that keeps all light cannot be told from an even background; of a rough one, single
// scattering keeps what the integral of the lobe says (tests/kernel/bsdf/ggx_reflection_test.cpp).
TEST_P(ClosedForms, AWhiteMetalVanishesInUniformLight) {
    Scene scene = uniform_light({0.5F, 0.25F, 1});
    scene.materials = {black("metal")};
    scene.materials[0].phong.diffuse = {1, 1, 1};
    scene.nodes = {camera({0, 0, 3}, 0.6), body(SphereShape{0.5}, {0, 0, 0}, 0)};
    for (const float roughness : {0.0F, 0.02F}) {
        scene.materials[0].microfacets = Microfacets{1, roughness};
        const Film film = film_of(scene, 4, {});
        for (const Vec3d& pixel : film.sums()) {
            EXPECT_NEAR(pixel.x / 4, 0.5, 1e-2 * 0.5) << roughness;
            EXPECT_NEAR(pixel.y / 4, 0.25, 1e-2 * 0.25) << roughness;
            EXPECT_NEAR(pixel.z / 4, 1, 1e-2) << roughness;
        }
    }
    // seen head-on: 1 - ln 2 of it, however the light comes in
    scene.nodes[0].camera = OrthographicCamera{1e-3};
    scene.materials[0].microfacets = Microfacets{1, 1};
    for (const bool by_chance : {false, true}) {
        scene.environment.illuminates = by_chance ? 1 : 0;
        scene.indirect_light = by_chance;
        expect_mean(scene, 64, {}, 0.5 * (1 - std::numbers::ln2));
    }
}

// Area lights, sampled and found by paths, together give the light of a background of equal radiance.
TEST_P(ClosedForms, AMetalInAnEmissiveRoomIsAsInUniformLight) {
    Scene scene = uniform_light({0, 0, 0});
    scene.materials = {black("metal"), black("lamp")};
    scene.materials[0].phong.diffuse = {1, 1, 1};
    scene.materials[1].optics.emission = {0.5F, 0.5F, 0.5F};
    scene.materials[1].sides = FaceSides::double_sided;
    // a room of six quads around a ball
    Mesh room{.name = "room"};
    for (int i = 0; i < 8; ++i) {
        const auto at = [&](int bit) { return (i & bit) != 0 ? 4.0F : -4.0F; };
        room.positions.push_back({at(1), at(2), at(4)});
    }
    room.quads = {0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3};
    scene.meshes = {room};
    scene.nodes = {camera({0, 0, 3}, 1e-3), body(SphereShape{0.5}, {0, 0, 0}, 0), body(MeshShape{0}, {0, 0, 0}, 1)};
    for (const float roughness : {0.3F, 0.7F, 1.0F}) {
        scene.materials[0].microfacets = Microfacets{1, roughness};
        const Vec3d mean = mean_of(scene, 256, {}, 24);
        Scene sky = uniform_light({0.5F, 0.5F, 0.5F});
        sky.materials = {scene.materials[0]};
        sky.nodes = {scene.nodes[0], scene.nodes[1]};
        const Vec3d by_sky = mean_of(sky, 256, {}, 24);
        EXPECT_NEAR(mean.x, by_sky.x, 5e-3) << roughness;
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, ClosedForms, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem

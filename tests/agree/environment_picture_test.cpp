// Environment pictures: a constant one equals the constant background, a white surface in a white one is invisible, and
// a bright spot gives the right amount of light.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "support/backend_list.h"
#include "support/estimate.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::Estimate;

EnvironmentImage constant_picture(const Vec3f& colour) { return {{8, 4, std::vector<Vec3f>(32, colour)}, 0.3, 1}; }

/// A ball between an orthographic camera and nothing; the film lies within its outline.
Scene ball(const PhongMaterial& phong, std::optional<Microfacets> microfacets, bool indirect) {
    Scene scene;
    scene.materials = {{"ball", phong}};
    scene.materials[0].microfacets = microfacets;
    Node body{.name = "ball"};
    body.geometry.push_back({SphereShape{1}, 0, {}});
    scene.nodes = {{.name = "eye", .trs = {.translation = {0, 0, 5}}, .camera = OrthographicCamera{0.6}}, body};
    scene.environment = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 1};
    scene.indirect_light = indirect;
    return scene;
}
constexpr PhongMaterial white_phong = {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 1};
constexpr PhongMaterial coloured = {{0, 0, 0}, {0.8F, 0.5F, 0.2F}, {0.3F, 0.3F, 0.3F}, 20};

class EnvironmentPictures : public test::ExactBackend {
  protected:
    [[nodiscard]] Film film_of(const Scene& scene, std::uint64_t seed, int samples = 4) {
        RenderJob job;
        job.width = job.height = 16;
        job.samples = samples;
        job.seed = seed;
        job.tier = GetParam().tier;
        return backend_->render(load(prepare(scene)), job).film;
    }
    /// The means of the film, of each of some seeds.
    [[nodiscard]] Estimate mean_of(const Scene& scene, std::uint64_t first_seed, int samples = 4) {
        Estimate estimate;
        for (std::uint64_t seed = first_seed; seed < first_seed + 24; ++seed) {
            double sum = 0;
            const Film film = film_of(scene, seed, samples);
            for (const Vec3d& pixel : film.sums()) sum += pixel.x + 2 * pixel.y + 3 * pixel.z;
            estimate.add(sum / (16 * 16 * samples));
        }
        return estimate;
    }
};

TEST_P(EnvironmentPictures, OfOneColourAreTheConstantBackground) {
    const Vec3f colour = {0.9F, 0.6F, 0.3F};
    for (const bool indirect : {false, true}) {
        for (const auto& facets : {std::optional<Microfacets>{}, std::optional<Microfacets>{{0.3F, 0.4F}}}) {
            Scene gradient = ball(coloured, facets, indirect);
            gradient.environment.bottom = gradient.environment.top = colour;
            Scene picture = gradient;
            picture.environment_image = constant_picture(colour);
            const Estimate expected = mean_of(gradient, 1), result = mean_of(picture, 1000);
            // Welch's test; 5 standard errors are one chance in 10^5 with this many films
            const double error = std::sqrt(expected.variance_of_mean() + result.variance_of_mean());
            EXPECT_NEAR(result.mean(), expected.mean(), 5 * error + 1e-6) << indirect << facets.has_value();
            EXPECT_LT(error, 0.01 * expected.mean());
        }
    }
}

// Light is neither gained nor lost, whether paths or samples find it.
TEST_P(EnvironmentPictures, HideAWhiteBall) {
    for (const bool indirect : {false, true}) {
        Scene scene = ball(white_phong, {}, indirect);
        scene.environment_image = constant_picture({1, 1, 1});
        test::expect_mean(mean_of(scene, 7), 6, indirect ? "indirect" : "direct");
    }
}

// The light of one texel, by its solid angle: on a surface that faces it, what it emits times its extent over pi.
TEST_P(EnvironmentPictures, LightByASingleTexel) {
    Scene scene = ball(white_phong, {}, false);
    scene.nodes[0].camera = OrthographicCamera{1e-3};
    EnvironmentImage image{{256, 128, std::vector<Vec3f>(256 * 128, Vec3f{0, 0, 0})}, 0, 2};
    // in the middle of the picture is -z; the camera looks at what faces +z, half of the picture further
    image.picture.pixels[std::size_t{64} * 256] = {1000, 1000, 1000};
    scene.environment_image = image;
    // a bilinear tent has the volume of one cell; y = cos of the polar angle, which is linear
    const double pi = std::numbers::pi;
    const auto height = [&](double row) { return std::cos((row + 0.5) * pi / 128); };
    const double area = 2 * pi / 256 * (height(63) - height(65)) / 2;
    const double cosine = std::sin(64.5 * pi / 128) * std::cos(pi / 256);
    const double expected = 6 * 2000 * area * cosine / pi;
    EXPECT_NEAR(mean_of(scene, 3, 16).mean(), expected, 2e-3 * expected);
}

// What a camera sees of it is the picture itself.
TEST_P(EnvironmentPictures, AreSeenWhereNothingIsHit) {
    Scene scene;
    scene.nodes = {{.name = "eye", .camera = PerspectiveCamera{1e-4}}};
    EnvironmentImage image{{4, 3, std::vector<Vec3f>(12, Vec3f{0, 0, 0})}, 0, 3};
    image.picture.pixels[5] = image.picture.pixels[6] = {1, 2, 4};
    scene.environment_image = image;
    const Film ahead = film_of(scene, 1);
    for (const Vec3d& pixel : ahead.sums()) EXPECT_NEAR(pixel.y / 4, 6, 1e-3);
    scene.environment_image->rotation = std::numbers::pi / 2;  // to the left
    EXPECT_NEAR(film_of(scene, 1).sums()[0].y / 4, 3, 1e-2) << "between a bright column and a dark one";
}

INSTANTIATE_TEST_SUITE_P(Backends, EnvironmentPictures, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem

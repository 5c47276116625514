#include "tandem/render/foreground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "support/pixel_index.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/oracle/oracle.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

constexpr Vec3f black_rgb{0, 0, 0};

struct View {
    const char* name;
    std::function<void(Camera&)> change;
};
void PrintTo(const View& view, std::ostream* out) { *out << view.name; }

class Foreground : public testing::TestWithParam<View> {};

/// How many of 25 rays through a pixel hit something.
int hits_of(const PreparedScene& scene, const CameraView& camera, int x, int y) {
    int hits = 0;
    for (int i = 0; i < 25; ++i) {
        const float across = static_cast<float>(i % 5) / 4, down = static_cast<float>(i / 5) / 4;
        hits += oracle_trace(scene, camera_ray<float>(camera, x, y, across, down)).primitive != no_primitive ? 1 : 0;
    }
    return hits;
}

TEST_P(Foreground, IsWhatHidesTheBackground) {
    Scene scene = named_scene("paper");
    scene.environment.bottom = {3, 2, 1};  // unlike any body
    scene.environment.top = {40, 60, 80};
    GetParam().change(*scene.nodes[0].camera);
    const PreparedScene prepared = prepare(scene);
    const RenderJob job{.width = 24, .height = 20, .samples = 4};
    const std::unique_ptr<Backend> oracle = make_oracle_backend({});
    const Film film = oracle->render(oracle->load(prepared, job.tier), job).film;
    const FloatImage seen = Backdrop(prepared, job.width, job.height).foreground(film);
    const CameraView camera = camera_view(prepared.camera, job.width, job.height);
    int bodies = 0, backgrounds = 0;
    for (int y = 0; y < job.height; ++y) {
        for (int x = 0; x < job.width; ++x) {
            const auto i = test::pixel_index(x, y, job.width);
            const int hits = hits_of(prepared, camera, x, y);
            if (hits == 25) {
                EXPECT_EQ(seen.pixels[i], film.mean(i)) << x << ", " << y;
                ++bodies;
            } else if (hits == 0) {
                EXPECT_EQ(seen.pixels[i], black_rgb) << x << ", " << y;
                ++backgrounds;
            }
        }
    }
    EXPECT_GT(bodies, 20);
    EXPECT_GT(backgrounds, 200);
}

INSTANTIATE_TEST_SUITE_P(Cameras, Foreground,
                         testing::Values(View{"perspective", [](Camera&) {}},
                                         View{"orthographic", [](Camera& camera) { camera = OrthographicCamera{1.5}; }},
                                         View{"lens",
                                              [](Camera& camera) {
                                                  std::get<PerspectiveCamera>(camera).lens = {0.002, 3, 0, 0};
                                              }}),
                         [](const auto& info) { return std::string(info.param.name); });

// Samples of a wide filter see the background beyond the pixel.
TEST(ForegroundOfFilms, KnowsTheReachOfTheFilter) {
    Scene scene = named_scene("paper");
    scene.nodes.erase(scene.nodes.begin() + 1, scene.nodes.end());  // all but the camera
    scene.animation.clear();
    scene.environment.bottom = {1, 1, 1};
    scene.environment.top = {0, 9, 0};
    const PreparedScene prepared = prepare(scene);
    RenderJob job{.width = 24, .height = 20, .samples = 1};  // a sample alone is anywhere in the filter
    job.filter = PixelFilter::gaussian;
    const std::unique_ptr<Backend> oracle = make_oracle_backend({});
    const Film film = oracle->render(oracle->load(prepared, job.tier), job).film;
    const auto visible = [&](PixelFilter filter) {
        const FloatImage seen = Backdrop(prepared, job.width, job.height, filter).foreground(film);
        return std::count_if(seen.pixels.begin(), seen.pixels.end(), [](const Vec3f& c) { return !(c == black_rgb); });
    };
    EXPECT_EQ(visible(PixelFilter::gaussian), 0);
    EXPECT_GT(visible(PixelFilter::box), 5) << "the test can fail";
}

TEST(ForegroundOfFilms, OfABlackBackgroundIsEverything) {
    Scene scene = named_scene("paper");
    scene.environment.bottom = scene.environment.top = black_rgb;
    Film film(2, 1, 2);
    film.sums()[0] = {1, 2, 4};
    film.sums()[1] = {-0.25, 0, 1e-30};
    const FloatImage seen = Backdrop(prepare(scene), 2, 1).foreground(film);
    EXPECT_EQ(seen.pixels[0], Vec3f(0.5F, 1, 2));
    EXPECT_EQ(seen.pixels[1], film.mean(1));
}

}  // namespace
}  // namespace tandem

// The rasteriser draws every sample of a surface once, the nearest first, and what the tracer draws without effects.
#include "baseline/rasteriser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "loop_backend.h"
#include "support/pixel_index.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::bench {
namespace {

constexpr std::uint32_t nothing = 0xFFFFFFFFU;

ScreenTriangle on_screen(const ScreenCorner& a, const ScreenCorner& b, const ScreenCorner& c) {
    ScreenTriangle triangle{{a, b, c}, doubled_area(a, b, c), 0};
    if (triangle.area < 0) {
        std::swap(triangle.corners[1], triangle.corners[2]);
        triangle.area = -triangle.area;
    }
    return triangle;
}

/// A pinhole at the origin that looks along -z, with a right angle of view upwards.
Scene seen_by_a_camera() {
    Scene scene;
    scene.materials.resize(1);
    scene.nodes = {{.name = "camera", .camera = PerspectiveCamera{1.5707963267948966}}};
    return scene;
}

void add(Scene& scene, const Mesh& mesh) {
    Node node{.name = mesh.name};
    node.geometry.push_back({MeshShape{static_cast<std::uint32_t>(scene.meshes.size())}, 0, {}});
    scene.meshes.push_back(mesh);
    scene.nodes.push_back(node);
}

RasterScene raster_scene(const Scene& scene, int width, int height) {
    return make_raster_scene(prepare(scene), width, height);
}

/// A plane of triangles between shared corners that are shaken, whose border stays where it is: corners on whole
/// positions and on the places of samples, where edges meet samples exactly.
TEST(Rasteriser, EverySampleOfAMeshIsCoveredOnce) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 60; ++trial) {
        constexpr int cells = 12, pixels = 40;
        const int step = pixels / cells;
        std::vector<ScreenCorner> corners;
        std::uniform_int_distribution<std::int64_t> shake(-subpixels, subpixels);
        for (int y = 0; y <= cells; ++y) {
            for (int x = 0; x <= cells; ++x) {
                const bool inner = x > 0 && y > 0 && x < cells && y < cells;
                const auto moved = [&](int at) {
                    const std::int64_t whole = at * step * subpixels;
                    if (!inner) return whole;
                    // every other trial on halves of pixels alone, so that edges pass through samples
                    return trial % 2 == 0 ? whole + shake(random) : whole + shake(random) % 3 * (subpixels / 2);
                };
                corners.push_back({moved(x), moved(y), 1, 0, {}});
            }
        }
        std::vector<int> covered(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
        const SamplePlace place = trial % 3 == 0 ? SamplePlace{0, 0} : SamplePlace{};
        const auto draw = [&](const ScreenTriangle& triangle) {
            if (triangle.area == 0) return;
            fill(triangle, place, {0, pixels, 0, pixels}, [&](int x, int y, const EdgeValues& edges) {
                ++covered[test::pixel_index(x, y, pixels)];
                EXPECT_EQ(edges.of[0] + edges.of[1] + edges.of[2], triangle.area);
            });
        };
        for (int y = 0; y < cells; ++y) {
            for (int x = 0; x < cells; ++x) {
                const auto at = [&](int dx, int dy) { return corners[test::pixel_index(x + dx, y + dy, cells + 1)]; };
                // a convex cell has either diagonal; a folded one would cover samples twice
                const bool first =
                    doubled_area(at(0, 0), at(1, 0), at(1, 1)) > 0 && doubled_area(at(0, 0), at(1, 1), at(0, 1)) > 0;
                if (first) {
                    draw(on_screen(at(0, 0), at(1, 0), at(1, 1)));
                    draw(on_screen(at(0, 0), at(1, 1), at(0, 1)));
                } else {
                    draw(on_screen(at(0, 0), at(1, 0), at(0, 1)));
                    draw(on_screen(at(1, 0), at(1, 1), at(0, 1)));
                }
            }
        }
        for (int y = 0; y < pixels; ++y) {
            for (int x = 0; x < pixels; ++x) {
                // the top and the left border belong to the mesh, the right and the bottom one do not
                const bool inside = x < cells * step && y < cells * step;
                ASSERT_EQ(covered[test::pixel_index(x, y, pixels)], inside ? 1 : 0)
                    << "trial " << trial << ", pixel " << x << ' ' << y;
            }
        }
    }
}

TEST(Rasteriser, ShowsTheFirstHitsOfTheTracer) {
    for (const char* name : {"boxes/40", "triangles/1000", "quads/600", "mixed/12"}) {
        const PreparedScene prepared = prepare(named_scene(name));
        const int width = 100, height = 80;
        const RasterScene scene = make_raster_scene(prepared, width, height);
        const std::vector<std::uint32_t> shown = visible_triangles(scene, width, height, {});
        // the tracer sees the triangles of the rasteriser, as faces
        PreparedScene faces;
        faces.camera = prepared.camera;
        for (const RasterTriangle& triangle : scene.triangles) {
            faces.triangles.push_back({triangle.corners[0], triangle.corners[1], triangle.corners[2], {}});
            faces.triangles.back().attributes.sides = triangle.sides;
        }
        faces.material_of.assign(faces.triangles.size(), 0);
        std::vector<Ray<float>> rays;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) rays.push_back(camera_ray<float>(scene.camera, x, y, 0.5F, 0.5F));
        }
        LoopBackend tracer("cpu", false, true);
        std::vector<Hit> seen(rays.size());
        tracer.trace(*tracer.load(faces, Tier::strict), TraceJob{rays, seen});
        int differing = 0, hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const std::uint32_t expected = seen[i].primitive == no_primitive ? nothing : seen[i].primitive;
            hits += expected != nothing;
            differing += shown[i] != expected;
        }
        EXPECT_GT(hits, 300) << name;
        EXPECT_LE(differing, hits / 100) << name << ": only edges may differ, where corners are on a grid";
    }
}

TEST(Rasteriser, DrawsThePaperAsTheTracerDoes) {
    const int width = 100, height = 90, samples = 64;
    for (const int frame : {0, 45}) {
        const PreparedScene prepared = prepare(named_scene("paper"), {.frame = frame});
        const Film drawn = rasterise(make_raster_scene(prepared, width, height), {width, height, samples, 3, 2});
        LoopBackend backend("cpu", false, true);
        const Film traced =
            backend.render(backend.load(prepared, Tier::strict), {width, height, samples, 5, 0, Tier::strict}).film;
        const FilmDifference difference = compare(drawn, traced);
        EXPECT_LT(difference.mean, 0.002) << "frame " << frame;
        EXPECT_LT(difference.rms, 0.015) << "frame " << frame;
        EXPECT_GT(difference.rms, 0) << "it is another program";
    }
}

/// A floor from behind the camera to the horizon: its corners are in front, beside and behind.
TEST(Rasteriser, CutsAtTheNearPlane) {
    Scene scene = seen_by_a_camera();
    add(scene, {.name = "floor",
                .positions = {{-50, -1, 50}, {50, -1, 50}, {50, -1, -50}, {-50, -1, -50}},
                .quads = {0, 1, 2, 3}});
    const int width = 64, height = 64;
    const std::vector<std::uint32_t> shown = visible_triangles(raster_scene(scene, width, height), width, height, {});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // the ray through a pixel falls by (y - 32) / 32 for each metre ahead, and meets y = -1 before z = -50
            const double fall = (y + 0.5 - 32) / 32;
            const bool floor = fall > 1.0 / 50;
            EXPECT_EQ(shown[test::pixel_index(x, y, width)] != nothing, floor) << x << ' ' << y;
        }
    }
}

TEST(Rasteriser, ShowsNothingThatIsBehindTheCamera) {
    Scene scene = seen_by_a_camera();
    add(scene, {.name = "behind", .positions = {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}}, .triangles = {0, 1, 2, 0, 2, 1}});
    Node ball{.name = "ball", .trs = {.translation = {0, 0, 3}}};
    ball.geometry.push_back({SphereShape{1}, 0, {}});
    scene.nodes.push_back(ball);
    const std::vector<std::uint32_t> shown = visible_triangles(raster_scene(scene, 40, 30), 40, 30, {});
    EXPECT_EQ(std::count(shown.begin(), shown.end(), nothing), 40 * 30);
}

/// Two walls through each other: depth is not linear on the screen, and the nearer one changes in the middle.
TEST(Rasteriser, DepthIsPerspectivelyCorrect) {
    Scene scene = seen_by_a_camera();
    add(scene, {.name = "slanted",
                .positions = {{-8, -9, -1}, {8, -9, -17}, {8, 9, -17}, {-8, 9, -1}},
                .quads = {0, 1, 2, 3}});
    add(scene, {.name = "straight",
                .positions = {{-99, -9, -9}, {99, -9, -9}, {99, 9, -9}, {-99, 9, -9}},
                .quads = {0, 1, 2, 3}});
    const int width = 128, height = 16;
    const std::vector<std::uint32_t> shown = visible_triangles(raster_scene(scene, width, height), width, height, {});
    for (int x = 0; x < width; ++x) {
        // the slanted wall, z = -9 - x, is in front of the straight one left of x = 0
        const double direction = (x + 0.5 - width / 2.0) / (height / 2.0);
        const bool slanted = direction < 0 && -9 / (1 - direction) * -direction > -8;
        const std::uint32_t triangle = shown[test::pixel_index(x, height / 2, width)];
        ASSERT_NE(triangle, nothing);
        EXPECT_EQ(triangle < 2, slanted) << x;
    }
}

TEST(Rasteriser, CulledBacksAreLeftOutAndOthersAreNot) {
    for (const FaceSides sides : {FaceSides::single_sided, FaceSides::double_sided, FaceSides::culled}) {
        Scene scene = seen_by_a_camera();
        scene.materials[0].sides = sides;
        add(scene, {.name = "back", .positions = {{-9, -9, -2}, {9, -9, -2}, {0, 9, -2}}, .triangles = {0, 2, 1}});
        const auto shown = visible_triangles(raster_scene(scene, 20, 20), 20, 20, {});
        EXPECT_EQ(std::count(shown.begin(), shown.end(), nothing) == 400, sides == FaceSides::culled);
    }
}

TEST(Rasteriser, OrthographicCamerasSeeInParallel) {
    Scene scene = seen_by_a_camera();
    scene.nodes[0].camera = OrthographicCamera{2};
    scene.nodes[0].trs.translation = {0, 0, 10};
    for (const double z : {-1.0, -30.0}) {
        Scene with = scene;
        Node box{.name = "box", .trs = {.translation = {0, 0, z}}};
        box.geometry.push_back({BoxShape{{2, 2, 1}}, 0, {}});
        with.nodes.push_back(box);
        const auto shown = visible_triangles(raster_scene(with, 40, 40), 40, 40, {});
        EXPECT_EQ(1600 - std::count(shown.begin(), shown.end(), nothing), 400) << "half of each side, however far";
    }
}

TEST(Rasteriser, ThreadsDoNotChangeTheFilmAndSeedsDo) {
    const RasterScene scene = make_raster_scene(prepare(named_scene("mixed/20")), 50, 70);
    const std::string one = film_hash(rasterise(scene, {50, 70, 3, 9, 1}));
    EXPECT_EQ(one, film_hash(rasterise(scene, {50, 70, 3, 9, 4})));
    EXPECT_NE(one, film_hash(rasterise(scene, {50, 70, 3, 10, 4})));
}

TEST(Rasteriser, SamplesAreSpreadOverThePixel) {
    const std::vector<SamplePlace> places = sample_places({1, 1, 64, 1, 1});
    int quarters[4] = {};
    for (const SamplePlace& place : places) {
        ASSERT_TRUE(place.x >= 0 && place.x < subpixels && place.y >= 0 && place.y < subpixels);
        ++quarters[2 * (place.y * 2 / subpixels) + place.x * 2 / subpixels];
    }
    for (const int count : quarters) EXPECT_NEAR(count, 16, 3);
}

TEST(Rasteriser, SpheresAreAsFineAsPixelsAsk) {
    const PreparedScene paper = prepare(named_scene("paper"));
    const std::size_t small = make_raster_scene(paper, 100, 90).triangles.size();
    const std::size_t large = make_raster_scene(paper, 1000, 900).triangles.size();
    EXPECT_GT(large, 3 * small);
    EXPECT_EQ(make_raster_scene(paper, 1, 1).triangles.size(), 3U * 20 + 12) << "20 triangles a sphere, and the cube";
}

TEST(Rasteriser, SaysWhatIsTooMuch) {
    PreparedScene scene = prepare(named_scene("paper"));
    scene.spheres.resize(200'001, scene.spheres[0]);
    EXPECT_NE(why_not_rasterised(scene).find("at most 4000000"), std::string::npos);
    EXPECT_THROW((void)make_raster_scene(scene, 10, 10), EnvironmentError);
}

}  // namespace
}  // namespace tandem::bench

// Planes beside the colour: equal bits from every backend, near the oracle's, and what they are defined to be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/effect_scenes.h"
#include "support/film_of_the_oracle.h"
#include "support/pixel_index.h"
#include "support/small_job.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_image.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/motion_blur.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

struct NamedScene {
    std::string name;
    PreparedScene scene;
};

/// With every kind of primitive, copies, alpha masks, textures, normal maps, a lens, a dielectric.
const std::vector<NamedScene>& scenes() {
    static const std::vector<NamedScene> list = [] {
        std::vector<NamedScene> all;
        for (const char* name : {"paper", "mixed/64", "triangles/60", "quads/60", "icosphere/1"}) {
            all.push_back({name, prepare(named_scene(name), {.frame = 11})});
        }
        for (const test::EffectScene& entry : test::effect_scenes()) {
            all.push_back({entry.name, prepare(entry.scene)});
        }
        Scene twice = named_scene("spheres/7");
        const std::vector<Node> nodes = twice.nodes;
        const auto has_geometry = [](const Node& node) { return !node.geometry.empty(); };
        const auto first = std::find_if(nodes.begin(), nodes.end(), has_geometry);
        twice.nodes.insert(twice.nodes.begin() + (first - nodes.begin()), 2, *first);
        all.push_back({"copies", prepare(twice)});
        EXPECT_FALSE(all.back().scene.copies.empty());
        return all;
    }();
    return list;
}

RenderJob small_job(Tier tier, PlaneMask planes) {
    RenderJob job = test::small_job(tier);
    job.planes = planes;
    return job;
}

const PlaneMask all = parse_planes("all");

class PlaneBits : public test::ExactBackend {
  protected:
    [[nodiscard]] static RenderJob job(PlaneMask planes) { return small_job(GetParam().tier, planes); }
    [[nodiscard]] Film render(const PreparedScene& scene, const RenderJob& job) {
        return backend_->render(load(scene), job).film;
    }
    [[nodiscard]] Film render(const PreparedScene& scene, PlaneMask planes) { return render(scene, job(planes)); }
};

/// The pixels of a window of `film`.
Film cut_out(const Film& film, const FilmWindow& window) {
    Film part(window.width, window.height, film.samples(), film.plane_mask());
    const ConstFilmPlanes from = film.planes();
    const FilmPlanes to = part.planes();
    for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
            const auto source = test::pixel_index(window.left + x, window.top + y, film.width());
            const auto target = test::pixel_index(x, y, window.width);
            part.sums()[target] = film.sums()[source];
#define TANDEM_PLANE(name, Value, rule, channels, help) to.name[target] = from.name[source];
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
        }
    }
    return part;
}

TEST_P(PlaneBits, OfAWindowAreThoseOfTheFilm) {
    const FilmWindow windows[] = {{17, 9, 23, 31}, {60, 42, 1, 1}, {0, 0, 61, 43}};
    for (const auto& [name, scene] : scenes()) {
        const Film film = render(scene, all);
        for (const FilmWindow& window : windows) {
            RenderJob part = job(all);
            part.window = window;
            const Film got = render(scene, part);
            const Film expected = cut_out(film, window);
            EXPECT_EQ(film_hash(got), film_hash(expected)) << name << ", window at " << window.left;
#define TANDEM_PLANE(plane, Value, rule, channels, help)                                 \
    EXPECT_EQ(plane_hash(got, FilmPlane::plane), plane_hash(expected, FilmPlane::plane)) \
        << name << ", window at " << window.left << ", " #plane;
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
        }
    }
}

TEST_P(PlaneBits, AreThoseOfTheLeastProcessorAndLeaveTheColourAlone) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    least.tile_size = 13;
    const auto reference = make_backend("cpu", least);
    for (const auto& [name, scene] : scenes()) {
        const Film film = render(scene, all);
        const Film expected = reference->render(reference->load(scene, GetParam().tier), job(all)).film;
        EXPECT_EQ(film_hash(film), film_hash(render(scene, PlaneMask{}))) << name;
        for (const PlaneInfo& info : plane_infos()) {
            EXPECT_EQ(plane_hash(film, info.plane), plane_hash(expected, info.plane)) << name << ", " << info.name;
        }
    }
}

TEST_P(PlaneBits, DoNotDependOnWhichOthersAreAskedFor) {
    for (const auto& [name, scene] : scenes()) {
        const Film film = render(scene, all);
        for (const PlaneInfo& info : plane_infos()) {
            const Film alone = render(scene, info.plane);
            EXPECT_EQ(alone.plane_mask(), PlaneMask(info.plane));
            EXPECT_EQ(plane_hash(alone, info.plane), plane_hash(film, info.plane)) << name << ", " << info.name;
        }
    }
}

double distance(const Vec3d& a, const Vec3d& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

TEST_P(PlaneBits, AreNearTheOracle) {
    const PlaneMask wanted = FilmPlane::albedo | FilmPlane::normal | FilmPlane::depth | FilmPlane::primitive |
                             FilmPlane::material | FilmPlane::count;
    for (const auto& [name, scene] : scenes()) {
        const Film film = render(scene, wanted);
        const RenderJob same_job = job(wanted);
        const Film& right = test::film_of_the_oracle(scene, "planes", same_job);
        const ConstFilmPlanes a = std::as_const(film).planes(), b = right.planes();
        std::size_t others = 0;
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            EXPECT_EQ(a.count[i], b.count[i]);
            const bool same = a.primitive[i] == b.primitive[i] && a.material[i] == b.material[i] &&
                              (a.depth[i] == b.depth[i] || std::abs(a.depth[i] - b.depth[i]) <= 3e-6F * b.depth[i]) &&
                              distance(a.normal[i], b.normal[i]) < 1e-3 && distance(a.albedo[i], b.albedo[i]) < 1e-3;
            others += !same;
        }
        // a sample near a corner of a mask or a texel may fall on either side
        EXPECT_LE(others, 2U) << name;
    }
}

TEST_P(PlaneBits, OfAWallAreWhatTheDocumentationSays) {
    Scene scene;
    Material paint{"paint", {{0, 0, 0}, {0.5F, 0.25F, 0.125F}, {0.25F, 0.25F, 1.0F}, 20}};
    scene.materials = {Material{"other", {}}, paint};
    Node eye{.name = "eye", .camera = PerspectiveCamera{1.2}};
    eye.trs.translation = {0.5, 0.25, 7};
    Node wall{.name = "wall", .trs = {.translation = {0, 0, 1}}};
    wall.geometry.push_back({BoxShape{{4, 40, 2}}, 1, {}});
    scene.nodes = {eye, wall};
    const Film film = render(prepare(scene), all);
    const ConstFilmPlanes planes = film.planes();
    std::size_t hits = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const bool all_hit = planes.normal[i].z == 4, none_hit = planes.normal[i].z == 0;
        if (planes.primitive[i] == 0) {
            EXPECT_NEAR(planes.depth[i], 5, 2e-6) << i;  // along the axis: the same in the corners
            EXPECT_EQ(planes.material[i], 1U);
            EXPECT_FALSE(none_hit);
        } else {
            EXPECT_EQ(planes.primitive[i], no_primitive);
            EXPECT_EQ(planes.material[i], no_primitive);
            EXPECT_TRUE(std::isinf(planes.depth[i]));
            EXPECT_FALSE(all_hit);
        }
        if (all_hit || none_hit) {  // 1.125 of blue is cut off
            EXPECT_EQ(planes.albedo[i], all_hit ? Vec3d(3, 2, 4) : Vec3d(0, 0, 0)) << i;
        }
        EXPECT_EQ(planes.count[i], 4U);
        hits += all_hit;
    }
    EXPECT_GT(hits, film.pixel_count() / 4);
    EXPECT_LT(hits, film.pixel_count() / 2);
}

TEST_P(PlaneBits, OfRangesOfSamplesAddUp) {
    const PreparedScene& scene = scenes().front().scene;
    const Film whole = render(scene, all);
    RenderJob first = job(all), rest = first;
    first.samples = 1;
    rest.first_sample = 1;
    rest.samples = 3;
    Film sum = render(scene, first);
    sum.add(render(scene, rest));
    EXPECT_EQ(sum.samples(), 4);
    for (const FilmPlane same : {FilmPlane::depth, FilmPlane::primitive, FilmPlane::material, FilmPlane::count}) {
        EXPECT_EQ(plane_hash(sum, same), plane_hash(whole, same)) << info_of(same).name;
    }
    const FilmPlanes a = sum.planes();
    const ConstFilmPlanes b = whole.planes();
    for (std::size_t i = 0; i < sum.pixel_count(); ++i) {
        EXPECT_LE(distance(a.normal[i], b.normal[i]), 1e-14);
        EXPECT_LE(distance(a.albedo[i], b.albedo[i]), 1e-14);
        EXPECT_LE(distance(a.variance[i], b.variance[i]), 1e-13);
    }
}

// The estimate's mean over many films is the variance that their means have: an unbiased estimate of the right thing.
TEST_P(PlaneBits, VarianceIsThatOfThePixelsMeans) {
    const PreparedScene& scene = scenes().front().scene;
    const auto resident = load(scene);
    RenderJob one = job(FilmPlane::variance);
    one.width = 31;
    one.height = 23;
    constexpr int films = 60;
    const std::size_t pixels = 31 * 23;
    std::vector<double> sum(pixels, 0), squares(pixels, 0);
    double estimated = 0, measured = 0;
    for (int i = 0; i < films; ++i) {
        one.seed = 100 + static_cast<std::uint64_t>(i);
        const Film film = backend_->render(resident, one).film;
        const std::vector<PlaneImage> images = plane_images(film);
        for (std::size_t p = 0; p < pixels; ++p) {
            const double mean = film.mean(p).y;
            sum[p] += mean;
            squares[p] += mean * mean;
            estimated += double{images[0].values[3 * p + 1]} / films;
        }
    }
    for (std::size_t p = 0; p < pixels; ++p) measured += (squares[p] - sum[p] * sum[p] / films) / (films - 1);
    EXPECT_GT(measured, 0.01);
    EXPECT_NEAR(estimated / measured, 1, 0.05);
}

TEST_P(PlaneBits, OfMotionBlurAreThoseOfItsInstants) {
    Scene scene = named_scene("paper");
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = {.open = 0, .close = 0.5, .instants = 3};
    }
    const RenderJob one = job(all);
    const FramePlan plan = plan_frame(scene, {.frame = 30}, one);
    ASSERT_TRUE(is_blurred(plan));
    const Film film = render_frame(*backend_, scene, plan).result.film;
    ASSERT_EQ(film.plane_mask(), all);
    EXPECT_EQ(film.samples(), one.samples);
    const FrameInstant& first = plan.instants.front();
    const Film start = render(prepare(scene, first.prepare), first.job);
    EXPECT_EQ(plane_hash(film, FilmPlane::depth), plane_hash(start, FilmPlane::depth));
    EXPECT_EQ(plane_hash(film, FilmPlane::primitive), plane_hash(start, FilmPlane::primitive));
    EXPECT_NE(plane_hash(film, FilmPlane::variance), plane_hash(start, FilmPlane::variance));
    EXPECT_EQ(film.planes().count[0], static_cast<std::uint32_t>(one.samples));
}

INSTANTIATE_TEST_SUITE_P(Backends, PlaneBits, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem

// Every backend against the oracle, ray by ray: the same primitive always, t within one unit of the last place.

#include <gtest/gtest.h>

#include <cmath>

#include "support/backend_list.h"
#include "support/bundles.h"
#include "support/hard_scenes.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/oracle/oracle.h"
#include "tandem/render/ray_coherence.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

#if defined(TANDEM_ONE_INSTRUCTION_SET)
constexpr std::size_t least_rays = 100'000;  // a sanitizer's build, five times as slow, looks for other faults
#else
constexpr std::size_t least_rays = 1'000'000;
#endif
constexpr std::size_t rays_per_scene = least_rays / 100 * 9;  // nineteen scenes, some with a tenth of that
constexpr std::uint64_t scene_seed = 20;
constexpr std::uint64_t ray_seed = 21;

/// Distance in units of the last place.
std::int64_t ulps_between(float a, float b) {
    const auto ordered = [](float x) { return static_cast<std::int64_t>(bits_of(x)); };  // t is positive
    return std::abs(ordered(a) - ordered(b));
}

std::string describe(const test::HardScene& scene, std::size_t index, const Ray<float>& ray) {
    char text[400];
    std::snprintf(text, sizeof(text), "scene '%s' (seed %llu), ray %zu (seed %llu): origin %a %a %a direction %a %a %a",
                  scene.name.c_str(), static_cast<unsigned long long>(scene_seed), index,
                  static_cast<unsigned long long>(ray_seed), static_cast<double>(ray.origin.x),
                  static_cast<double>(ray.origin.y), static_cast<double>(ray.origin.z),
                  static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.y),
                  static_cast<double>(ray.direction.z));
    return text;
}

/// The oracle's answers, once for all backends.
struct Reference {
    test::HardScene parameters;
    PreparedScene scene;
    std::vector<Ray<float>> rays;
    std::vector<Hit> hits;
};

const std::vector<Reference>& references() {
    static const std::vector<Reference> all = [] {
        std::vector<Reference> list;
        const auto oracle = make_backend("oracle");
        std::vector<test::HardScene> scenes = test::hard_scenes();
        for (test::HardScene& of_one_kind : test::scenes_of_one_kind()) scenes.push_back(std::move(of_one_kind));
        for (const test::HardScene& parameters : scenes) {
            Reference r{parameters, test::make_scene(parameters, scene_seed), {}, {}};
            // the crowd is dear for brute force
            r.rays = test::make_rays(r.scene, parameters.count > 500 ? rays_per_scene / 10 : rays_per_scene, ray_seed);
            r.hits.resize(r.rays.size());
            oracle->trace(*oracle->load(r.scene), r.rays, r.hits);
            list.push_back(std::move(r));
        }
        return list;
    }();
    return all;
}

class ClosestHit : public test::ExactBackend {};

TEST_P(ClosestHit, AgreesWithTheOracle) {
    std::size_t total = 0;
    for (const Reference& reference : references()) {
        const auto scene = load(reference.scene);
        std::vector<Hit> hits(reference.rays.size());
        std::vector<double> wide_t(reference.rays.size());
        backend_->trace(*scene, {.rays = reference.rays, .hits = hits, .wide_t = wide_t});
        std::size_t found = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            found += hits[i].primitive != no_primitive;
            ASSERT_EQ(hits[i].primitive, reference.hits[i].primitive)
                << describe(reference.parameters, i, reference.rays[i]);
            ASSERT_LE(ulps_between(hits[i].t, reference.hits[i].t), 1)
                << describe(reference.parameters, i, reference.rays[i]);
            // what callers see as a float is t in double, rounded once
            ASSERT_EQ(bits_of(narrow(wide_t[i])), bits_of(hits[i].t))
                << describe(reference.parameters, i, reference.rays[i]);
        }
        EXPECT_GT(found, hits.size() / 20) << reference.parameters.name << ": too few rays hit to say anything";
        total += hits.size();
    }
    EXPECT_GE(total, least_rays);
}

TEST_P(ClosestHit, GivesTheBitsOfTheLeastProcessor) {
    BackendOptions options;
    options.instruction_set = "x86-64-v2";
    const auto least = make_backend("cpu", options);
    for (const Reference& reference : references()) {
        std::vector<Hit> expected(reference.rays.size());
        least->trace(*least->load(reference.scene, GetParam().tier), reference.rays, expected);
        const auto scene = load(reference.scene);
        for (const Coherence coherence : {Coherence::unknown, Coherence::coherent, Coherence::incoherent}) {
            std::vector<Hit> hits(reference.rays.size());
            backend_->trace(*scene, TraceJob{.rays = reference.rays, .hits = hits, .coherence = coherence});
            for (std::size_t i = 0; i < hits.size(); ++i) {
                ASSERT_EQ(bits_of(hits[i].t), bits_of(expected[i].t))
                    << describe(reference.parameters, i, reference.rays[i]);
                ASSERT_EQ(hits[i].primitive, expected[i].primitive)
                    << describe(reference.parameters, i, reference.rays[i]);
            }
        }
    }
}

// The rays of images are traced in tiles: in the order of the pixels, and shuffled, each has the same bits.
TEST_P(ClosestHit, HasTheSameBitsForRaysOfImages) {
    for (const char* name : {"spheres/2000", "boxes/2000", "triangles/3000", "icosphere/4", "mixed/500", "paper"}) {
        const PreparedScene prepared = prepare(named_scene(name));
        const auto scene = load(prepared);
        constexpr std::size_t width = 72, height = 51;  // whole tiles, and rows that are in none
        std::vector<Ray<float>> rays;
        for (std::size_t i = 0; i < width * height; ++i) {
            const double x = (static_cast<double>(i % width) + 0.5) / width - 0.5;
            const double y = (static_cast<double>(i / width) + 0.5) / height - 0.5;
            rays.push_back({{0, 0, 3.2F}, narrow(Vec3d{1.3 * x, -1.3 * y, -1})});
        }
        ASSERT_EQ(row_length(rays, 1), width);
        std::vector<std::size_t> order(rays.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i * 1001 % order.size();
        std::vector<Ray<float>> shuffled;
        shuffled.reserve(order.size());
        for (const std::size_t i : order) shuffled.push_back(rays[i]);
        ASSERT_EQ(row_length(shuffled, 1), 0U);
        std::vector<RayEnd> ends(rays.size());
        for (std::size_t i = 0; i < ends.size(); ++i) ends[i].t = i % 2 == 0 ? 3 : 9;
        std::vector<RayEnd> shuffled_ends;
        shuffled_ends.reserve(order.size());
        for (const std::size_t i : order) shuffled_ends.push_back(ends[i]);
        for (const bool shadow : {false, true}) {
            std::vector<Hit> expected(rays.size());
            const auto part = shadow ? std::span<const RayEnd>(ends) : std::span<const RayEnd>();
            const auto shuffled_part = shadow ? std::span<const RayEnd>(shuffled_ends) : std::span<const RayEnd>();
            backend_->trace(*scene, {.rays = shuffled, .hits = expected, .ends = shuffled_part});
            std::size_t found = 0;
            for (const Coherence coherence : {Coherence::unknown, Coherence::coherent, Coherence::incoherent}) {
                std::vector<Hit> hits(rays.size());
                backend_->trace(*scene, {.rays = rays, .hits = hits, .ends = part, .coherence = coherence});
                for (std::size_t i = 0; i < order.size(); ++i) {
                    const Hit& hit = hits[order[i]];
                    ASSERT_EQ(hit.primitive, expected[i].primitive) << name << ", ray " << order[i];
                    ASSERT_EQ(bits_of(hit.t), bits_of(expected[i].t)) << name << ", ray " << order[i];
                    found += hit.primitive == no_primitive ? 0 : 1;
                }
            }
            EXPECT_GT(found, rays.size() / 50) << name;
        }
    }
}

// More primitives that may be hit than a tracer keeps, by rays of either coherence.
TEST_P(ClosestHit, DecidesAboutCrowds) {
    const test::Bundles bundles = test::make_bundles(11);
    const auto oracle = make_backend("oracle");
    for (const PreparedScene* prepared : {&bundles.solids, &bundles.faces}) {
        const std::string name = prepared == &bundles.solids ? "solids" : "faces";
        const std::vector<Ray<float>> rays = test::rays_at_bundles(*prepared, 5'000, 12);
        std::vector<Hit> expected(rays.size()), hits(rays.size());
        oracle->trace(*oracle->load(*prepared), rays, expected);
        std::vector<RayEnd> ends(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) ends[i].t = expected[i].t * (i % 2 == 0 ? 2 : 0.5);
        const auto scene = load(*prepared);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            backend_->trace(*scene, {.rays = rays, .hits = hits, .coherence = coherence});
            std::size_t found = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(hits[i].primitive, expected[i].primitive) << name << " (seeds 11, 12), ray " << i;
                ASSERT_LE(ulps_between(hits[i].t, expected[i].t), 1) << name << " (seeds 11, 12), ray " << i;
                found += hits[i].primitive == no_primitive ? 0 : 1;
            }
            EXPECT_GT(found, rays.size() / 4) << name;
            backend_->trace(*scene, {.rays = rays, .hits = hits, .ends = ends, .coherence = coherence});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const bool blocked = expected[i].primitive != no_primitive && i % 2 == 0;
                ASSERT_EQ(hits[i].primitive != no_primitive, blocked) << name << " (seeds 11, 12), shadow ray " << i;
            }
        }
    }
}

TEST_P(ClosestHit, MissesWithRaysThatAreNotTraceable) {
    const PreparedScene scene = test::make_scene(test::hard_scenes().front(), 1);
    const float nan = std::nanf("");
    const float inf = HUGE_VALF;
    std::vector<Ray<float>> rays = {{{nan, 0, 0}, {0, 0, 1}},  {{0, 0, 0}, {0, nan, 1}}, {{0, inf, 0}, {0, 0, 1}},
                                    {{0, 0, 0}, {0, 0, -inf}}, {{0, 0, 0}, {0, 0, 0}},   {{0, 0, 2e18F}, {0, 0, -1}},
                                    {{0, 0, 0}, {3e18F, 0, 0}}};
    // among rays that hit, so that packets are mixed
    const auto good = test::make_rays(scene, 64, 3);
    std::vector<Ray<float>> all;
    for (std::size_t i = 0; i < good.size(); ++i) {
        all.push_back(good[i]);
        all.push_back(rays[i % rays.size()]);
    }
    std::vector<Hit> hits(all.size(), Hit{5, 5});
    backend_->trace(*load(scene), all, hits);
    std::vector<Hit> alone(good.size());
    backend_->trace(*load(scene), good, alone);
    for (std::size_t i = 0; i < good.size(); ++i) {
        EXPECT_EQ(hits[2 * i].primitive, alone[i].primitive);
        EXPECT_EQ(hits[2 * i + 1].primitive, no_primitive);
        EXPECT_EQ(hits[2 * i + 1].t, 0);
    }
}

// Coincident primitives: the lowest id wins on every backend, whatever the structure.
TEST_P(ClosestHit, GivesTiesToTheLowestId) {
    PreparedScene scene;
    for (int i = 0; i < 100; ++i) scene.spheres.push_back({{0, 0, 0}, 1});
    // a wall of touching boxes, 16 x 16, twice
    for (int copy = 0; copy < 2; ++copy) {
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
                scene.boxes.push_back({{fx, fy, 5}, {fx + 1, fy + 1, 6}});
            }
        }
    }
    scene.material_of.assign(scene.spheres.size() + scene.boxes.size(), 0);
    scene.materials.emplace_back();
    std::vector<Ray<float>> rays = {{{0, 0, -3}, {0, 0, 1}}, {{0, 0, 0}, {1, 2, 3}}};
    std::vector<std::uint32_t> expected = {0, 0};
    for (int y = 1; y < 16; ++y) {
        for (int x = 1; x < 16; ++x) {  // at shared corners, from afar and askew
            const Vec3f corner = {static_cast<float>(x), static_cast<float>(y), 5};
            for (const Vec3f& origin : {Vec3f{corner.x, corner.y, 1}, Vec3f{1000, -2000, -4096}, Vec3f{7, 3, -1}}) {
                rays.push_back({origin, corner - origin});
                expected.push_back(static_cast<std::uint32_t>(100 + (y - 1) * 16 + (x - 1)));
            }
        }
    }
    std::vector<Hit> hits(rays.size());
    backend_->trace(*load(scene), rays, hits);
    std::vector<Hit> reference(rays.size());
    const auto oracle = make_backend("oracle");
    oracle->trace(*oracle->load(scene), rays, reference);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].primitive, reference[i].primitive) << "ray " << i;
        EXPECT_EQ(hits[i].primitive, expected[i]) << "ray " << i;
    }
}

// The same for faces that meet and for faces that lie on each other: exact ties, since all numbers are small integers.
TEST_P(ClosestHit, GivesTiesBetweenFacesToTheLowestId) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh grid, cover;
    for (std::uint32_t i = 0; i < 17 * 17; ++i) {
        grid.positions.push_back({static_cast<float>(i % 17), static_cast<float>(i / 17), 5});
    }
    for (std::uint32_t i = 0; i < 16 * 16; ++i) {
        const std::uint32_t corner = i / 16 * 17 + i % 16;
        if (i % 2 == 0) {
            grid.quads.insert(grid.quads.end(), {corner, corner + 1, corner + 18, corner + 17});
        } else {
            grid.triangles.insert(grid.triangles.end(),
                                  {corner, corner + 1, corner + 18, corner + 17, corner, corner + 18});
        }
    }
    cover.positions = {{-100, -90, 5}, {300, -80, 5}, {3, 200, 5}};  // over all of it, once more and twice more
    cover.triangles = {0, 1, 2, 1, 0, 2};
    scene.meshes = {grid, cover};
    Node node;
    node.camera = PerspectiveCamera{};
    node.geometry = {{MeshShape{0}, 0, {}}, {MeshShape{1}, 0, {}}};
    scene.nodes = {node};
    const PreparedScene prepared = prepare(scene);
    std::vector<Ray<float>> rays;
    for (const Vec3f& corner : grid.positions) {  // at corners, edges, diagonals and insides
        for (const Vec3f& beside :
             {Vec3f{0, 0, 0}, Vec3f{0.5F, 0, 0}, Vec3f{0, 0.25F, 0}, Vec3f{0.5F, 0.5F, 0}, Vec3f{0.25F, 0.75F, 0}}) {
            for (const Vec3f& origin : {Vec3f{corner.x, corner.y, 1}, Vec3f{1000, -2000, -4096}, Vec3f{7, 3, 9}}) {
                rays.push_back({origin, corner + beside - origin});
            }
        }
    }
    std::vector<Hit> hits(rays.size()), reference(rays.size());
    backend_->trace(*load(prepared), rays, hits);
    const auto oracle = make_backend("oracle");
    oracle->trace(*oracle->load(prepared), rays, reference);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(hits[i].primitive, reference[i].primitive) << "ray " << i << " " << rays[i].direction.x;
        ASSERT_EQ(bits_of(hits[i].t), bits_of(reference[i].t)) << "ray " << i;
    }
}

// A closed mesh lets nothing out: rays from inside at its vertices and edges.
TEST_P(ClosestHit, IsNeverLostThroughAMesh) {
    const PreparedScene scene = prepare(named_scene("icosphere/3"));
    std::vector<Ray<float>> rays;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        const Vec3f origin = t.v1 * (i % 3 == 0 ? 0.0F : -0.9F);
        for (const Vec3f& target : {t.v0, (t.v0 + t.v1) * 0.5F, t.v0 * 0.7F + t.v2 * 0.3F}) {
            rays.push_back({origin, target - origin});
        }
    }
    std::vector<Hit> hits(rays.size()), reference(rays.size());
    backend_->trace(*load(scene), rays, hits);
    const auto oracle = make_backend("oracle");
    oracle->trace(*oracle->load(scene), rays, reference);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_NE(hits[i].primitive, no_primitive) << "ray " << i;
        ASSERT_EQ(hits[i].primitive, reference[i].primitive) << "ray " << i;
    }
}

TEST_P(ClosestHit, AnswersForAnEmptySceneAndForNoRays) {
    const PreparedScene empty;
    std::vector<Ray<float>> rays = {{{0, 0, 0}, {0, 0, 1}}};
    std::vector<Hit> hits(1, Hit{5, 5});
    backend_->trace(*load(empty), rays, hits);
    EXPECT_EQ(hits[0].primitive, no_primitive);
    backend_->trace(*load(empty), TraceJob{});
}

INSTANTIATE_TEST_SUITE_P(Backends, ClosestHit, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

TEST(CpuInstructionSets, AreNamedWhereOneIsUnknown) {
    const std::vector<std::string> sets = cpu_instruction_sets();
    ASSERT_FALSE(sets.empty());
    EXPECT_EQ(sets.front(), "x86-64-v2");
    BackendOptions options;
    options.instruction_set = "x86-64-v9";
    try {
        (void)make_backend("cpu", options);
        FAIL() << "no error";
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("x86-64-v9"), std::string::npos) << message;
        for (const std::string& set : sets) EXPECT_NE(message.find(set), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace tandem

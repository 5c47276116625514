// Rays through groups of primitives have the bits of rays that are tested against every primitive: groups of every fill
// and of all kinds, ties, crowds, rays that leave surfaces and shadow rays, on every instruction set of this machine.
#include <gtest/gtest.h>

#include "cpu/embree_handles.h"
#include "cpu/group_hierarchy.h"
#include "cpu/instruction_sets.h"
#include "support/bundles.h"
#include "support/hard_scenes.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

struct Batch {
    std::vector<Ray<float>> rays;
    std::vector<RaySource> sources;  ///< empty for rays that start in space
    std::vector<RayEnd> ends;        ///< empty for nearest hits
};

/// The scene without hierarchies.
CpuSceneView plain_view(const PreparedScene& prepared) {
    const SceneView scene = view(prepared);
    Aabb bounds;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) bounds = merge(bounds, primitive_bounds(scene, id));
    const std::uint32_t quads = primitive_count(scene) - scene.quad_count, triangles = quads - scene.triangle_count;
    return {scene, make_structure_frame(bounds), nullptr, {0, triangles, quads}, nullptr, {}, nullptr};
}

void trace_single_rays(const TierKernels& kernels, const GroupHierarchy& hierarchy, const TraceJob& job) {
    kernels.trace(hierarchy.view(), job);
}

/// Without the last few rays: kernels take less than a packet of them for coherent, if it is one.
Batch without_rest(Batch batch) {
    const std::size_t count = batch.rays.size() / 16 * 16;
    batch.rays.resize(count);
    if (!batch.sources.empty()) batch.sources.resize(count);
    if (!batch.ends.empty()) batch.ends.resize(count);
    return batch;
}

/// Solids and faces.
PreparedScene all_kinds(int count) {
    const std::string number = std::to_string(count);
    PreparedScene scene = prepare(named_scene("mixed/" + number));
    scene.triangles = prepare(named_scene("triangles/" + number)).triangles;
    scene.quads = prepare(named_scene("quads/" + number)).quads;
    scene.material_of.assign(primitive_count(view(scene)), 0);
    return scene;
}

class GroupTracer : public ::testing::TestWithParam<std::tuple<InstructionSet, Tier>> {
  protected:
    void SetUp() override {
        const InstructionSet& set = std::get<0>(GetParam());
        if (!set.is_supported()) GTEST_SKIP() << "this processor lacks " << set.name;
    }

    /// Nearest hits, rays that leave the hits to either side, and shadow rays from there.
    void expect_bits_of_the_loop(const PreparedScene& scene, const std::vector<Ray<float>>& rays,
                                 const std::string& what) {
        if (std::get<1>(GetParam()) == Tier::strict) {
            expect_bits_as<float>(scene, rays, what);
        } else {
            expect_bits_as<double>(scene, rays, what);
        }
    }

  private:
    template <class Real>
    void expect_bits_as(const PreparedScene& prepared, const std::vector<Ray<float>>& rays, const std::string& what) {
        const LoopTracer loop = {view(prepared)};
        const GroupHierarchy scene(device_.get(), plain_view(prepared), {});
        const Batch first = {rays, {}, {}};
        compare<Real>(scene, loop, first, what);
        if (HasFatalFailure()) return;
        Batch onwards, shadows;
        test::Random random(rays.size());
        for (const Ray<float>& ray : rays) {
            if (!is_traceable(ray)) continue;
            const Closest<float> hit = loop.closest(ray, NoSource{}, true);
            if (hit.primitive == no_primitive) continue;
            const SurfacePoint<float> point = surface_point(loop.scene, ray, NoSource{}, hit, true);
            const Vec3f back = {ray.direction.y, -ray.direction.x, ray.direction.z};
            const SpawnedRay<float> spawned = spawn_ray(point, random.coin() ? back : ray.direction);
            if (!is_traceable(spawned.ray)) continue;
            onwards.rays.push_back(spawned.ray);
            onwards.sources.push_back(spawned.source);
            const Closest<Real> next = loop.closest(to_real<Real>(spawned.ray), to_real<Real>(spawned.source), true);
            const bool hits = next.primitive != no_primitive;
            const double t = hits ? next.t : 1.0;
            shadows.ends.push_back({random.coin() ? t : t * (random.coin() ? 1 + 1e-15 : 2.0),
                                    random.below(4) == 0 && hits ? next.primitive : no_primitive});
        }
        shadows.rays = onwards.rays;
        shadows.sources = onwards.sources;
        compare<Real>(scene, loop, onwards, what + ", onwards");
        if (HasFatalFailure()) return;
        compare<Real>(scene, loop, shadows, what + ", shadow");
    }

    template <class Real>
    void compare(const GroupHierarchy& scene, const LoopTracer& loop, const Batch& whole, const std::string& what) {
        const Batch batch = without_rest(whole);
        std::vector<Hit> hits(batch.rays.size());
        std::vector<double> wide_t(batch.rays.size());
        const TraceJob job = {
            .rays = batch.rays, .hits = hits, .sources = batch.sources, .ends = batch.ends, .wide_t = wide_t};
        const auto& [set, tier] = GetParam();
        trace_single_rays(set.kernels(tier), scene, job);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (!is_traceable(batch.rays[i])) continue;
            const Ray<Real> ray = to_real<Real>(batch.rays[i]);
            Source<Real> source;
            if (!batch.sources.empty()) source = to_real<Real>(batch.sources[i]);
            if (!batch.ends.empty()) {
                ShadowSource<Real> shadow;
                static_cast<Source<Real>&>(shadow) = source;
                shadow.light = batch.ends[i].light;
                ASSERT_EQ(hits[i].primitive == some_primitive, loop.occluded(ray, batch.ends[i].t, shadow, true))
                    << what << " " << i;
                continue;
            }
            const Closest<Real> expected = loop.closest(ray, source, true);
            ASSERT_EQ(hits[i].primitive, expected.primitive) << what << " " << i;
            if (expected.primitive == no_primitive) continue;
            ASSERT_EQ(bits_of(wide_t[i]), bits_of(expected.t)) << what << " " << i;
        }
    }

    EmbreeDevice device_{rtcNewDevice(nullptr)};
};

TEST_P(GroupTracer, GivesTheBitsOfTheLoopForEveryFill) {
    for (int count = 1; count < 34; ++count) {
        const test::HardScene solids = {"solids", 1, 0, 1.5, count},
                              faces = {"faces", 1, 0, 1.5, count, test::HardKinds::faces};
        const std::string number = std::to_string(count);
        std::vector<PreparedScene> scenes = {test::make_scene(solids, 50),
                                             test::make_scene(faces, 51),
                                             prepare(named_scene("spheres/" + number)),
                                             prepare(named_scene("triangles/" + number)),
                                             prepare(named_scene("quads/" + number)),
                                             all_kinds(count)};
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            const std::string what = "scene " + std::to_string(i) + " of " + number;
            const auto rays = test::make_rays(scenes[i], 300, 52);
            expect_bits_of_the_loop(scenes[i], rays, what + ", ray");
            if (HasFatalFailure()) return;
        }
    }
}

// Hits at the same t, or nearly, in several groups, and more candidates than are kept.
TEST_P(GroupTracer, GivesTheBitsOfTheLoopForCrowds) {
    const test::Bundles bundles = test::make_bundles(60);
    for (const PreparedScene* scene : {&bundles.solids, &bundles.faces}) {
        const std::string name = scene == &bundles.solids ? "solids" : "faces";
        const auto rays = test::rays_at_bundles(*scene, 2'000, 61);
        expect_bits_of_the_loop(*scene, rays, name + ", ray");
        if (HasFatalFailure()) return;
    }
}

// Copies of a few primitives of all kinds, so that each tie is between several groups.
TEST_P(GroupTracer, GivesTheBitsOfTheLoopForTies) {
    const PreparedScene some = all_kinds(8);
    PreparedScene scene = some;
    const auto repeat = [](auto& all, const auto& few) {
        for (int copy = 0; copy < 20; ++copy) all.insert(all.end(), few.begin(), few.end());
    };
    repeat(scene.spheres, some.spheres);
    repeat(scene.boxes, some.boxes);
    repeat(scene.ellipsoids, some.ellipsoids);
    repeat(scene.parallelepipeds, some.parallelepipeds);
    repeat(scene.triangles, some.triangles);
    repeat(scene.quads, some.quads);
    scene.material_of.assign(primitive_count(view(scene)), 0);
    const auto rays = test::make_rays(scene, 2'000, 70);
    expect_bits_of_the_loop(scene, rays, "ray");
}

// In the tier fast, decisions are approximate.
TEST(GroupTracerInFast, FindsNearlyAllHits) {
    const PreparedScene prepared = prepare(named_scene("spheres/3000"));
    const LoopTracer loop = {view(prepared)};
    const auto rays = test::make_rays(prepared, 4'000, 72);
    const EmbreeDevice device(rtcNewDevice(nullptr));
    for (const InstructionSet& set : instruction_sets()) {
        if (!set.is_supported()) continue;
        const TierKernels& kernels = set.kernels(Tier::fast);
        const GroupHierarchy hierarchy(device.get(), plain_view(prepared), {});
        std::vector<Hit> hits(rays.size());
        trace_single_rays(kernels, hierarchy, {.rays = rays, .hits = hits});
        std::size_t found = 0, same = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!is_traceable(rays[i])) continue;
            const Closest<float> expected = loop.closest(rays[i], NoSource{}, true);
            if (expected.primitive == no_primitive) continue;
            ++found;
            if (hits[i].primitive == expected.primitive) ++same;
        }
        EXPECT_GT(found, rays.size() / 10) << set.name;
        EXPECT_GT(100 * same, 95 * found) << set.name;
    }
}

// The groups are of half of the spheres, so that the hits say whether rays went through them.
TEST_P(GroupTracer, TracesCoherentRaysOneByOneWhereItShall) {
    const PreparedScene all = prepare(named_scene("spheres/2000"));
    PreparedScene half = all;
    half.spheres.resize(1000);
    half.material_of.resize(1000);
    const EmbreeDevice device(rtcNewDevice(nullptr));
    const GroupHierarchy groups(device.get(), plain_view(half), {});
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 64 * 64; ++i) {
        const double x = i % 64 / 64.0 - 0.5, y = i / 64 / 64.0 - 0.5;
        rays.push_back({{0, 0, 3.2F}, narrow(Vec3d{0.6 * x, 0.6 * y, -1})});
    }
    CpuSceneView scene = plain_view(all);
    scene.groups = groups.view().groups;
    const auto& [set, tier] = GetParam();
    for (const bool splits : {false, true}) {
        scene.splits_packets = splits;
        std::vector<Hit> hits(rays.size());
        set.kernels(tier).trace(scene, {.rays = rays, .hits = hits});
        const LoopTracer loop = {view(splits ? half : all)};
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i].primitive, loop.closest(rays[i], NoSource{}, true).primitive) << splits << " " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, GroupTracer,
                         ::testing::Combine(::testing::ValuesIn(instruction_sets().begin(), instruction_sets().end()),
                                            ::testing::Values(Tier::strict, Tier::precise)),
                         [](const auto& info) {
                             std::string name =
                                 std::get<0>(info.param).name + ("_" + to_string(std::get<1>(info.param)));
                             for (char& c : name) c = c == '-' ? '_' : c;
                             return name;
                         });

}  // namespace
}  // namespace tandem

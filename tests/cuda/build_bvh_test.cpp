// BVHs that the GPU builds: every primitive once, in boxes that contain it; the same bytes every time; as good as the
// host's.
#include "cuda/build_bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "cuda/bvh_on_gpu.h"
#include "support/hair.h"
#include "support/needles.h"
#include "support/random.h"

namespace tandem::cuda {
namespace {

using test::Random;

/// A scene, and its arrays on the GPU.
class OnGpu {
  public:
    explicit OnGpu(PreparedScene scene)
        : scene_(std::move(scene)),
          memory_(std::make_shared<SceneMemory>()),
          resident_(scene_, Tier::strict, memory_, stream_) {
        check(cudaStreamSynchronize(stream_.get()), "uploading the scene");
    }
    [[nodiscard]] Bvh build(const BuildEffort& effort) {
        built_ = build_bvh(resident_.view().scene, memory_->bvh, stream_.get(), effort);
        return download(built_, view(scene_));
    }
    [[nodiscard]] const BuiltBvh& built() const { return built_; }
    /// With any effort; empty if there is none.
    [[nodiscard]] std::string defect() {
        for (const BuildEffort& effort :
             {BuildEffort{1, 0, false}, {1, 6, true}, {16, 1, false, false}, {4096, 4, true}}) {
            const Bvh bvh = build(effort);
            std::string found = find_bvh_defect(bvh, view(scene_), built_.view.frame.padding);
            if (built_.levels > max_bvh_depth) found = "too deep";
            if (found.empty()) continue;
            return found + ", effort " + std::to_string(effort.top_clusters) + ", " + std::to_string(effort.passes);
        }
        return {};
    }
    [[nodiscard]] Bvh build() { return build(effort_for(primitive_count(view(scene_)))); }
    [[nodiscard]] const PreparedScene& scene() const { return scene_; }

  private:
    PreparedScene scene_;
    Stream stream_;
    std::shared_ptr<SceneMemory> memory_;
    DeviceScene resident_;
    BuiltBvh built_{};
};

class BuildBvhOn : public NeedsGpu {};

TEST_F(BuildBvhOn, TheGpuHoldsScenesOfAnySize) {
    Random random(1);
    std::vector<Sphere> spheres;
    for (int count = 1; count <= 600; count += count < 40 ? 1 : 37) {
        while (spheres.size() < static_cast<std::size_t>(count)) {
            spheres.push_back({{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)},
                               std::abs(random.log_uniform(-12.0, -2.0))});
        }
        ASSERT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << count << " spheres";
    }
}

TEST_F(BuildBvhOn, TheGpuHoldsEveryKind) {
    for (const char* name : {"spheres/20000", "boxes/20000", "mixed/20000", "triangles/20000", "quads/20000",
                             "icosphere/5", "hard/planet", "giant/20000", "hair/20000"}) {
        EXPECT_EQ(OnGpu(named(name)).defect(), "") << name;
    }
}

TEST_F(BuildBvhOn, TheGpuHoldsWhatIsHardToSort) {
    Random random(2);
    const auto anywhere = [&] {
        return Vec3f{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
    };
    // Equal primitives, far more than depth and radius
    EXPECT_EQ(OnGpu(of_spheres(std::vector<Sphere>(70'001, {{1, 2, 3}, 0.5F}))).defect(), "") << "equal";
    EXPECT_EQ(OnGpu(of_spheres(std::vector<Sphere>(1000, {{1, 2, 3}, 0}))).defect(), "") << "equal points";
    // Concentric: areas that favour one merge at a time
    std::vector<Sphere> spheres;
    for (int i = 0; i < 20'000; ++i) spheres.push_back({{0, 0, 0}, 1 + static_cast<float>(i) * 1e-3F});
    EXPECT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << "concentric";
    // Each half as big and half as far as the one before
    spheres.clear();
    float x = 1e15F;
    for (int i = 0; i < 150; ++i, x *= 0.5F) spheres.push_back({{x, 0, 0}, 0.1F * x});
    EXPECT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << "halves";
    // One huge among many small
    spheres = {{{0, -1e6F, 0}, 1e6F}};
    for (int i = 0; i < 30'000; ++i) spheres.push_back({anywhere(), 0.01F});
    EXPECT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << "huge";
    // A line, a tiny scene, and one far away
    spheres.clear();
    for (int i = 0; i < 5000; ++i) spheres.push_back({{static_cast<float>(i), 0, 0}, 0.6F});
    EXPECT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << "line";
    for (const float scale : {1e-25F, 1e17F}) {
        spheres.clear();
        for (int i = 0; i < 5000; ++i) spheres.push_back({anywhere() * scale, 0.01F * scale});
        EXPECT_EQ(OnGpu(of_spheres(spheres)).defect(), "") << "scale " << scale;
    }
    // Triangles as thin as hair
    PreparedScene hair;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3f root = anywhere();
        hair.triangles.push_back({root, root + Vec3f{1e-6F, 0, 0}, root + anywhere()});
    }
    EXPECT_EQ(OnGpu(with_material(std::move(hair))).defect(), "") << "hair";
}

TEST_F(BuildBvhOn, TheGpuGivesTheSameBytesEveryTime) {
    for (const char* name : {"mixed/100000", "hair/20000"}) {
        OnGpu scene(named(name));
        const Bvh first = scene.build();
        for (int round = 0; round < 5; ++round) {
            const Bvh again = scene.build();
            ASSERT_EQ(first.nodes.size(), again.nodes.size()) << name;
            ASSERT_EQ(std::memcmp(first.nodes.data(), again.nodes.data(), first.nodes.size() * sizeof(BvhNode)), 0);
            ASSERT_EQ(first.entry_ids, again.entry_ids) << name;
        }
    }
}

/// The entries of the tree of a scene, which has no defect.
std::uint32_t entries_of(PreparedScene prepared) {
    OnGpu scene(std::move(prepared));
    EXPECT_EQ(scene.defect(), "");
    (void)scene.build();
    return scene.built().entry_count;
}

TEST_F(BuildBvhOn, TheGpuCutsLongThinTriangles) {
    EXPECT_GT(entries_of(named("hair/20000")), 40'000U);
    Random random(3);
    EXPECT_GT(entries_of(test::hair(random, 2'000, 500)), 6'000U) << "among spheres";
    EXPECT_EQ(entries_of(named("icosphere/5")), 20'480U) << "thick triangles";

    PreparedScene alone = test::hair(random, 100), aligned = test::hair(random, 2'000),
                  masked = test::hair(random, 2'000);
    for (Triangle& t : alone.triangles) t.v1 = t.v0 + (t.v1 - t.v0) * 0.01F, t.v2 = t.v0 + (t.v2 - t.v0) * 0.01F;
    EXPECT_EQ(entries_of(std::move(alone)), 100U) << "nothing is near";
    for (Triangle& t : aligned.triangles) t.v1 = t.v0 + Vec3f{1, 0, 0}, t.v2 = t.v0 + Vec3f{0, 0, 1e-3F};
    EXPECT_EQ(entries_of(std::move(aligned)), 2'000U) << "along an axis";
    OnGpu limited(named("hair/20000"));
    (void)limited.build({4096, 8, true, true, 40'000});
    EXPECT_EQ(limited.built().entry_count, 20'000U) << "more leaves than allowed";
    masked.masked_kinds = masked.cutout_kinds = PrimitiveKinds::triangle;
    EXPECT_EQ(entries_of(std::move(masked)), 2'000U) << "which rays count";
}

TEST_F(BuildBvhOn, TheGpuCutsSolidsAsThinAsNeedles) {
    Random random(4);
    EXPECT_GT(entries_of(test::needles(random, 1'000, 1)), 10'000U);
    // pieces_along() gives up to three to one that has no other in its cell
    EXPECT_LE(entries_of(test::needles(random, 1'000, 0.02)), 3 * 2'000U) << "shorter than their distances";
    for (const bool boxes : {false, true}) {  // of one kind: in the order of the entries
        PreparedScene one_kind = test::needles(random, 1'000, 1);
        boxes ? one_kind.ellipsoids.clear() : one_kind.parallelepipeds.clear();
        one_kind.material_of.resize(1'000);
        EXPECT_GT(entries_of(std::move(one_kind)), 5'000U) << (boxes ? "boxes" : "ellipsoids");
    }
    PreparedScene extreme = test::needles(random, 1'000, 1), masked = test::needles(random, 1'000, 1);
    for (auto& solid : extreme.ellipsoids) solid.object_from_world.row[0] = solid.object_from_world.row[0] * 1e9;
    for (auto& solid : extreme.parallelepipeds) solid.object_from_world.row[0] = solid.object_from_world.row[0] * 1e9;
    EXPECT_EQ(entries_of(std::move(extreme)), 2'000U) << "inverses are too inexact";
    masked.masked_kinds = masked.cutout_kinds = PrimitiveKinds::parallelepiped;
    EXPECT_EQ(entries_of(std::move(masked)), 2'000U) << "which rays count";
}

TEST_F(BuildBvhOn, TheGpuCostsLittleMoreThanTheHosts) {
    for (const char* name : {"spheres/100000", "boxes/100000", "triangles/100000", "icosphere/6", "mixed/100000"}) {
        OnGpu scene(named(name));
        const Bvh ours = scene.build();
        const SceneView host_view = view(scene.scene());
        const Padding padding = scene.built().view.frame.padding;
        const Bvh host = tandem::build_bvh(host_view, padding);
        const double ratio = Cost(ours, host_view, padding).area() / Cost(host, host_view, padding).area();
        RecordProperty(std::string("cost over the host's, ") + name, std::to_string(ratio));
        std::printf("%s: cost %.4f of the host's tree, %u levels\n", name, ratio, scene.built().levels);
        EXPECT_LT(ratio, 1.05) << name;
    }
}

/// The cost of a tree that the GPU builds, without the root and leaves larger than 1000 square metres.
double cost_of_small_nodes(PreparedScene prepared) {
    OnGpu scene(std::move(prepared));
    const Bvh bvh = scene.build();
    const SceneView host_view = view(scene.scene());
    const Padding padding = scene.built().view.frame.padding;
    Aabb all;
    double large = 0;
    for (std::uint32_t id = 0; id < primitive_count(host_view); ++id) {
        const Aabb box = pad(primitive_bounds(host_view, id), padding);
        all = merge(all, box);
        if (half_area(box) > 1e3F) large += 0.6 * wide_half_area(box);
    }
    return Cost(bvh, host_view, padding).area() - wide_half_area(all) - large;
}

// All small primitives are in one coarse cell of the curve, or even in one cell, and would be neighbours in any order.
TEST_F(BuildBvhOn, TheGpuSortsSmallPrimitivesBesideAGiant) {
    const double alone = cost_of_small_nodes(named("spheres/100000"));
    for (const float radius : {1e4F, 1e6F}) {
        PreparedScene scene = named("spheres/100000");
        scene.spheres.push_back({{0, -1.5F - radius, 0}, radius});
        scene.material_of.push_back(0);
        const double beside = cost_of_small_nodes(std::move(scene));
        std::printf("beside a giant of %g m: %.4f of the cost without it\n", static_cast<double>(radius),
                    beside / alone);
        EXPECT_LT(beside, 1.1 * alone);
    }
}

}  // namespace
}  // namespace tandem::cuda

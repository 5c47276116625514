// BVHs that move with their primitives: where nothing moves, the same bytes; wherever things move, boxes that contain
// them; worn trees are built again; and the same pictures as without.
#include "cuda/refit_bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include "cuda/bvh_on_gpu.h"
#include "support/needles.h"
#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/film.h"

namespace tandem::cuda {
namespace {

using test::Random;

/// A scene on the GPU, for which nothing has been built yet.
class Arrays {
  public:
    Arrays(PreparedScene scene, Stream& stream)
        : scene_(std::move(scene)), resident_(scene_, Tier::strict, std::make_shared<SceneMemory>(), stream) {
        check(cudaStreamSynchronize(stream.get()), "uploading the scene");
    }
    [[nodiscard]] const SceneView& there() const { return resident_.view().scene; }
    [[nodiscard]] SceneView here() const { return view(scene_); }

  private:
    PreparedScene scene_;
    DeviceScene resident_;
};

/// The scene with every instance and every corner of a mesh elsewhere, by up to `distance` along each axis.
Scene shaken(Scene scene, double distance, std::uint64_t seed) {
    Random random(seed);
    const auto step = [&] { return random.uniform(-distance, distance); };
    for (Node& node : scene.nodes) {
        for (Geometry& geometry : node.geometry) {
            for (Trs& place : geometry.instances) place.translation += Vec3d{step(), step(), step()};
        }
    }
    for (Mesh& mesh : scene.meshes) {
        for (Vec3f& corner : mesh.positions) corner = corner + narrow(Vec3d{step(), step(), step()});
    }
    return scene;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_bytes(const Bvh& a, const Bvh& b) {
    return same_bytes(a.nodes, b.nodes) && same_bytes(a.entry_spheres, b.entry_spheres) &&
           same_bytes(a.entry_ids, b.entry_ids) && same_bytes(a.placements, b.placements) &&
           same_bytes(a.entry_triangles, b.entry_triangles);
}

class RefitBvhOn : public NeedsGpu {
  protected:
    void SetUp() override {
        NeedsGpu::SetUp();
        if (!IsSkipped()) stream_.emplace();
    }
    [[nodiscard]] BuiltBvh build(const Arrays& scene) {
        return build_bvh(scene.there(), memory_, stream_->get(), effort_for(primitive_count(scene.here())));
    }
    [[nodiscard]] BuiltBvh refit(const Arrays& scene, const BuiltBvh& built) {
        return refit_bvh(scene.there(), built, memory_, stream_->get());
    }
    /// Of the tree for `before`, moved to `after`; empty if there is none.
    [[nodiscard]] std::string defect_after_move(const Arrays& before, const Arrays& after) {
        const BuiltBvh moved = refit(after, build(before));
        const Bvh bvh = download(moved, after.here());
        if (moved.levels > max_bvh_depth) return "too deep";
        const double cost = Cost(bvh, after.here(), moved.view.frame.padding).area() / moved.root_area;
        const bool is_whole = moved.arrays.pieces == nullptr;  // Cost knows no pieces
        if (is_whole && !(std::abs(moved.cost / cost - 1) < 1e-3)) {
            return "says that it costs " + std::to_string(moved.cost) + ", costs " + std::to_string(cost);
        }
        return find_bvh_defect(bvh, after.here(), moved.view.frame.padding);
    }

    std::optional<Stream> stream_;  // needs a GPU
    BuildMemory memory_;
};

constexpr const char* scenes_of_every_kind[] = {"spheres/20000", "boxes/20000", "mixed/20000", "triangles/20000",
                                                "quads/20000",   "icosphere/5", "hair/20000"};

TEST_F(RefitBvhOn, TheGpuChangesNoByteWhereNothingMoves) {
    for (const char* name : scenes_of_every_kind) {
        const Arrays scene(named(name), *stream_);
        const BuiltBvh built = build(scene);
        const Bvh before = download(built, scene.here());
        const BuiltBvh again = refit(scene, built);
        EXPECT_TRUE(same_bytes(before, download(again, scene.here()))) << name;
        EXPECT_NEAR(again.cost / built.cost, 1, 1e-4) << name;
        EXPECT_EQ(again.root_area, built.root_area) << name;
        EXPECT_FALSE(is_worn(again, built)) << name;
    }
}

TEST_F(RefitBvhOn, TheGpuHoldsWhatMoves) {
    for (const char* name : scenes_of_every_kind) {
        const Arrays before(named(name), *stream_);
        for (const double distance : {1e-4, 0.05, 20.0}) {
            const Arrays after(prepare(shaken(named_scene(name), distance, 7)), *stream_);
            EXPECT_EQ(defect_after_move(before, after), "") << name << ", by " << distance;
        }
    }
}

TEST_F(RefitBvhOn, TheGpuHoldsPiecesOfNeedlesWhereverTheyMove) {
    Random random(5);
    const Arrays before(test::needles(random, 1'000, 1), *stream_);
    ASSERT_NE(build(before).arrays.pieces, nullptr);
    const Arrays after(test::needles(random, 1'000, 1), *stream_);
    EXPECT_EQ(defect_after_move(before, after), "");
}

TEST_F(RefitBvhOn, TheGpuHoldsWhatMovesWildly) {
    Random random(3);
    std::vector<Sphere> spheres;
    for (int i = 0; i < 5000; ++i) {
        spheres.push_back({{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)},
                           std::abs(random.log_uniform(-12.0, -4.0))});
    }
    const Arrays before(of_spheres(spheres), *stream_);
    const auto expect = [&](const char* what, const std::function<Sphere(const Sphere&, std::size_t)>& move) {
        std::vector<Sphere> moved;
        for (std::size_t i = 0; i < spheres.size(); ++i) moved.push_back(move(spheres[i], i));
        EXPECT_EQ(defect_after_move(before, Arrays(of_spheres(moved), *stream_)), "") << what;
    };
    expect("to a point", [](const Sphere&, std::size_t) { return Sphere{{1, 2, 3}, 0}; });
    expect("in a line", [](const Sphere& s, std::size_t i) { return Sphere{{static_cast<float>(i), 0, 0}, s.radius}; });
    expect("to other places", [&](const Sphere& s, std::size_t i) {
        return Sphere{spheres[(i * 2503) % spheres.size()].centre, s.radius};
    });
    expect("one far away", [](const Sphere& s, std::size_t i) { return i == 17 ? Sphere{{3e8F, 0, 0}, 1} : s; });
    expect("all far away", [](const Sphere& s, std::size_t) {
        return Sphere{s.centre + Vec3f{1e7F, -1e7F, 3e6F}, s.radius};
    });
    for (const float scale : {1e-25F, 1e17F}) {
        expect("scaled", [&](const Sphere& s, std::size_t) { return Sphere{s.centre * scale, s.radius * scale}; });
    }
}

TEST_F(RefitBvhOn, TheGpuGivesTheSameBytesEveryTimeAndOnEveryWay) {
    const Scene scene = named_scene("mixed/20000");
    const Arrays start(prepare(scene), *stream_), way(prepare(shaken(scene, 0.4, 1)), *stream_);
    const Arrays end(prepare(shaken(scene, 0.1, 2)), *stream_);
    const BuiltBvh built = build(start);
    const Bvh first = download(refit(end, built), end.here());
    for (int round = 0; round < 3; ++round) {
        (void)refit(way, built);
        ASSERT_TRUE(same_bytes(first, download(refit(end, built), end.here()))) << "round " << round;
    }
}

TEST_F(RefitBvhOn, TheGpuBuildsWornTreesAgain) {
    const Scene scene = named_scene("spheres/20000");
    const Arrays start(prepare(scene), *stream_), near_by(prepare(shaken(scene, 1e-3, 1)), *stream_);
    const Arrays mixed_up(prepare(shaken(scene, 0.5, 2)), *stream_);
    LastingBvh bvh;
    const auto bvh_of = [&](const Arrays& arrays, bool allowed = true) {
        return bvh.of(arrays.there(), memory_, stream_->get(), allowed);
    };
    (void)bvh_of(start);
    EXPECT_FALSE(bvh.was_refitted()) << "there was none";
    (void)bvh_of(near_by);
    EXPECT_TRUE(bvh.was_refitted());
    (void)bvh_of(near_by, false);
    EXPECT_FALSE(bvh.was_refitted()) << "not allowed";
    const BuiltBvh built = bvh_of(mixed_up);
    EXPECT_FALSE(bvh.was_refitted()) << "worn";
    EXPECT_EQ(find_bvh_defect(download(built, mixed_up.here()), mixed_up.here(), built.view.frame.padding), "");
    EXPECT_LE(built.cost, 1.2 * build(start).cost);

    // A sphere that flies away makes the root large, and the cost relative to its area small
    PreparedScene flown = prepare(scene);
    flown.spheres[123].centre.x = 1000;
    const Arrays far(std::move(flown), *stream_);
    LastingBvh other;
    const BuiltBvh before = other.of(start.there(), memory_, stream_->get(), true);
    EXPECT_LT(refit(far, before).cost, before.cost);
    (void)other.of(start.there(), memory_, stream_->get(), true);
    EXPECT_TRUE(other.was_refitted());
    (void)other.of(far.there(), memory_, stream_->get(), true);
    EXPECT_FALSE(other.was_refitted());

    // As many primitives, but of other kinds
    const Arrays boxes(named("boxes/20000"), *stream_);
    (void)other.of(boxes.there(), memory_, stream_->get(), true);
    EXPECT_FALSE(other.was_refitted());
}

TEST_F(RefitBvhOn, TheGpuKeepsPiecesUntilThereAreMasks) {
    const Arrays hair(named("hair/20000"), *stream_);
    PreparedScene with_masks = named("hair/20000");
    with_masks.masked_kinds = with_masks.cutout_kinds = PrimitiveKinds::triangle;
    const Arrays masked(std::move(with_masks), *stream_);
    LastingBvh bvh;
    const BuiltBvh built = bvh.of(hair.there(), memory_, stream_->get(), true);
    EXPECT_GT(built.entry_count, 40'000U);
    EXPECT_EQ(bvh.of(hair.there(), memory_, stream_->get(), true).entry_count, built.entry_count);
    EXPECT_TRUE(bvh.was_refitted());
    EXPECT_EQ(bvh.of(masked.there(), memory_, stream_->get(), true).entry_count, 20'000U);
    EXPECT_FALSE(bvh.was_refitted());
    EXPECT_EQ(bvh.of(hair.there(), memory_, stream_->get(), true).entry_count, 20'000U);
    EXPECT_TRUE(bvh.was_refitted()) << "whole triangles are never wrong";
}

/// Frames in which everything moves a little, and in the last much.
TEST_F(RefitBvhOn, TheGpuDrawsTheSamePictures) {
    for (const char* name : {"spheres/5000", "mixed/5000", "icosphere/4"}) {
        const Scene scene = named_scene(name);
        const auto moving = make_cuda_backend({}), still = make_cuda_backend({.refits_hierarchies = false});
        RenderJob job;
        job.width = job.height = 64;
        job.samples = 2;
        std::shared_ptr<ResidentScene> last;  // two memories take turns
        for (const double distance : {0.0, 1e-3, 2e-3, 3e-3, 4e-3, 0.3}) {
            const PreparedScene frame = prepare(shaken(scene, distance, 11));
            const auto resident = moving->load(frame);
            EXPECT_EQ(film_hash(moving->render(resident, job).film),
                      film_hash(still->render(still->load(frame), job).film))
                << name << ", moved by " << distance;
            last = resident;
        }
    }
}

/// The memory of one scene serves the next.
TEST_F(RefitBvhOn, TheGpuRefitsInTheMemoryOfAScene) {
    const Scene scene = named_scene("spheres/5000");
    const auto memory = std::make_shared<SceneMemory>();
    const auto load = [&](double distance, bool refits) {
        const DeviceScene resident(prepare(shaken(scene, distance, 5)), Tier::strict, memory, *stream_, refits);
        check(cudaStreamSynchronize(stream_->get()), "loading");
        return memory->lasting_bvh.was_refitted();
    };
    EXPECT_FALSE(load(0, true));
    EXPECT_TRUE(load(1e-3, true));
    EXPECT_TRUE(load(2e-3, true));
    EXPECT_FALSE(load(2e-3, false));
}

}  // namespace
}  // namespace tandem::cuda

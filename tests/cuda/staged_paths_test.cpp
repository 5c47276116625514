// Paths in stages, with threads of the host in place of a block's: the bits of the CPU backend, for any number of paths
// and of threads. Needs no GPU.
#include "cuda/staged_paths.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <barrier>
#include <memory>
#include <thread>
#include <vector>

#include "cuda/host_lane.h"
#include "support/small_job.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/render/pixel_job.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::cuda {
namespace {

/// A block of several warps, each of one thread.
struct HostLanes : HostLane {
    static std::uint32_t thread() { return number; }
    static std::uint32_t threads() { return block_threads; }
    static void wait_for_block() { block->arrive_and_wait(); }
    static std::uint32_t read(std::uint32_t& from) { return std::atomic_ref(from).load(); }
    template <class Number>
    static Number add(Number& to, Number value) {
        return std::atomic_ref(to).fetch_add(value);
    }

    static thread_local std::uint32_t number;
    static std::uint32_t block_threads;
    static std::unique_ptr<std::barrier<>> block;
};
thread_local std::uint32_t HostLanes::number = 0;
std::uint32_t HostLanes::block_threads = 1;
std::unique_ptr<std::barrier<>> HostLanes::block;

using Everything = EffectSet<all_effects.bits()>;

struct Staged {
    std::vector<Vec3d> sums;
    unsigned long long rays = 0, lost_media = 0, invalid = 0;
};

/// A window, rendered by blocks one after the other, each with `count` paths at a time.
template <class Real>
Staged render_staged(const PreparedScene& scene, const RenderJob& job, std::uint32_t count, std::uint32_t threads) {
    struct alignas(16) Unit {
        std::array<std::byte, 16> bytes;
    };
    const LoopTracer tracer{view(scene)};
    const PixelJob pixel_job = make_pixel_job(scene.camera, job);
    const FilmWindow window = window_of(job);
    std::vector<Unit> records(count * PathRecords<Real>::bytes / sizeof(Unit));
    std::vector<RarePathRecords<Real>> rare(count);
    const auto lists = std::make_unique<StageListsOf<Real>>();
    Staged result;
    result.sums.resize(static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height));
    unsigned int next_pixel = 0;
    std::vector<std::uint32_t> stages(most_paced_multiprocessors);
    HostLanes::block_threads = threads;
    HostLanes::block = std::make_unique<std::barrier<>>(static_cast<std::ptrdiff_t>(threads));
    std::vector<std::jthread> block;
    for (std::uint32_t i = 0; i < threads; ++i) {
        block.emplace_back([&, i] {
            HostLanes::number = i;
            StagedPaths<Everything, Real, LoopTracer, HostLanes> paths(
                tracer, pixel_job, static_cast<std::uint32_t>(window.height), PathRecords<Real>(records.data()),
                rare.data(), *lists, count, next_pixel, result.sums.data(),
                StagedCounts{result.rays, result.lost_media, result.invalid});
            paths.run(PairPace<HostLanes>(stages.data()));
        });
    }
    block.clear();
    return result;
}

PreparedScene scene_of(const std::string& name) {
    Scene scene = name.ends_with(".gltf") ? load_scene(TANDEM_SCENES "/" + name) : named_scene(name);
    scene.indirect_light = true;
    return prepare(scene);
}

class StagedPathsOf : public ::testing::TestWithParam<const char*> {};

TEST_P(StagedPathsOf, HaveTheBitsOfTheCpu) {
    const PreparedScene scene = scene_of(GetParam());
    ASSERT_TRUE(samples_one_light<Everything>(view(scene)));
    const auto cpu = make_backend("cpu");
    RenderJob job = test::small_job();
    job.width = 21;
    job.height = 13;
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        job.tier = tier;
        const RenderResult expected = cpu->render(cpu->load(scene, tier), job);
        const std::uint32_t most = tier == Tier::strict ? most_staged_paths<float> : most_staged_paths<double>;
        for (const auto& [count, threads] :
             {std::pair{1U, 1U}, std::pair{7U, 2U}, std::pair{300U, 3U}, std::pair{most, 4U}}) {
            SCOPED_TRACE(testing::Message() << to_string(tier) << ", " << count << " paths, " << threads << " threads");
            const Staged staged = tier == Tier::strict ? render_staged<float>(scene, job, count, threads)
                                                       : render_staged<double>(scene, job, count, threads);
            std::size_t different = 0;
            for (std::size_t i = 0; i < staged.sums.size(); ++i) {
                different += staged.sums[i] == expected.film.sums()[i] ? 0U : 1U;
            }
            EXPECT_EQ(different, 0U);
            EXPECT_EQ(staged.rays, expected.stats.rays);
            EXPECT_EQ(staged.lost_media, expected.stats.counters.lost_media);
            EXPECT_EQ(staged.invalid, expected.stats.counters.invalid_samples);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, StagedPathsOf,
                         ::testing::Values("whitted.gltf", "textured.gltf", "soft-shadows.gltf", "paper"));

// A window of a film, and samples that do not start at the first.
TEST(StagedPaths, RenderWindowsAndLaterSamples) {
    const PreparedScene scene = scene_of("whitted.gltf");
    const auto cpu = make_backend("cpu");
    RenderJob job = test::small_job();
    job.first_sample = 4;
    job.window = {11, 7, 9, 5};
    const RenderResult expected = cpu->render(cpu->load(scene, Tier::strict), job);
    const Staged staged = render_staged<float>(scene, job, 20, 2);
    ASSERT_EQ(staged.sums.size(), expected.film.pixel_count());
    for (std::size_t i = 0; i < staged.sums.size(); ++i) EXPECT_EQ(staged.sums[i], expected.film.sums()[i]) << i;
}

}  // namespace
}  // namespace tandem::cuda

// Renders that stop and go on: the bits of renders without a stop; checkpoints that do not belong are refused.
#include "tandem/render/checkpoint.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/input_error.h"
#include "support/interrupting_backend.h"
#include "support/plane_film.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/whole_file.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/checkpointed_frame.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/tiled_frame.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;

/// A frame, and where its checkpoint is.
class CheckpointTest : public testing::Test {
  protected:
    CheckpointTest() {
        job.width = 1100;  // more than two tiles
        job.height = 20;
        job.samples = 3;
        job.frame = 11;
        options.file = folder.file("a.checkpoint");
        options.every = 0;
        options.resume = true;
    }

    [[nodiscard]] FramePlan plan() const {
        return plan_frame(scene, {.frame = static_cast<std::int32_t>(job.frame)}, job);
    }
    /// Renders, and sets `interrupted` when the backend gets tile number `stop`; never if that is 0.
    std::optional<RenderedFrame> render(std::unique_ptr<Backend> inner, int stop = 0) {
        interrupted = false;
        test::InterruptingBackend backend(std::move(inner), stop, interrupted);
        const ImageMetadata frame = describe(job, frame_hash(scene, plan()), backend.name());
        return render_with_checkpoints(backend, scene, plan(), frame, options, interrupted);
    }
    [[nodiscard]] Film film_at_once() const { return render_frame(*make_backend("cpu"), scene, plan()).result.film; }

    test::TemporaryFolder folder;
    Scene scene = named_scene("paper");
    RenderJob job;
    CheckpointOptions options;
    std::atomic<bool> interrupted{false};
};

void expect_equal_films(const Film& a, const Film& b) {
    EXPECT_EQ(film_hash(a), film_hash(b));
    ASSERT_EQ(a.plane_mask(), b.plane_mask());
    for (const PlaneInfo& info : plane_infos()) EXPECT_EQ(plane_hash(a, info.plane), plane_hash(b, info.plane));
}

TEST_F(CheckpointTest, ResumedRendersHaveTheBitsOfRendersAtOnce) {
    job.planes = parse_planes("all");
    const Film expected = film_at_once();
    for (int stop = 1; stop <= 2; ++stop) {  // two tiles are in progress, so the third of three is left
        BackendOptions one;
        one.threads = 1;
        one.instruction_set = "x86-64-v2";
        EXPECT_FALSE(render(make_backend("cpu", one), stop));
        ASSERT_TRUE(std::filesystem::exists(options.file));
        BackendOptions two;
        two.threads = 2;
        two.tile_size = 7;
        const std::optional<RenderedFrame> rest = render(make_backend("cpu", two));
        ASSERT_TRUE(rest);
        expect_equal_films(rest->result.film, expected);
        std::filesystem::remove(options.file);
    }
}

TEST_F(CheckpointTest, EveryInstantOfMotionBlurIsAddedInItsOrder) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = Shutter{0, 0.5, 3};
    }
    job.samples = 7;
    ASSERT_EQ(plan().instants.size(), 3U);
    const Film expected = film_at_once();
    for (int stop = 1; stop <= 8; stop += 2) {
        EXPECT_FALSE(render(make_backend("cpu"), stop)) << stop;
        const std::optional<RenderedFrame> rest = render(make_backend("cpu"));
        ASSERT_TRUE(rest);
        expect_equal_films(rest->result.film, expected);
        std::filesystem::remove(options.file);
    }
}

TEST_F(CheckpointTest, RendersToATargetGoOnWithTheSameBits) {
    job.samples = 4096;
    job.planes = FilmPlane::normal;
    const std::function<double()> no_clock = [] { return 0.0; };
    for (const RenderTarget& target :
         {RenderTarget{.error = 0.003}, RenderTarget{.error = 0.0005, .metric = ErrorMetric::flip}}) {
        interrupted = false;
        test::InterruptingBackend counting(make_backend("cpu"), 1000, interrupted);
        const auto expected = render_to_target(counting, scene, plan(), target, interrupted, no_clock);
        ASSERT_TRUE(expected);
        EXPECT_EQ(expected->stopped_by, StoppedBy::target);
        const auto part = [&](const BackendOptions& how, int stop) {
            interrupted = false;
            test::InterruptingBackend backend(make_backend("cpu", how), stop, interrupted);
            const ImageMetadata frame = describe(job, frame_hash(scene, plan()), "cpu");
            return render_to_target_with_checkpoints(backend, scene, plan(), target, frame, options, interrupted,
                                                     no_clock);
        };
        BackendOptions one, other;
        one.threads = 1;
        one.instruction_set = "x86-64-v2";
        other.threads = 2;
        other.tile_size = 7;
        // interrupted after every few windows, by turns
        std::optional<TargetFrame> frame;
        int parts = 0;
        for (; !frame && parts < 100; ++parts) frame = part(parts % 2 == 0 ? one : other, 1 + parts % 3);
        ASSERT_TRUE(frame);
        EXPECT_GT(parts, 3);
        EXPECT_EQ(frame->stopped_by, StoppedBy::target);
        EXPECT_EQ(frame->tile_samples, expected->tile_samples);
        EXPECT_EQ(frame->error.value, expected->error.value);
        EXPECT_EQ(frame->error.high, expected->error.high);
        expect_equal_films(frame->frame.result.film, expected->frame.result.film);
        std::filesystem::remove(options.file);
    }
}

TEST_F(CheckpointTest, OfAnotherTargetIsRefused) {
    job.samples = 4096;
    const auto render_to = [&](const RenderTarget& target, int stop) {
        interrupted = false;
        test::InterruptingBackend backend(make_backend("cpu"), stop, interrupted);
        const ImageMetadata frame = describe(job, frame_hash(scene, plan()), "cpu");
        return render_to_target_with_checkpoints(backend, scene, plan(), target, frame, options, interrupted,
                                                 [] { return 0.0; });
    };
    EXPECT_FALSE(render_to({.error = 0.01}, 1));
    EXPECT_TRUE(contains(input_error([&] { (void)render_to({.error = 0.02}, 0); }),
                         "target is 'rmse 0.01' there, but 'rmse 0.02' here"));
    EXPECT_TRUE(contains(input_error([&] { (void)render(make_backend("cpu")); }), "target is 'rmse 0.01' there"));
    EXPECT_FALSE(render_to({.error = 0.01, .seconds = 1e6}, 1));  // other time is not another film
}

TEST_F(CheckpointTest, TheTimeOfEarlierRunsCounts) {
    job.samples = 4096;
    double now = 0;
    const auto run = [&](int stop) {
        interrupted = false;
        test::InterruptingBackend backend(make_backend("cpu"), stop, interrupted);
        const ImageMetadata frame = describe(job, frame_hash(scene, plan()), "cpu");
        return render_to_target_with_checkpoints(backend, scene, plan(), {.seconds = 10}, frame, options, interrupted,
                                                 [&] { return now += 1; });
    };
    EXPECT_FALSE(run(2));
    const double before = read_checkpoint(options.file).round->seconds;
    EXPECT_GT(before, 1);
    now = 1000;
    const auto frame = run(0);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stopped_by, StoppedBy::time);
    EXPECT_LT(now, 1012);
}

TEST_F(CheckpointTest, OnlyWhatIsLeftIsRendered) {
    EXPECT_FALSE(render(make_backend("cpu"), 2));
    const Checkpoint half = read_checkpoint(options.file);
    EXPECT_EQ(half.film.samples(), (std::vector<int>{3, 3, 0}));
    int tiles = 0;
    TiledFilm film = half.film;
    TileCosts costs;
    EXPECT_TRUE(render_tiles(*make_backend("cpu"), scene, plan(), film, costs, [&] { return ++tiles < 9; }));
    EXPECT_EQ(tiles, 1);
}

TEST_F(CheckpointTest, OfAnotherRenderIsRefusedWithWhatDiffers) {
    EXPECT_FALSE(render(make_backend("cpu"), 1));
    const RenderJob begun = job;
    const auto refused = [&] {
        std::string message = input_error([&] { (void)render(make_backend("cpu")); });
        job = begun;
        return message;
    };
    job.seed = 5;
    EXPECT_TRUE(contains(refused(), "seed is '0' there, but '5' here"));
    job.samples = 4;
    EXPECT_TRUE(contains(refused(), "samples is '3' there, but '4' here"));
    job.tier = Tier::precise;
    EXPECT_TRUE(contains(refused(), "tier is 'strict' there, but 'precise' here"));
    job.filter = PixelFilter::tent;
    EXPECT_TRUE(contains(refused(), "filter is 'box' there, but 'tent' here"));
    job.planes = FilmPlane::depth;
    EXPECT_TRUE(contains(refused(), "planes is '' there, but 'depth' here"));
    scene.materials[0].phong.diffuse.x *= 0.5F;
    EXPECT_TRUE(contains(refused(), "scene_hash"));
    EXPECT_TRUE(contains(refused(), "name another file"));
}

TEST_F(CheckpointTest, AnExistingOneIsNotOverwritten) {
    EXPECT_FALSE(render(make_backend("cpu"), 1));
    options.resume = false;
    EXPECT_TRUE(contains(input_error([&] { (void)render(make_backend("cpu")); }), "--resume"));
}

TEST_F(CheckpointTest, IsReadAsItWasWritten) {
    const PlaneMask planes = parse_planes("all");
    Checkpoint written{describe(job, "hash", "cpu"), {}, TiledFilm({70, 20, 32}, planes)};
    written.frame.width = 70;
    written.frame.height = 20;
    written.frame.planes = to_string(planes);
    written.counters.lost_media = 7;
    written.film.add(1, test::plane_film(32, 20, 4, planes));
    written.film.add(2, test::plane_film(6, 20, 9, planes, 100));
    written.round = Round{
        {Film(), test::plane_film(32, 20, 2, FilmPlane::variance), Film()}, {0, 2, 9}, {8, 4, 12}, false, true, 0.1};
    write_checkpoint(options.file, written);
    const Checkpoint read = read_checkpoint(options.file);
    ASSERT_TRUE(read.round);
    EXPECT_EQ(read.round->begins, written.round->begins);
    EXPECT_EQ(read.round->ends, written.round->ends);
    EXPECT_FALSE(read.round->is_last);
    EXPECT_TRUE(read.round->was_last);
    EXPECT_EQ(read.round->seconds, 0.1);
    EXPECT_EQ(read.round->fresh[0].samples(), 0);
    expect_equal_films(read.round->fresh[1], written.round->fresh[1]);
    EXPECT_EQ(read.frame, written.frame);
    EXPECT_EQ(read.counters, written.counters);
    EXPECT_EQ(read.film.grid(), written.film.grid());
    EXPECT_EQ(read.film.samples(), (std::vector<int>{0, 4, 9}));
    for (const std::size_t tile : {1U, 2U}) expect_equal_films(read.film.tile(tile), written.film.tile(tile));
}

TEST_F(CheckpointTest, DamagedOnesAreRefused) {
    EXPECT_FALSE(render(make_backend("cpu"), 1));
    const Bytes good = read_file(options.file);
    const auto refusal = [&](const Bytes& bytes) {
        write_file(options.file, bytes);
        return input_error([&] { (void)read_checkpoint(options.file); });
    };
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        test::Random random(seed);
        Bytes bad = good;
        const std::size_t at = 20 + random.below(static_cast<std::uint32_t>(bad.size() - 20));
        bad[at] ^= static_cast<std::byte>(1U << random.below(8));
        EXPECT_TRUE(contains(refusal(bad), "is damaged")) << "seed " << seed;
        EXPECT_TRUE(contains(refusal(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(at))), "damaged"))
            << "cut, seed " << seed;
    }
    Bytes newer = good;
    newer[18] = std::byte{'9'};
    EXPECT_TRUE(contains(refusal(newer), "another form"));
    EXPECT_TRUE(contains(refusal({}), "not a checkpoint"));
}

TEST(TileEdge, KeepsTilesSmallEnoughToStopBetweenThem) {
    EXPECT_EQ(tile_edge_for(1), 512);
    EXPECT_EQ(tile_edge_for(128), 512);
    EXPECT_EQ(tile_edge_for(129), 256);
    EXPECT_EQ(tile_edge_for(1 << 24), 16);
}

}  // namespace
}  // namespace tandem

// Several backends as one: the bits of one of them, however they share the work, and whichever of them fail.
#include "tandem/render/combined_backend.h"

#include <gtest/gtest.h>

#include <latch>

#include "support/faulty_backend.h"
#include "support/input_error.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/checkpointed_frame.h"
#include "tandem/render/copy_window.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::Faults;
using test::FaultyBackend;
using test::input_error;
using test::thrown_message;

constexpr std::chrono::microseconds pause{200};

class CombinedBackend : public testing::Test {
  protected:
    CombinedBackend() {
        job.width = 37;
        job.height = 150;
        job.samples = 2;
        job.planes = parse_planes("all");
    }

    /// Members that cut even small films, one for each element.
    std::unique_ptr<Backend> combine(const std::vector<Faults>& faults) {
        std::vector<CombinedMember> members;
        for (const Faults& fault : faults) {
            auto cpu = make_backend("cpu", {.threads = 1});
            members.push_back(
                {"member " + std::to_string(members.size()), std::make_unique<FaultyBackend>(std::move(cpu), fault)});
        }
        return make_combined_backend(
            std::move(members),
            {.least_pixels = 1, .least_rays = 10, .least_seconds = 0, .report = [this](const std::string& sentence) {
                 reports.push_back(sentence);
             }});
    }
    [[nodiscard]] Film expected_film() const { return cpu->render(cpu->load(scene), job).film; }

    const PreparedScene scene = prepare(named_scene("mixed/300"));
    const std::unique_ptr<Backend> cpu = make_backend("cpu");
    RenderJob job;
    std::vector<std::string> reports;
};

void expect_equal_films(const Film& a, const Film& b, const std::string& where) {
    ASSERT_EQ(a.plane_mask(), b.plane_mask()) << where;
    EXPECT_EQ(film_hash(a), film_hash(b)) << where;
    for (const PlaneInfo& info : plane_infos()) {
        if (!a.plane_mask().has(info.plane)) continue;
        EXPECT_EQ(plane_hash(a, info.plane), plane_hash(b, info.plane)) << where << ", " << info.name;
    }
}

TEST_F(CombinedBackend, FilmsHaveTheBitsOfOneBackend) {
    const FilmWindow windows[] = {{0, 0, 37, 150}, {36, 149, 1, 1}, {5, 3, 1, 140}, {0, 77, 37, 1}, {7, 9, 23, 101}};
    const auto resident = cpu->load(scene);
    for (const std::vector<Faults>& members : {std::vector<Faults>(1),
                                               std::vector<Faults>(2),
                                               {Faults{}, Faults{.delay = pause}, Faults{.delay = 10 * pause}}}) {
        const auto combined = combine(members);
        const auto loaded = combined->load(scene);
        for (const FilmWindow& window : windows) {
            job.window = window;
            const std::string where =
                std::to_string(members.size()) + " members, window at " + std::to_string(window.left);
            const RenderResult result = combined->render(loaded, job);
            expect_equal_films(result.film, cpu->render(resident, job).film, where);
            EXPECT_EQ(result.stats.rays, cpu->render(resident, job).stats.rays) << where;
        }
    }
    EXPECT_TRUE(reports.empty());
}

TEST_F(CombinedBackend, EveryMemberTakesAShareAndAFastOneTheLargest) {
    job.height = 800;
    const auto both = std::make_shared<std::latch>(2);
    const auto combined = combine({Faults{.start = both}, Faults{.delay = 100 * pause, .start = both}});
    const auto loaded = combined->load(scene);
    (void)combined->render(loaded, job);
    const Capabilities capabilities = combined->capabilities();
    ASSERT_EQ(capabilities.members.size(), 2U);
    EXPECT_EQ(capabilities.members[0].samples + capabilities.members[1].samples, 37U * 800 * 2);
    EXPECT_GT(capabilities.members[1].samples, 0U);
    EXPECT_GT(capabilities.members[0].samples, capabilities.members[1].samples);
    EXPECT_EQ(capabilities.members[1].name, "member 1");
    EXPECT_TRUE(contains(capabilities.device, "member 0: "));
    EXPECT_TRUE(contains(capabilities.device, "; member 1: "));
    EXPECT_TRUE(capabilities.exact);
    EXPECT_EQ(combined->frames_in_flight(), 4U);
}

TEST_F(CombinedBackend, AMemberThatFailsIsSurvivedAndReported) {
    const Film expected = expected_film();
    const std::vector<std::pair<const char*, Faults>> stages = {
        {"load", {.load = 1}},       {"first band", {.submit = 1}}, {"second band", {.submit = 2}},
        {"a later", {.submit = 4}},  {"first film", {.get = 1}},    {"a later film", {.get = 3}},
        {"times", {.load_times = 1}}};
    for (const auto& [stage, faults] : stages) {
        for (const std::size_t bad : {std::size_t{0}, std::size_t{1}}) {
            reports.clear();
            std::vector<Faults> members(2);
            members[bad] = faults;
            test::wait_for_failure(members[1 - bad], members[bad]);
            const auto combined = combine(members);
            const auto loaded = combined->load(scene);
            (void)loaded->load_times();
            std::string warning;
            for (int frame = 0; frame < 2; ++frame) {
                const RenderResult result = combined->render(loaded, job);
                expect_equal_films(result.film, expected, stage);
                warning += result.stats.warning;
            }
            const std::string sentence =
                "member " + std::to_string(bad) + " failed and is left out; the others do its work: the memory is full";
            EXPECT_EQ(reports, std::vector<std::string>{sentence}) << stage;
            EXPECT_EQ(warning, sentence) << stage << ": once";
            EXPECT_EQ(combined->capabilities().members[bad].failure, "the memory is full");
            EXPECT_EQ(combined->capabilities().members[1 - bad].failure, "");
            // a scene that is loaded later, on the members that are left
            expect_equal_films(combined->render(combined->load(scene), job).film, expected, stage);
        }
    }
}

TEST_F(CombinedBackend, AnyExceptionButWrongInputIsSurvived) {
    const Film expected = expected_film();
    for (const auto& [thrown, text] :
         {std::pair<std::function<void()>, const char*>{[] { throw std::bad_alloc(); }, "not enough memory"},
          {[] { throw std::runtime_error("CUDA failed"); }, "CUDA failed"},
          {[] { throw 1; }, "unknown"}}) {
        std::vector<Faults> members = {Faults{.submit = 1, .throws = thrown}, Faults{}};
        test::wait_for_failure(members[1], members[0]);
        const auto combined = combine(members);
        const RenderResult result = combined->render(combined->load(scene), job);
        expect_equal_films(result.film, expected, text);
        EXPECT_TRUE(contains(result.stats.warning, text));
    }
}

TEST_F(CombinedBackend, IfAllFailTheErrorNamesThem) {
    const Faults first{.get = 1, .throws = [] { throw EnvironmentError("fell off the bus"); }};
    for (const Faults& second : {Faults{.load = 1}, Faults{.submit = 1}, Faults{.get = 2}}) {
        const auto combined = combine({first, second});
        const auto loaded = combined->load(scene);
        const auto message = [&](auto action) { return thrown_message<EnvironmentError>(action); };
        const std::string wanted = "all failed. member 0: fell off the bus. member 1: the memory is full";
        EXPECT_EQ(message([&] { (void)combined->render(loaded, job); }), wanted);
        EXPECT_EQ(message([&] { (void)combined->render(loaded, job); }), wanted) << "and again";
        EXPECT_EQ(message([&] { (void)combined->load(scene); }), wanted);
        std::vector<Ray<float>> rays(30);
        std::vector<Hit> hits(30);
        EXPECT_EQ(message([&] { (void)combined->trace(*loaded, rays, hits); }), wanted);
    }
    const auto combined = combine({Faults{.load = 1}, Faults{.load = 1}});
    EXPECT_THROW((void)combined->load(scene), EnvironmentError);
}

TEST_F(CombinedBackend, ABugOfTheLastMemberIsNoLackOfTheMachine) {
    const Faults bug{.submit = 1, .throws = [] { throw std::logic_error("a bug"); }};
    const auto combined = combine({bug, Faults{.submit = 1}});
    const auto loaded = combined->load(scene);
    try {
        (void)combined->render(loaded, job);
        ADD_FAILURE() << "no error";
    } catch (const EnvironmentError&) {
        ADD_FAILURE() << "a bug, reported as a lack of the machine";
    } catch (const std::runtime_error& error) {
        EXPECT_TRUE(contains(error.what(), "a bug"));
    }
}

TEST_F(CombinedBackend, WrongInputIsNotSurvivedAndLeavesNobodyOut) {
    const Film expected = expected_film();
    const auto wrong = [] { throw InputError("the window is wrong"); };
    for (const Faults& faults : {Faults{.submit = 2, .throws = wrong}, Faults{.get = 1, .throws = wrong}}) {
        std::vector<Faults> members = {faults, Faults{}};
        test::wait_for_failure(members[1], members[0]);
        const auto combined = combine(members);
        const auto loaded = combined->load(scene);
        EXPECT_EQ(input_error([&] { (void)combined->render(loaded, job); }), "the window is wrong");
        expect_equal_films(combined->render(loaded, job).film, expected, "the next frame");
        EXPECT_EQ(combined->capabilities().members[0].failure, "");
    }
    const auto combined = combine({Faults{.load = 1, .throws = wrong}, Faults{}});
    EXPECT_EQ(input_error([&] { (void)combined->load(scene); }), "the window is wrong");
    const auto loaded = combined->load(scene);
    RenderJob none = job;
    none.samples = 0;
    EXPECT_TRUE(contains(input_error([&] { (void)combined->submit(loaded, none); }), "samples"));
    RenderJob other = job;
    other.tier = Tier::precise;
    EXPECT_TRUE(contains(input_error([&] { (void)combined->submit(loaded, other); }), "precise"));
    EXPECT_THROW((void)make_combined_backend({}), InputError);
}

TEST_F(CombinedBackend, SeveralFramesAreInWorkAtATime) {
    const auto combined = combine({Faults{}, Faults{.delay = pause}, Faults{.get = 4}});
    const auto loaded = combined->load(scene), reference = cpu->load(scene);
    std::vector<std::unique_ptr<PendingFrame>> frames;
    std::vector<RenderJob> jobs;
    for (std::uint32_t i = 0; i < 9; ++i) {
        job.frame = i;
        job.window = FilmWindow{static_cast<int>(i), static_cast<int>(10 * i), 20, 40};
        jobs.push_back(job);
        frames.push_back(combined->submit(loaded, job));
    }
    for (const std::size_t i : {8U, 0U, 3U, 2U, 7U}) {
        expect_equal_films(frames[i]->get().film, cpu->render(reference, jobs[i]).film, "frame " + std::to_string(i));
    }
    frames.clear();  // nobody waits for the others
    job.window.reset();
    expect_equal_films(combined->render(loaded, job).film, expected_film(), "the next frame");
}

TEST_F(CombinedBackend, RaysAreTracedAsByOneBackend) {
    test::Random random(7);
    std::vector<Ray<float>> rays(500);
    std::vector<RayEnd> ends(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto number = [&] { return random.uniform(-1.0F, 1.0F); };
        rays[i] = {{number(), number(), 3}, {number() * 0.3F, number() * 0.3F, -1}};
        ends[i].t = random.uniform(1.0, 4.0);
    }
    rays[123].direction = {0, 0, 0};  // rejected
    const auto trace = [&](Backend& backend, bool shadow) {
        std::pair<std::vector<Hit>, std::pair<std::vector<double>, RenderCounters>> all;
        all.first.resize(rays.size());
        all.second.first.resize(rays.size());
        TraceJob trace_job{.rays = rays, .hits = all.first, .wide_t = all.second.first};
        if (shadow) trace_job.ends = ends;
        trace_job.counters = &all.second.second;
        const auto loaded = backend.load(scene);
        (void)backend.trace(*loaded, trace_job);
        return all;
    };
    for (const bool shadow : {false, true}) {
        const auto expected = trace(*cpu, shadow);
        EXPECT_EQ(expected.second.second.rejected_rays, 1U);
        for (const std::vector<Faults>& members : {std::vector<Faults>(2),
                                                   {Faults{.delay = pause}, Faults{.trace = 1}},
                                                   {Faults{.trace = 3}, Faults{.delay = pause}, Faults{}},
                                                   {Faults{}, Faults{.trace = 1, .delay = 50 * pause}}}) {
            const auto combined = combine(members);
            const auto got = trace(*combined, shadow);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(got.first[i].primitive, expected.first[i].primitive) << i;
                ASSERT_EQ(got.first[i].t, expected.first[i].t) << i;
                ASSERT_EQ(got.second.first[i], expected.second.first[i]) << i;
            }
            EXPECT_EQ(got.second.second, expected.second.second);
        }
    }
    const auto combined = combine({Faults{}, Faults{}});
    const auto loaded = combined->load(scene);
    EXPECT_EQ(combined->trace(*loaded, {}, {}), 0);
    std::vector<Hit> few(3);
    EXPECT_THROW((void)combined->trace(*loaded, rays, few), InputError);
}

TEST_F(CombinedBackend, MotionBlurCheckpointsAndTargetsWorkThroughIt) {
    Scene moving = named_scene("paper");
    for (Node& node : moving.nodes) {
        if (node.camera) shutter_of(*node.camera) = Shutter{0, 0.5, 3};
    }
    job.samples = 7;
    job.width = 1100;
    job.height = 20;
    const PrepareOptions eleventh{.frame = 11};
    job.frame = 11;
    const FramePlan plan = plan_frame(moving, eleventh, job);
    ASSERT_EQ(plan.instants.size(), 3U);
    const Film expected = render_frame(*cpu, moving, plan).result.film;
    const auto combined = combine({Faults{}, Faults{.delay = pause}, Faults{.get = 5}});
    expect_equal_films(render_frame(*combined, moving, plan).result.film, expected, "motion blur");

    const test::TemporaryFolder folder;
    const std::atomic<bool> never{false};
    const ImageMetadata metadata = describe(job, frame_hash(moving, plan), combined->name());
    const auto with_checkpoints =
        render_with_checkpoints(*combined, moving, plan, metadata, {.file = folder.file("a"), .every = 0}, never);
    ASSERT_TRUE(with_checkpoints);
    expect_equal_films(with_checkpoints->result.film, expected, "checkpoints");

    const Scene still = named_scene("paper");
    RenderJob many = job;
    many.width = 70;
    many.height = 40;
    many.samples = 64;
    const FramePlan at_once = plan_frame(still, {}, many);
    const RenderTarget target{.error = 0.01};
    const auto clock = [] { return 0.0; };
    const auto one = render_to_target(*cpu, still, at_once, target, never, clock);
    const auto several = render_to_target(*combined, still, at_once, target, never, clock);
    ASSERT_TRUE(one && several);
    EXPECT_EQ(several->tile_samples, one->tile_samples);
    expect_equal_films(several->frame.result.film, one->frame.result.film, "target");
}

TEST_F(CombinedBackend, FramesCanFillAPartOfAFilm) {
    const auto resident = cpu->load(scene);
    const auto combined = combine({Faults{}, Faults{}});
    const auto loaded = combined->load(scene);
    job.window = FilmWindow{10, 20, 8, 30};
    const Film part = cpu->render(resident, job).film;
    for (const bool several : {false, true}) {
        Backend& backend = several ? *combined : *cpu;
        Film film(60, 60, job.samples, job.planes);
        const RenderResult result = backend.submit_to(film, 5, 9, several ? loaded : resident, job)->get();
        EXPECT_EQ(result.film.pixel_count(), 0U);
        Film cut(8, 30, job.samples, job.planes);
        copy_window(cut, 0, 0, film, {5, 9, 8, 30});
        expect_equal_films(cut, part, "the window");
        Film empty(60, 60, job.samples, job.planes);
        copy_window(film, 5, 9, empty, {0, 0, 8, 30});
        expect_equal_films(film, empty, "around it");
        EXPECT_THROW((void)backend.submit_to(film, 55, 9, several ? loaded : resident, job)->get(), InputError);
    }
}

}  // namespace
}  // namespace tandem

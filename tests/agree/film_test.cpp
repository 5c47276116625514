// Films: equal bits from every backend, thread count, tile size and run; near the oracle's.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/random.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/tone_curve.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

RenderJob odd_job(Tier tier = Tier::strict) {
    RenderJob job;
    job.tier = tier;
    job.width = 131;  // odd, so that tiles and packets end in the middle
    job.height = 97;
    job.samples = 5;
    job.seed = 7;
    return job;
}

Film render_with(const std::string& backend, const BackendOptions& options, const PreparedScene& scene,
                 const RenderJob& job) {
    const auto b = make_backend(backend, options);
    return b->render(b->load(scene, job.tier), job).film;
}

class FilmBits : public test::ExactBackend {
  protected:
    [[nodiscard]] static RenderJob job() { return odd_job(GetParam().tier); }
};

TEST_P(FilmBits, AreThoseOfTheLeastProcessor) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    least.threads = 1;
    for (const char* name :
         {"paper", "spheres/7", "mixed/64", "mixed/500", "boxes/100", "triangles/300", "quads/9", "icosphere/3"}) {
        const PreparedScene scene = prepare(named_scene(name), {.frame = 11, .camera = ""});
        const Film expected = render_with("cpu", least, scene, job());
        const RenderResult result = backend_->render(load(scene), job());
        EXPECT_EQ(film_hash(result.film), film_hash(expected)) << name;
        EXPECT_EQ(result.stats.counters, RenderCounters{}) << name;
        EXPECT_EQ(result.stats.rays, result.film.pixel_count() * 5) << name;
    }
}

/// Which pixels threads or lanes share depends on the number of samples (cuda/shared_pixel.h, cpu/shared_pixels.h).
/// Samples of longer paths are handed out in sets (cuda/shared_queue.h, cpu/sample_sets.h); with area lights and paths
/// of one vertex, warps take tiles (cuda/render_thread.h).
TEST_P(FilmBits, OfAnyNumberOfSamplesAreThoseOfTheLeastProcessor) {
    BackendOptions options;
    options.instruction_set = "x86-64-v2";
    const auto least = make_backend("cpu", options);
    RenderJob few = job();
    few.width = 37;
    few.height = 23;
    for (const EffectMask forced : {EffectMask(), EffectMask(Effect::area_lights), EffectMask(Effect::indirect)}) {
        const PreparedScene scene =
            prepare(named_scene("mixed/500"), {.frame = 11, .camera = "", .effects = {forced, {}}});
        const auto resident = load(scene), on_least = least->load(scene, GetParam().tier);
        for (const int samples : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 16, 17, 20, 33, 65}) {
            few.samples = samples;
            const RenderResult expected = least->render(on_least, few), result = backend_->render(resident, few);
            const std::string what = fmt::format("{} samples, forced: {}", samples, to_string(forced));
            EXPECT_EQ(film_hash(result.film), film_hash(expected.film)) << what;
            EXPECT_EQ(result.stats.counters, RenderCounters{}) << what;
            EXPECT_EQ(result.stats.rays, expected.stats.rays) << what;
        }
    }
}

TEST_P(FilmBits, GiveTheLevelsOfAnImage) {
    RenderJob one = job();
    for (const char* name : {"paper", "mixed/500"}) {
        const auto scene = load(prepare(named_scene(name), {.frame = 11, .camera = ""}));
        std::vector<std::unique_ptr<PendingImage>> pending;
        std::vector<ToneMapped> expected;
        for (const std::optional<FilmWindow>& window :
             {std::optional<FilmWindow>(), std::optional<FilmWindow>({3, 5, 61, 33})}) {
            one.window = window;
            for (const Display& display : {Display{TransferFunction::srgb, 0},
                                           {TransferFunction::srgb, 1.3},
                                           {TransferFunction::linear, 0},
                                           {TransferFunction::linear, -0.7}}) {
                pending.push_back(backend_->submit_image(scene, one, display));
                expected.push_back(tone_map(backend_->render(scene, one).film, display));
            }
        }
        for (std::size_t i = pending.size(); i-- > 0;) {  // fetched in another order
            const ImageResult result = pending[i]->get();
            EXPECT_EQ(result.image.width, expected[i].image.width) << name << ", image " << i;
            EXPECT_EQ(result.image.height, expected[i].image.height) << name << ", image " << i;
            EXPECT_TRUE(std::ranges::equal(result.image.values, expected[i].image.values)) << name << ", image " << i;
            EXPECT_EQ(result.nan_values, 0U);
            EXPECT_EQ(result.stats.counters, RenderCounters{}) << name;
            EXPECT_EQ(result.stats.rays, pixel_count(result.image) * 5) << name;
        }
    }
    one.planes = FilmPlane::depth;
    const auto scene = load(prepare(named_scene("paper"), {}));
    const auto message = test::thrown_message<InputError>([&] { (void)backend_->submit_image(scene, one, Display()); });
    EXPECT_NE(message.find("depth"), std::string::npos) << message;
}

TEST_P(FilmBits, AreTheSameForFramesInFlightAndFramesAlone) {
    const Scene scene = named_scene("paper");
    std::vector<std::unique_ptr<PendingFrame>> pending;
    RenderJob one = job();
    for (std::uint32_t frame = 0; frame < 5; ++frame) {
        one.frame = frame;
        pending.push_back(
            backend_->submit(load(prepare(scene, {.frame = static_cast<int>(frame), .camera = ""})), one));
    }
    for (std::uint32_t frame = 5; frame-- > 0;) {  // fetched in another order
        one.frame = frame;
        const Film in_flight = pending[frame]->get().film;
        const Film alone =
            backend_->render(load(prepare(scene, {.frame = static_cast<int>(frame), .camera = ""})), one).film;
        EXPECT_EQ(film_hash(in_flight), film_hash(alone)) << "frame " << frame;
    }
}

/// The paper's scene with the camera and the solids elsewhere, other materials, and up to five lights: GPUs have a way
/// of their own for pinhole cameras before a few solids (kernel/traversal/certain_view.h).
PreparedScene few_solids(std::uint64_t seed) {
    test::Random random(seed);
    const auto moved = [&](double by) {
        return Vec3d{random.uniform(-by, by), random.uniform(-by, by), random.uniform(-by, by)};
    };
    PreparedScene scene = prepare(named_scene("paper"), {.frame = static_cast<int>(random.below(120)), .camera = ""});
    scene.camera.render_from_camera.translation += moved(1.5);
    scene.camera.half_height *= std::exp2(random.uniform(-4.0, 1.0));
    for (Sphere& sphere : scene.spheres) {
        sphere.centre = narrow(widen(sphere.centre) + moved(0.4));
        sphere.radius *= random.uniform(0.3F, 1.5F);
    }
    for (PhongMaterial& material : scene.materials) {
        material.shininess = random.coin() ? 0.5F * static_cast<float>(random.below(100)) : 32.0F;
        if (random.below(4) == 0) material.specular = {0, 0, 0};
    }
    for (std::uint32_t i = random.below(5); i > 0; --i) {
        scene.lights.push_back(scene.lights[0]);
        scene.lights.back().position = narrow(moved(3));
        scene.lights.back().intensity = {0.2F, random.uniform(0.0F, 1.0F), 0.4F};
    }
    return scene;
}

TEST_P(FilmBits, OfFewSolidsAreThoseOfTheLeastProcessor) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    RenderJob many = job();
    many.samples = 9;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const PreparedScene scene = few_solids(seed);
        const Film expected = render_with("cpu", least, scene, many);
        EXPECT_EQ(film_hash(backend_->render(load(scene), many).film), film_hash(expected))
            << "few_solids(" << seed << ")";
    }
}

TEST_P(FilmBits, ChangeWithSeedAndFrame) {
    const auto scene = load(prepare(named_scene("paper")));
    const std::string reference = film_hash(backend_->render(scene, job()).film);
    RenderJob one = job();
    one.seed = 8;
    EXPECT_NE(film_hash(backend_->render(scene, one).film), reference);
    one = job();
    one.seed += std::uint64_t{1} << 40;
    EXPECT_NE(film_hash(backend_->render(scene, one).film), reference);
    one = job();
    one.frame = 1;
    EXPECT_NE(film_hash(backend_->render(scene, one).film), reference);
}

TEST_P(FilmBits, AreNearTheOracle) {
    for (const char* name : {"paper", "mixed/64", "triangles/60", "quads/60", "leaves/60", "icosphere/1"}) {
        const PreparedScene scene = prepare(named_scene(name));
        const Film film = backend_->render(load(scene), job()).film;
        const Film oracle = render_with("oracle", {}, scene, job());
        // five samples of at most 2.1 each, a few roundings to float in every one; precise rounds nothing to float,
        // but raises the cosine to a power within 2^-40
        const double bound = GetParam().tier == Tier::precise ? 1e-11 : 4e-6;
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            const Vec3d difference = film.sums()[i] - oracle.sums()[i];
            ASSERT_LE(std::max({std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)}), bound)
                << name << ", pixel " << i % 131 << ", " << i / 131;
        }
    }
}

// G7, I7: a light that is not a number. Its samples are left out and counted, alike on every backend; the others stay.
TEST_P(FilmBits, LeaveOutSamplesThatAreNotNumbers) {
    PreparedScene scene = prepare(named_scene("mixed/64"));
    ASSERT_FALSE(scene.lights.empty());
    for (const float poison : {std::nanf(""), HUGE_VALF}) {
        scene.lights[0].intensity = {poison, 1, 1};
        const RenderResult result = backend_->render(load(scene), job());
        const RenderResult oracle = [&] {
            const auto b = make_backend("oracle");
            return b->render(b->load(scene, job().tier), job());
        }();
        EXPECT_EQ(result.stats.counters.invalid_samples, oracle.stats.counters.invalid_samples);
        EXPECT_GT(result.stats.counters.invalid_samples, 1'000U);
        EXPECT_LT(result.stats.counters.invalid_samples, result.stats.rays);
        for (const Vec3d& sum : result.film.sums()) {
            ASSERT_TRUE(std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z));
        }
    }
}

TEST_P(FilmBits, SayHowMuchWasDropped) {
    PreparedScene scene = prepare(named_scene("paper"));
    scene.dropped_primitives = 3;
    scene.dropped_lights = 2;
    const RenderCounters counters = backend_->render(load(scene), job()).stats.counters;
    EXPECT_EQ(counters.dropped_primitives, 3U);
    EXPECT_EQ(counters.dropped_lights, 2U);
}

INSTANTIATE_TEST_SUITE_P(Backends, FilmBits, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

TEST(CpuFilm, DoesNotDependOnThreadsOrTiles) {
    for (const char* name : {"paper", "mixed/500"}) {
        const PreparedScene scene = prepare(named_scene(name));
        std::string reference;
        for (const int threads : {1, 2, 7}) {
            for (const int tile : {8, 16, 13}) {
                BackendOptions options;
                options.threads = threads;
                options.tile_size = tile;
                const std::string hash = film_hash(render_with("cpu", options, scene, odd_job()));
                if (reference.empty()) reference = hash;
                EXPECT_EQ(hash, reference) << name << ", " << threads << " threads, tiles of " << tile;
            }
        }
    }
}

// Embree's commit arms flush-to-zero in TBB's workers; a film must not notice. A dark light makes subnormal sums.
TEST(CpuFilm, KeepsSubnormalsAfterACommit) {
    Scene scene = named_scene("mixed/200");
    for (Node& node : scene.nodes) {
        if (node.light) node.light->intensity = 1e-39F;
    }
    scene.environment = {{1e-40F, 1e-40F, 1e-40F}, {1e-41F, 0, 1e-39F}, {0, 0, 0}};
    BackendOptions many;
    many.threads = 4;
    const PreparedScene prepared = prepare(scene);
    const Film film = render_with("cpu", many, prepared, odd_job());
    const Film oracle = render_with("oracle", {}, prepared, odd_job());
    std::size_t lit = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        lit += film.sums()[i].x > 0;
        ASSERT_LE(std::abs(film.sums()[i].x - oracle.sums()[i].x), 5e-44) << "pixel " << i;
    }
    EXPECT_GT(lit, film.pixel_count() / 2);
}

}  // namespace
}  // namespace tandem

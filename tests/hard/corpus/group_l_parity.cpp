// Group L: what must not change a bit: device, threads, tiles, the state of the processor, kinds of NaN.
// scripts/compilers and the stored films of tests/agree compare compilers (L3).
#include <fmt/format.h>
#include <immintrin.h>

#include <cmath>

#include "hard/corpus/functions.h"
#include "hard/corpus/groups.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "support/correct_rounding.h"
#include "support/hard_scenes.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::hard {

namespace {

/// The CPU backend with the least instruction set of this build and one thread.
std::unique_ptr<Backend> least_processor() {
    return make_backend("cpu", {.threads = 1, .instruction_set = cpu_instruction_sets().front()});
}

/// Films and hits against those of the baseline.
Score least_processor_alike(const Subject& subject, Random&, std::size_t rays) {
    const auto least = least_processor();
    Score score;
    Score theirs;  // its time does not count for the subject
    for (const char* name : {"paper", "mixed/300", "spheres/100"}) {
        const PreparedScene scene = prepare(named_scene(name));
        const Film right = picture_of(*least, scene, small_picture(subject), theirs);
        compare_bits(picture_of(subject.backend, scene, small_picture(subject), score), right, name, score);
    }
    for (const test::HardScene& parameters : test::hard_scenes()) {
        const PreparedScene scene = test::make_scene(parameters, 20);
        const std::vector<Ray<float>> tried = test::make_rays(scene, rays / 10, 23);
        const auto trace = [&](Backend& backend) {
            std::vector<Hit> hits(tried.size());
            backend.trace(*backend.load(scene, subject.tier), TraceJob{.rays = tried, .hits = hits});
            return hits;
        };
        const std::vector<Hit> ours = trace(subject.backend), right = trace(*least);
        for (std::size_t i = 0; i < tried.size(); ++i) {
            score.decide(ours[i].primitive != right[i].primitive || !same_bits(ours[i].t, right[i].t),
                         [&] { return parameters.name + ": " + to_literal(tried[i]); });
        }
    }
    return score;
}

/// 1, 2 and 7 threads, tiles of 8, 13 and 16 pixels, and the same twice.
Score threads_and_tiles(const Subject& subject, Random&, std::size_t) {
    Score score;
    const PreparedScene scene = prepare(named_scene("mixed/300"));
    const Film right = picture_of(subject.backend, scene, small_picture(subject), score);
    for (const int threads : {1, 2, 7}) {
        for (const int tile : {8, 13, 16}) {
            const auto other = subject.make({.threads = threads, .tile_size = tile, .instruction_set = ""});
            compare_bits(picture_of(*other, scene, small_picture(subject), score), right,
                         fmt::format("{} threads, tiles of {}", threads, tile), score);
        }
    }
    return score;
}

/// With flush-to-zero armed in the calling thread, in a scene whose light makes subnormal sums.
Score flush_to_zero(const Subject& subject, Random&, std::size_t) {
    Scene dark = named_scene("mixed/200");
    for (Node& node : dark.nodes) {
        if (node.light) node.light->intensity = 1e-39F;
    }
    dark.environment = {{1e-40F, 1e-40F, 1e-40F}, {1e-41F, 0, 1e-39F}, {0, 0, 0}};
    const PreparedScene scene = prepare(dark);
    Score score;
    const Film right = picture_of(subject.backend, scene, small_picture(subject), score);
    const unsigned int saved = _mm_getcsr();
    _mm_setcsr(saved | 0x8040U);  // flush to zero, denormals are zero
    const auto other = subject.make({});
    const Film armed = picture_of(*other, scene, small_picture(subject), score);
    _mm_setcsr(saved);
    compare_bits(armed, right, "flush-to-zero armed", score);
    std::size_t lit = 0;
    for (const Vec3d& sum : right.sums()) lit += sum.x > 0;
    score.decide(lit < right.pixel_count() / 2, "the dark scene is black");
    return score;
}

/// lesser() and greater() with NaN, zeros of both signs and subnormals: the same operand on one ray and in a packet.
Score least_and_greatest(Random& random, std::size_t calls) {
    Score score;
    const auto any = [&] {
        static constexpr float special[] = {0.0F, -0.0F, 1e-45F, -1e-45F, HUGE_VALF, -HUGE_VALF};
        return random.coin() ? special[random.below(6)] : random.any_float();
    };
    for (std::size_t i = 0; i < calls; ++i) {
        const float a = any(), b = any();
        const float low = b < a ? b : a, high = a < b ? b : a;
        const auto same = [](float x, float y) { return same_bits(x, y) || (std::isnan(x) && std::isnan(y)); };
        const bool right = same(lesser(a, b), low) && same(greater(a, b), high) &&
                           same(lesser(in_all(a), in_all(b))[2], low) && same(greater(in_all(a), in_all(b))[3], high);
        score.decide(!right, [&] { return fmt::format("{:#x} and {:#x}", bits_of(a), bits_of(b)); });
    }
    return score;
}

/// Our functions return only one NaN, and integers are converted to float directly.
Score one_nan(Random& random, std::size_t calls) {
    Score score;
    for (const test::Function& function : test::functions) {
        for (const std::uint32_t payload : {0x7FC00000U, 0xFFC00000U, 0x7F800001U, 0xFFFFFFFFU}) {
            const float value = function.ours(float_of(payload), float_of(payload));
            score.decide(bits_of(value) != 0x7FC00000U, fmt::format("{} of NaN {:#x}", function.name, payload));
        }
    }
    for (std::size_t i = 0; i < calls; ++i) {
        const std::uint32_t word = random.below(1U << 31);
        const float right = static_cast<float>(static_cast<double>(word));
        score.decide(to_float(word) != right || to_float(UInt<Packet>(word))[0] != right,
                     [&] { return fmt::format("to_float({})", word); });
    }
    return score;
}

/// sin, cos, exp, log and pow: correctly rounded.
Score own_functions(Random& random, std::size_t calls) {
    Score score;
    for (const test::Function& function : test::functions) {
        test::CorrectRounding right(function);
        for (std::size_t i = 0; i < calls; ++i) {
            const float x = random.any_float();
            const float y = random.coin() ? random.any_float() : random.uniform(-64.0F, 64.0F);
            const float value = function.ours(x, y), wanted = right(x, y);
            score.decide(!same_bits(value, wanted) && !(std::isnan(value) && std::isnan(wanted)), [&] {
                return fmt::format("{}({:a}, {:a}) = {:a}, not {:a}", function.name, double{x}, double{y},
                                   double{value}, double{wanted});
            });
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> parity_cases() {
    return {
        {"L1", "Against the baseline x86-64 instruction set, one thread",
         "contraction, other functions, ties: 1 to 48 % of pixels", "metamorphosis: equal bits",
         RenderCase{least_processor_alike}},
        {"L2", "Threads and tiles", "sums and ties depend on the order of arrival", "metamorphosis: equal bits",
         RenderCase{threads_and_tiles}},
        {"L4", "Flush-to-zero set by other code", "subnormals vanish on some threads", "metamorphosis: equal bits",
         RenderCase{flush_to_zero}},
        {"L5", "Minimum and maximum with NaN and signed zeros", "fmin and fmax differ between processors",
         "rule: a < b ? a : b", FunctionCase{least_and_greatest}},
        {"L6", "Kinds of NaN, and integers to float", "x86 and GPUs produce different NaN", "rule: one NaN",
         FunctionCase{one_nan}},
        {"L8", "sin, cos, exp, log and pow of any float", "libraries differ in the last bit", "MPFR: correctly rounded",
         FunctionCase{own_functions}},
    };
}

}  // namespace tandem::hard

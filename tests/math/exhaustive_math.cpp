// The long test of exact_math.h: sin, cos, exp and log for all 2^32 floats, pow for 2^26 random pairs, against
// correct rounding. Usage: exhaustive_math [FUNCTION...], sin, cos, exp, log or pow. Status 1 if a value is wrong.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

#include "math/pow_pairs.h"
#include "support/correct_rounding.h"

namespace tandem::test {
namespace {

struct Arguments {
    float x, y;
};

/// What a run over one function found; a thread fills one, and they are added.
struct Findings {
    long inputs = 0, wrong = 0, mpfr_calls = 0;
    std::vector<std::pair<double, Arguments>> hardest;

    void add(const Findings& other) {
        inputs += other.inputs;
        wrong += other.wrong;
        mpfr_calls += other.mpfr_calls;
        hardest.insert(hardest.end(), other.hardest.begin(), other.hardest.end());
    }
};

/// Checks ours over at(0), ..., at(count - 1).
template <class At>
Findings check(const Function& function, std::uint64_t count, At at) {
    constexpr unsigned threads = 2;
    Findings total;
    std::mutex mutex;
    const auto work = [&](unsigned thread) {
        CorrectRounding reference(function);
        Findings found;
        for (std::uint64_t i = thread; i < count; i += threads) {
            const Arguments a = at(i);
            const long calls = reference.mpfr_calls;
            const float want = reference(a.x, a.y);
            const float ours = function.ours(a.x, a.y);
            ++found.inputs;
            if (reference.mpfr_calls != calls) {
                const double hardness = reference.hardness();
                if (hardness < 0x1p-54) found.hardest.push_back({hardness, a});
            }
            if (agrees(ours, want)) continue;
            if (++found.wrong <= 20) std::printf("  %s(%a, %a) is %a, not %a\n", function.name, a.x, a.y, want, ours);
        }
        found.mpfr_calls = reference.mpfr_calls;
        const std::lock_guard lock(mutex);
        total.add(found);
    };
    std::thread second(work, 1U);
    work(0U);
    second.join();
    return total;
}

Findings check(const Function& function) {
    if (std::strcmp(function.name, "pow") == 0) {
        return check(function, std::uint64_t{1} << 26, [](std::uint64_t i) {
            const auto [x, y] = pow_pair(i);
            return Arguments{x, y};
        });
    }
    return check(function, std::uint64_t{1} << 32, [](std::uint64_t i) {
        return Arguments{float_of(static_cast<std::uint32_t>(i)), 0.0F};
    });
}

int run(int argc, char** argv) {
#if defined(__x86_64__) && defined(__AVX2__)
    if (__builtin_cpu_supports("avx2") == 0) {
        std::fprintf(stderr, "exhaustive_math is built for x86-64-v3, which this processor is not\n");
        return 3;
    }
#endif
    long wrong = 0;
    for (const Function& function : functions) {
        const auto named = [&](const char* argument) { return std::strcmp(argument, function.name) == 0; };
        if (argc > 1 && std::none_of(argv + 1, argv + argc, named)) continue;
        Findings found = check(function);
        std::sort(found.hardest.begin(), found.hardest.end(), [](auto& a, auto& b) { return a.first < b.first; });
        std::printf("%s: %ld inputs, %ld not correctly rounded, %ld decided by MPFR\n", function.name, found.inputs,
                    found.wrong, found.mpfr_calls);
        for (std::size_t i = 0; i < std::min<std::size_t>(found.hardest.size(), 8); ++i) {
            const auto& [hardness, a] = found.hardest[i];
            std::printf("  2^%.1f from a midpoint: %a %a\n", std::log2(hardness), a.x, a.y);
        }
        std::fflush(stdout);
        wrong += found.wrong;
    }
    return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tandem::test

int main(int argc, char** argv) { return tandem::test::run(argc, argv); }

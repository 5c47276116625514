#include "tandem/images/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tandem/base/error.h"
#include "tandem/images/tone_curve.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

template <class Vec>
bool same_bits(const Vec& a, const Vec& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;  // NOLINT(bugprone-suspicious-memory-comparison): bits, not values
}

/// |a - b|: zero for equal infinities and for two NaN, infinite for one NaN.
double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double difference = std::abs(a - b);
    return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

bool differs_relatively(double a, double b, double tolerance) {
    const double difference = distance(a, b);
    // negated so that NaN and infinite differences count as differing
    return difference > 0 &&
           !(difference <= tolerance * std::max(std::abs(a), std::abs(b)) && std::isfinite(difference));
}

bool differs(float a, float b, Tolerance tolerance) {
    switch (tolerance) {
        case Tolerance::bits:
            return !same_bits(a, b);
        case Tolerance::relative_2_to_m20:
            return differs_relatively(double{a}, double{b}, 0x1p-20);
        case Tolerance::one_level:
            if (std::isnan(a) != std::isnan(b)) return true;
            return distance(double{clamp_to_unit(a)}, double{clamp_to_unit(b)}) > 1.0 / 255.0;
        case Tolerance::relative_5_percent:
            return differs_relatively(double{a}, double{b}, 0.05);
    }
    return true;
}

}  // namespace

const char* to_string(Tolerance tolerance) {
    switch (tolerance) {
#define TANDEM_TOLERANCE(name, words) \
    case Tolerance::name:             \
        return words;
#include "tandem/images/tolerances.def"
#undef TANDEM_TOLERANCE
    }
    return "unknown";
}

FilmDifference compare(const Film& a, const Film& b) {
    const DefaultFpEnvironment guard;
    if (a.width() != b.width() || a.height() != b.height() || a.pixel_count() == 0) {
        throw InputError(fmt::format("cannot compare films of {} x {} and {} x {} pixels", a.width(), a.height(),
                                     b.width(), b.height()));
    }
    FilmDifference result;
    result.pixels = a.pixel_count();
    double total = 0, squares = 0;
    for (std::size_t i = 0; i < result.pixels; ++i) {
        if (!same_bits(a.sums()[i], b.sums()[i])) ++result.differing_sums;
        const Vec3f p = a.mean(i), q = b.mean(i);
        if (same_bits(p, q)) continue;
        for (std::size_t t = 0; t < tolerances.size(); ++t) {
            const auto channel_differs = [&](float x, float y) { return differs(x, y, tolerances[t]); };
            if (channel_differs(p.x, q.x) || channel_differs(p.y, q.y) || channel_differs(p.z, q.z)) {
                ++result.differing_means[t];
            }
        }
        for (const double d : {distance(double{p.x}, double{q.x}), distance(double{p.y}, double{q.y}),
                               distance(double{p.z}, double{q.z})}) {
            result.largest = std::max(result.largest, d);
            total += d;
            squares += d * d;
        }
    }
    const auto values = static_cast<double>(3 * result.pixels);
    result.mean = total / values;
    result.rms = std::sqrt(squares / values);
    return result;
}

}  // namespace tandem

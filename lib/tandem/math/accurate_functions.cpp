#include "tandem/math/accurate_functions.h"

#include <cmath>
#include <limits>

#include "tandem/math/fp_environment.h"
#include "tandem/math/turns.h"

namespace tandem {

namespace {

using DoublePair = Pair<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Below this, sin, tan and atan equal their argument: the next term of their series is less than 2^-54 of it.
constexpr double tiny = 0x1p-27;

DoublePair exactly(double x) { return {x, 0}; }

/// a / b to 2^-100.
DoublePair ratio(const DoublePair& a, const DoublePair& b) {
    const double first = a.high / b.high;
    const DoublePair rest = a - exactly(first) * b;
    return fast_two_sum(first, rest.high / b.high);
}

/// The square root of a > 0 to 2^-100.
DoublePair root(const DoublePair& a) {
    const double first = std::sqrt(a.high);
    const DoublePair rest = a - two_product(first, first);
    return fast_two_sum(first, rest.high / (first + first));
}

/// x = quadrant pi/2 + rest, |rest| <= pi/4 and a little more, to 2^-100 of the rest. |x| <= 2^20.
struct Reduced {
    DoublePair rest;
    int quadrant;  ///< 0 to 3
};

/// After W. Cody and W. Waite, with pi/2 in four doubles, to 2^-217: except for 0, no double in the range is nearer
/// than 2^-80 to a multiple of pi/2.
Reduced reduce(double x) {
    constexpr double half_pi[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110,
                                  0x1.4cf98e804177dp-164};
    const double count = std::rint(x * exact_detail::two_over_pi);
    DoublePair rest = exactly(x);
    for (const double part : half_pi) rest = rest - two_product(count, part);
    return {rest, static_cast<int>(static_cast<long long>(count) & 3)};
}

/// 1 - z / (n (n + 1)) (1 - z / ((n + 2) (n + 3)) (1 - ...)): the series of sin(r) / r for n = 2 and of cos(r) for
/// n = 1, with z = r^2. 14 terms leave 2^-104 for |r| <= 0.8.
DoublePair alternating_series(const DoublePair& z, int n) {
    const DoublePair one = exactly(1);
    DoublePair sum = one;
    for (int k = n + 28; k >= n; k -= 2) sum = one - divide(z * sum, k * (k + 1));
    return sum;
}

struct PairOfSineAndCosine {
    DoublePair sine, cosine;
};

/// tiny <= |x| <= 2^20.
PairOfSineAndCosine sine_and_cosine(double x) {
    const auto [r, quadrant] = reduce(x);
    const DoublePair z = r * r;
    const DoublePair s = r * alternating_series(z, 2);
    const DoublePair c = alternating_series(z, 1);
    switch (quadrant) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

bool is_in_range(double x) { return std::abs(x) <= 0x1p20; }

/// log(1 + d) for |d| <= 2^-23, to 2^-100.
DoublePair log_next_to_one(const DoublePair& d) {
    const DoublePair one = exactly(1);
    DoublePair sum = divide(one, 6);
    for (double n = 5; n > 0; --n) sum = divide(one, n) - d * sum;
    return d * sum;
}

}  // namespace

double accurate_sin(double x) {
    const DefaultFpEnvironment guard;
    if (std::abs(x) < tiny) return x;
    return is_in_range(x) ? sine_and_cosine(x).sine.high : not_a_number;
}

double accurate_cos(double x) {
    const DefaultFpEnvironment guard;
    if (std::abs(x) < tiny) return 1;
    return is_in_range(x) ? sine_and_cosine(x).cosine.high : not_a_number;
}

double accurate_tan(double x) {
    const DefaultFpEnvironment guard;
    if (std::abs(x) < tiny) return x;
    if (!is_in_range(x)) return not_a_number;
    const PairOfSineAndCosine at = sine_and_cosine(x);
    return ratio(at.sine, at.cosine).high;
}

// One step of Newton's method from a value y that is correct to 2^-49: atan(x) - y is the arctangent of
// (x cos y - sin y) / (cos y + x sin y), and the two differ only in the third power.
double accurate_atan(double x) {
    const DefaultFpEnvironment guard;
    if (std::abs(x) < tiny || x != x) return x;
    const double largest = std::fmax(std::fmin(x, 0x1p200), -0x1p200);  // constant beyond
    const double y = atan2_turns<double>(largest, 1) * (2 * pi);
    const auto [sine, cosine] = sine_and_cosine(y);
    const DoublePair rest = exactly(largest) * cosine - sine;
    return two_sum(y, rest.high / (cosine.high + largest * sine.high)).high;
}

// As above: with s = sqrt(1 - x^2), the sine of acos(x) - y is s cos y - x sin y.
double accurate_acos(double x) {
    const DefaultFpEnvironment guard;
    if (!(std::abs(x) <= 1)) return not_a_number;
    if (x == 1) return 0;
    if (x == -1) return pi;
    const DoublePair s = root(two_sum(1.0, -x) * two_sum(1.0, x));
    const double y = atan2_turns<double>(s.high, x) * (2 * pi);
    const auto [sine, cosine] = sine_and_cosine(y);
    const DoublePair rest = s * cosine - exactly(x) * sine;
    return two_sum(y, rest.high).high;
}

// One step of Newton's method for y^3 = x.
double accurate_cbrt(double x) {
    const DefaultFpEnvironment guard;
    if (!(std::abs(x) < infinity) || x == 0) return x;
    if (x < 0) return -accurate_cbrt(-x);
    if (x < 0x1p-600) return accurate_cbrt(x * 0x1p+600) * 0x1p-200;  // keeps both parts of a pair normal
    const double y = exp_wide<double>(log_wide<double>(x) / 3);
    const DoublePair square = two_product(y, y);
    const DoublePair rest = exactly(x) - exactly(y) * square;
    return two_sum(y, rest.high / (3 * square.high)).high;
}

// log(m) of the nearest float m of the fraction, plus log(fraction / m).
double accurate_log(double x) {
    const DefaultFpEnvironment guard;
    if (!(x > 0)) return x == 0 ? -infinity : not_a_number;
    if (x == infinity) return x;
    const bool is_subnormal = x < 0x1p-1022;
    double fraction, exponent;
    exact_detail::reduce_log<double>(is_subnormal ? x * 0x1p54 : x, fraction, exponent);
    fraction += 1;  // exact
    if (is_subnormal) exponent -= 54;
    const double near = narrow(fraction);
    const DoublePair off = ratio(exactly(fraction - near), exactly(near));
    const DoublePair ln2 = {exact_detail::ln2_high, exact_detail::ln2_low};
    return (exactly(exponent) * ln2 + (exact_detail::log_pair<double>(near) + log_next_to_one(off))).high;
}

}  // namespace tandem

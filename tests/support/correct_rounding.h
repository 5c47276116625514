/// The correctly rounded float value of a function: from the C library's double function where that decides, else from
/// MPFR. The error of the library is below 2^-51, so a value that is not within 2^-50 of the midpoint between two
/// floats is rounded like the exact one.
#pragma once

#include <mpfr.h>

#include <cmath>

#include "tandem/math/exact_math.h"

namespace tandem::test {

/// A function of one or two arguments, in both references and in ours. `second` is unused if there is only one.
struct Function {
    const char* name;
    float (*ours)(float first, float second);
    double (*fast)(double first, double second);
    int (*mpfr)(mpfr_t result, mpfr_srcptr first, mpfr_srcptr second);
};

inline const Function functions[] = {
    {"sin", [](float x, float) { return exact_sin(x); }, [](double x, double) { return std::sin(x); },
     [](mpfr_t r, mpfr_srcptr x, mpfr_srcptr) { return mpfr_sin(r, x, MPFR_RNDN); }},
    {"cos", [](float x, float) { return exact_cos(x); }, [](double x, double) { return std::cos(x); },
     [](mpfr_t r, mpfr_srcptr x, mpfr_srcptr) { return mpfr_cos(r, x, MPFR_RNDN); }},
    {"exp", [](float x, float) { return exact_exp(x); }, [](double x, double) { return std::exp(x); },
     [](mpfr_t r, mpfr_srcptr x, mpfr_srcptr) { return mpfr_exp(r, x, MPFR_RNDN); }},
    {"log", [](float x, float) { return exact_log(x); }, [](double x, double) { return std::log(x); },
     [](mpfr_t r, mpfr_srcptr x, mpfr_srcptr) { return mpfr_log(r, x, MPFR_RNDN); }},
    {"pow", [](float x, float y) { return exact_pow(x, y); }, [](double x, double y) { return std::pow(x, y); },
     [](mpfr_t r, mpfr_srcptr x, mpfr_srcptr y) { return mpfr_pow(r, x, y, MPFR_RNDN); }},
};

/// A function's reference values, one thread each.
class CorrectRounding {
  public:
    explicit CorrectRounding(const Function& function) : function_(function) {
        mpfr_inits2(24, first_, second_, static_cast<mpfr_ptr>(nullptr));
        mpfr_inits2(300, exact_, distance_, static_cast<mpfr_ptr>(nullptr));
    }
    ~CorrectRounding() { mpfr_clears(first_, second_, exact_, distance_, static_cast<mpfr_ptr>(nullptr)); }
    CorrectRounding(const CorrectRounding&) = delete;
    CorrectRounding& operator=(const CorrectRounding&) = delete;

    float operator()(float x, float y = 0) {
        const double value = function_.fast(x, y);
        const auto below = static_cast<float>(value * (1 - 0x1p-50));
        const auto above = static_cast<float>(value * (1 + 0x1p-50));
        if (below == above || std::isnan(value)) return below;
        return from_mpfr(x, y);
    }

    /// From MPFR only; keeps the exact value for hardness().
    float from_mpfr(float x, float y = 0) {
        ++mpfr_calls;
        mpfr_set_flt(first_, x, MPFR_RNDN);
        mpfr_set_flt(second_, y, MPFR_RNDN);
        function_.mpfr(exact_, first_, second_);
        return mpfr_get_flt(exact_, MPFR_RNDN);
    }

    /// The relative distance of the last value from the nearest midpoint of two floats; 1 for exact midpoints and for
    /// values that are not finite normal floats.
    double hardness() {
        const float nearest = mpfr_get_flt(exact_, MPFR_RNDN);
        if (!std::isnormal(nearest)) return 1;
        double least = 1;
        for (const float neighbour : {std::nextafter(nearest, 0.0F), std::nextafter(nearest, nearest * HUGE_VALF)}) {
            mpfr_sub_d(distance_, exact_, 0.5 * (static_cast<double>(nearest) + static_cast<double>(neighbour)),
                       MPFR_RNDN);
            mpfr_div(distance_, distance_, exact_, MPFR_RNDN);
            const double d = std::fabs(mpfr_get_d(distance_, MPFR_RNDN));
            if (d != 0 && d < least) least = d;
        }
        return least;
    }

    long mpfr_calls = 0;

  private:
    const Function& function_;
    mpfr_t first_, second_, exact_, distance_;
};

/// Equal bits, or both NaN, where ours must be the quiet NaN 0x7FC00000.
inline bool agrees(float ours, float reference) {
    if (std::isnan(reference)) return bits_of(ours) == 0x7FC00000U;
    return bits_of(ours) == bits_of(reference);
}

}  // namespace tandem::test

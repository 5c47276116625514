/// GGX as the papers write it, in long double: B. Walter et al., EGSR 2007, (33) and (34); E. Heitz, JCGT 3(2), 2014,
/// (72), (85), (99). Tangents and angles; no formula is that of the code under test.
#pragma once

#include <cmath>

#include "tandem/math/vec.h"

namespace tandem::test {

using LongVector = Vec3<long double>;

inline LongVector long_vector(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline LongVector unit(const LongVector& v) {
    const long double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / length, v.y / length, v.z / length};
}

/// Our number over the textbook's.
inline double ratio(double ours, long double textbook) { return static_cast<double>(ours / textbook); }

struct TextbookGgx {
    long double alpha_x, alpha_y;

    [[nodiscard]] long double density(const LongVector& direction) const {
        const LongVector h = unit(direction);
        const long double tangent2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
        const long double angle = std::atan2(h.y, h.x);
        const long double spread =
            std::pow(std::cos(angle) / alpha_x, 2.0L) + std::pow(std::sin(angle) / alpha_y, 2.0L);
        const long double cosine4 = std::pow(h.z, 4.0L);
        const long double pi = std::acos(-1.0L);
        return 1 / (pi * alpha_x * alpha_y * cosine4 * std::pow(1 + tangent2 * spread, 2.0L));
    }
    [[nodiscard]] long double lambda(const LongVector& direction) const {
        const LongVector w = unit(direction);
        const long double tangent2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        const long double angle = std::atan2(w.y, w.x);
        const long double alpha2 =
            std::pow(std::cos(angle) * alpha_x, 2.0L) + std::pow(std::sin(angle) * alpha_y, 2.0L);
        return (std::sqrt(1 + alpha2 * tangent2) - 1) / 2;
    }
    [[nodiscard]] long double masking(const LongVector& w) const { return 1 / (1 + lambda(w)); }

    /// D G2 / (4 cos cos), height-correlated.
    [[nodiscard]] long double reflection(const LongVector& wo, const LongVector& wi) const {
        const long double seen_from_both = 1 / (1 + lambda(wo) + lambda(wi));
        return density(wo + wi) * seen_from_both / (4 * unit(wo).z * unit(wi).z);
    }
    /// Of wi, if it is drawn by the normals that wo sees.
    [[nodiscard]] long double pdf(const LongVector& wo, const LongVector& wi) const {
        return masking(wo) * density(wo + wi) / (4 * unit(wo).z);
    }
};

}  // namespace tandem::test

/// Each lobe with parameters, for the tests of all lobes. A new lobe gets its make() and, unless it is specular, its
/// LobeExamples here. Also compiled by nvcc and for each instruction set, so all is in an unnamed namespace.
#pragma once

#include "tandem/kernel/bsdf/lobes.h"

namespace tandem::test {
namespace {

/// What lobes are made of. The meaning of `roughness` is the lobe's: from 0 to 1 in packets, any in LobeExamples.
template <class Real>
struct LobeParameters {
    using D = Double<Real>;
    Vec3<Real> colour;
    D roughness[2], eta;
};

template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, Mirror<Real>& lobe) {
    lobe = {n.colour};
}
template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, Lambert<Real>& lobe) {
    lobe = {n.colour};
}
template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, Dielectric<Real>& lobe) {
    lobe = {n.colour.x, n.eta};
}
template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, CoatedDiffuse<Real>& lobe) {
    lobe = {{n.colour}, to_real<Real>(n.roughness[0])};
}
template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, PhongLobe<Real>& lobe) {
    lobe = {n.colour, to_real<Real>(n.roughness[0] * Double<Real>(1000.0))};
}
template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, GgxReflection<Real>& lobe) {
    lobe = {n.colour, Real(1.0F), Ggx<Real>(n.roughness[0], n.roughness[1])};
}

template <class Real>
TANDEM_HD void make(const LobeParameters<Real>& n, SheenLobe<Real>& lobe) {
    lobe = {n.colour, to_real<Real>(n.roughness[0])};
}

/// How narrow a lobe is, so that integrals over it are fine where it is: by the slopes of microfacets in x and y, or by
/// 1 - cos of the angle around the mirror direction.
struct LobeSpread {
    bool of_slopes;
    double x, y;
};
inline constexpr LobeSpread all_around = {false, 1e3, 1e3};

/// What all_lobes_test.cpp tries of a lobe that is not specular: pairs of `roughness`, and
///
/// spread(roughness)       how narrow it is then
/// most_albedo(roughness)  the most that a white one reflects, by its contract
/// most_weight(roughness)  the most of a sample's weight
/// is_reciprocal           whether f is, or f |cos|
template <template <class> class Lobe>
struct LobeExamples;

struct OrdinaryLobe {
    static constexpr bool is_reciprocal = true;
    static double most_albedo(const double*) { return 1; }
    static double most_weight(const double*) { return 1; }
};

template <>
struct LobeExamples<Lambert> : OrdinaryLobe {
    static constexpr double roughness[][2] = {{0, 0}};
    static LobeSpread spread(const double*) { return all_around; }
};
template <>
struct LobeExamples<CoatedDiffuse> : OrdinaryLobe {
    static constexpr double roughness[][2] = {{0.04, 0}, {0.3, 0}};
    static LobeSpread spread(const double*) { return all_around; }
};
template <>
struct LobeExamples<SheenLobe> : OrdinaryLobe {
    static constexpr double roughness[][2] = {{0, 0}, {0.2, 0}, {0.5, 0}, {1, 0}};
    static LobeSpread spread(const double*) { return all_around; }
    static double most_albedo(const double* r) { return r[0] == 0 ? 1.95 : r[0] == 0.2 ? 1.15 : 0.95; }
    static double most_weight(const double* r) { return r[0] == 0 ? 260 : r[0] == 0.2 ? 75 : 25; }
};
template <>
struct LobeExamples<PhongLobe> : OrdinaryLobe {
    static constexpr double roughness[][2] = {{0, 0}, {0.001, 0}, {0.032, 0}, {10, 0}, {1000, 0}};
    static constexpr bool is_reciprocal = false;
    static double most_albedo(const double* n) { return n[0] == 0 ? 2 : 1; }
    static double most_weight(const double* n) { return n[0] == 0 ? 2 : 1; }
    static LobeSpread spread(const double* n) {
        const double width = 1 / (1 + 1000 * n[0]);
        return {false, width, width};
    }
};
template <>
struct LobeExamples<GgxReflection> : OrdinaryLobe {
    static constexpr double roughness[][2] = {{0, 0},     {0.001, 0.001}, {0.01, 0.01}, {0.1, 0.1},  {0.3, 0.3},
                                              {0.6, 0.6}, {1, 1},         {0, 1},       {0.05, 0.5}, {1, 0.1}};
    static LobeSpread spread(const double* alpha) {
        const Ggx<double> facets(alpha[0], alpha[1]);  // the least alpha is above 0
        return {true, facets.alpha_x, facets.alpha_y};
    }
};

}  // namespace
}  // namespace tandem::test

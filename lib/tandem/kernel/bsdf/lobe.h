/// The interface of lobes, the terms of a surface's BSDF.
///
/// A lobe works in the local shading frame: z is the shading normal, x and y the tangent and bitangent. `wo` points to
/// the viewer and `wi` to the light; both are unit vectors away from the surface. The caller orients the frame so that
/// the viewer is above, wo.z > 0: from below a lobe is black. The struct holds the parameters of the surface at one
/// point, per lane. lobes.def lists the lobes.
#pragma once

#include <concepts>

#include "tandem/math/vec.h"

namespace tandem {

/// The kind of a lobe: one or both of the first two, and one of the last three.
enum class LobeFlags : std::uint32_t {
    reflection = 1,    ///< light may leave on the side that it came from
    transmission = 2,  ///< light may leave on the other side
    diffuse = 4,       ///< in all directions
    glossy = 8,        ///< around a direction, however narrowly
    specular = 16,     ///< in single directions: f is a Dirac delta function
};

TANDEM_HD_INLINE constexpr LobeFlags operator|(LobeFlags a, LobeFlags b) {
    return static_cast<LobeFlags>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// Whether `lobe` has all of `flags`.
TANDEM_HD_INLINE constexpr bool has(LobeFlags lobe, LobeFlags flags) {
    return (static_cast<std::uint32_t>(lobe) & static_cast<std::uint32_t>(flags)) == static_cast<std::uint32_t>(flags);
}

/// A direction sampled from a lobe.
template <class Real>
struct LobeSample {
    Vec3<Double<Real>> wi;  ///< unit, local; use only where `valid`
    Double<Real> pdf;       ///< with respect to solid angle, 1/sr, > 0; infinite for a specular lobe, as in mis.h
    Vec3<Real> weight;      ///< f |cos| / pdf, RGB; for a specular lobe the fraction of the light. 0 where not `valid`
    Mask<Real> valid;       ///< false: there is no direction, the light is lost, and pdf is 0
    Mask<Real> transmits;   ///< wi goes through the surface; the sign of wi.z may differ by rounding

    /// The sample, made invalid in the other lanes.
    [[nodiscard]] TANDEM_HD_INLINE LobeSample only_where(const Mask<Real>& mask) const {
        const Real none(0.0F);
        return {wi, select(mask, pdf, Double<Real>(0.0F)), select(mask, weight, Vec3<Real>{none, none, none}),
                valid && mask, transmits && mask};
    }
};

/// Whether there is at least one side and exactly one of the other kinds.
TANDEM_HD_INLINE constexpr bool is_complete(LobeFlags flags) {
    const bool has_side = has(flags, LobeFlags::reflection) || has(flags, LobeFlags::transmission);
    const int kinds = has(flags, LobeFlags::diffuse) + has(flags, LobeFlags::glossy) + has(flags, LobeFlags::specular);
    return has_side && kinds == 1;
}

/// The members of a lobe:
///
/// flags          its LobeFlags, a constant
/// numbers        the number of random numbers that sample() reads, up to three; a constant
/// f(wo, wi)      the BSDF, RGB, 1/sr, without the cosine; finite. 0 for a specular lobe
/// pdf(wo, wi)    the density of wi from sample(wo), 1/sr. 0 for a specular lobe
/// sample(wo, u)  a direction; u: uniform numbers in [0, 1), of 24 bits or more
/// albedo(wo)     approximate albedo for light that leaves along wo, RGB, to choose a lobe. Above 0 where the albedo is
/// colour()       its nominal albedo, RGB, for the albedo plane (kernel/first_hit.h)
/// scatters()     the lanes in which it may be other than black; L{} is black
/// select(mask, a, b)  `a` in the lanes of `mask`, else `b`
///
/// Where wo is below the surface, f and pdf are 0 and samples are not valid; for a lobe that only reflects, also where
/// wi is below. wo.z = 0 counts as above for specular lobes, as below for others. albedo() is called above the surface
/// only.
template <class L, class Real>
concept Lobe = requires(const L& lobe, const Vec3<Double<Real>>& w) {
    requires std::same_as<decltype(L::flags), const LobeFlags>;
    requires is_complete(L::flags);
    requires std::same_as<decltype(L::numbers), const int>;
    requires L::numbers >= 0 && L::numbers <= 3;
    { lobe.f(w, w) } -> std::same_as<Vec3<Real>>;
    { lobe.pdf(w, w) } -> std::same_as<Double<Real>>;
    { lobe.sample(w, w) } -> std::same_as<LobeSample<Real>>;
    { lobe.albedo(w) } -> std::same_as<Vec3<Real>>;
    { lobe.colour() } -> std::same_as<Vec3<Real>>;
    { lobe.scatters() } -> std::same_as<Mask<Real>>;
    { select(Mask<Real>(true), lobe, L{}) } -> std::same_as<L>;
};

/// The normals of a surface in the path loop: unit vectors in world space, on the side of the viewer.
template <class Real>
struct LobeNormals {
    Vec3<Double<Real>> shading;
    Vec3<Double<Real>> geometric;
};

/// A lobe that needs no tangent may have functions in world space, which save the transforms to the local frame and
/// back with their rounding. The path loop then uses only these. Directions are unit vectors.
///
/// sample_about(normals, wo, u)   as sample(). Where the shading normal leads to the wrong side of the surface, a
///                                specular lobe uses the geometric one.
template <class L, class Real>
concept SampledInWorld = requires(const L& lobe, const Vec3<Double<Real>>& w, const LobeNormals<Real>& normals) {
    { lobe.sample_about(normals, w, w) } -> std::same_as<LobeSample<Real>>;
};

/// reflected_about(share, normal, wi, wo)   pi f |cos| share, RGB. The normal is the outward one; directions may be
///                                below the surface, since the formula alone decides.
/// pdf_about(normal, wi)          for lobes that paths follow: as pdf(), for a viewer above the surface
template <class L, class Real>
concept ReflectsInWorld = requires(const L& lobe, const Vec3<Double<Real>>& w, Real share) {
    { lobe.reflected_about(share, w, w, w) } -> std::same_as<Vec3<Real>>;
};

/// Whether both directions are above the surface. Otherwise a lobe that only reflects, and is not specular, is black.
template <class Real>
TANDEM_HD_INLINE Mask<Real> both_above(const Vec3<Double<Real>>& wo, const Vec3<Double<Real>>& wi) {
    const Double<Real> zero(0.0F);
    return wo.z > zero && wi.z > zero;
}

/// No light.
template <class Real>
TANDEM_HD_INLINE Vec3<Real> black() {
    return {Real(0.0F), Real(0.0F), Real(0.0F)};
}

/// All light.
template <class Real>
TANDEM_HD_INLINE Vec3<Real> white() {
    return {Real(1.0F), Real(1.0F), Real(1.0F)};
}

/// The density of a Dirac delta function.
inline constexpr double infinite_density = __builtin_huge_val();

/// The normal in its own frame.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> local_normal() {
    using D = Double<Real>;
    return {D(0.0F), D(0.0F), D(1.0F)};
}

/// The least cosine that f is divided by, so that it stays finite.
template <class Real>
TANDEM_HD_INLINE Double<Real> bounded_divisor(const Double<Real>& cosine) {
    return greater(cosine, Double<Real>(0x1p-60F));
}

}  // namespace tandem

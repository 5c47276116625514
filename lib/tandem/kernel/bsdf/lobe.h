/// The interface of the lobes that a surface's BSDF is a sum of.
///
/// A lobe works in the local shading frame: z is the shading normal, x and y the tangent and bitangent. `wo` points to
/// the viewer and `wi` to where light comes from; both are unit vectors that leave the surface. The caller turns the
/// frame so that the viewer is on its upper side, wo.z > 0: below it a lobe is black. The struct holds what the surface
/// says at one point, per lane. Lobes are listed in lobes.def.
#pragma once

#include <concepts>

#include "tandem/math/vec.h"

namespace tandem {

/// What kind of lobe it is: one of the first two or both, and one of the last three.
enum class LobeFlags : std::uint32_t {
    reflection = 1,    ///< light may leave on the side that it came from
    transmission = 2,  ///< light may leave on the other side
    diffuse = 4,       ///< in all directions
    glossy = 8,        ///< in a bundle of directions, as narrow as it may be
    specular = 16,     ///< in single directions: f is a Dirac delta
};

TANDEM_HD constexpr LobeFlags operator|(LobeFlags a, LobeFlags b) {
    return static_cast<LobeFlags>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// Are all of `flags` among those of `lobe`?
TANDEM_HD constexpr bool has(LobeFlags lobe, LobeFlags flags) {
    return (static_cast<std::uint32_t>(lobe) & static_cast<std::uint32_t>(flags)) == static_cast<std::uint32_t>(flags);
}

/// A direction that a lobe has drawn.
template <class Real>
struct LobeSample {
    Vec3<Double<Real>> wi;  ///< unit, local; to be used where `valid`
    Double<Real> pdf;       ///< with respect to solid angle, 1/sr, > 0; infinite for a specular lobe, as mis.h has it
    Vec3<Real> weight;      ///< f |cos| / pdf, RGB; for a specular lobe the share of the light. 0 where not `valid`
    Mask<Real> valid;       ///< Else nothing was drawn: the light is lost, and pdf is 0.
    Mask<Real> transmits;   ///< wi goes through the surface. Rounding may decide the sign of wi.z next to it.

    /// Nothing is drawn in the other lanes.
    [[nodiscard]] TANDEM_HD LobeSample only_where(const Mask<Real>& mask) const {
        const Real none(0.0F);
        return {wi, select(mask, pdf, Double<Real>(0.0F)), select(mask, weight, Vec3<Real>{none, none, none}),
                valid && mask, transmits && mask};
    }
};

/// Is a kind of light path said once, and at least one side?
TANDEM_HD constexpr bool is_complete(LobeFlags flags) {
    const bool has_side = has(flags, LobeFlags::reflection) || has(flags, LobeFlags::transmission);
    const int kinds = has(flags, LobeFlags::diffuse) + has(flags, LobeFlags::glossy) + has(flags, LobeFlags::specular);
    return has_side && kinds == 1;
}

/// What a lobe has:
///
/// flags          its kind, a constant
/// numbers        how many of the three random numbers sample() reads, the first ones; a constant
/// f(wo, wi)      the BSDF, RGB, 1/sr, without the cosine; finite. 0 for a specular lobe
/// pdf(wo, wi)    the density with which sample(wo) draws wi, 1/sr. 0 for a specular lobe
/// sample(wo, u)  a direction; u: uniform numbers in [0, 1), of 24 bits or more
/// albedo(wo)     about the share of the light from everywhere that leaves along wo, RGB: to choose a lobe by. Above 0
///                wherever the share is.
///
/// f and pdf are 0, and nothing is drawn, where wo is below the surface; of a lobe that only reflects also where wi is.
/// A specular lobe takes wo.z = 0, any other does not. albedo() is asked above the surface alone.
/// colour()       what a viewer would call its colour, RGB: for the plane of albedos (kernel/first_hit.h)
/// L{} is a lobe of no light; scatters() says in which lanes there may be some.
/// select(mask, a, b) is `a` in the lanes of `mask`, else `b`.
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

/// A lobe that needs no tangent may have forms in world space. They save the way to the local frame and back, and its
/// rounding; the path loop then uses these alone. The directions are unit vectors.
///
/// sample_about(normals, wo, u)   as sample(). Where the shading normal leads to the wrong side of the surface, a
///                                specular lobe uses the geometric one.
template <class L, class Real>
concept SampledInWorld = requires(const L& lobe, const Vec3<Double<Real>>& w, const LobeNormals<Real>& normals) {
    { lobe.sample_about(normals, w, w) } -> std::same_as<LobeSample<Real>>;
};

/// reflected_about(share, normal, wi, wo)   pi f |cos| share, RGB. The normal is the outward one, and no direction need
///                                be above the surface: the formula alone decides.
/// pdf_about(normal, wi)          of one that paths follow: as pdf(), of a viewer above the surface
template <class L, class Real>
concept ReflectsInWorld = requires(const L& lobe, const Vec3<Double<Real>>& w, Real share) {
    { lobe.reflected_about(share, w, w, w) } -> std::same_as<Vec3<Real>>;
};

/// Are both directions above the surface? Only then does a lobe that reflects, and is not specular, scatter.
template <class Real>
TANDEM_HD Mask<Real> both_above(const Vec3<Double<Real>>& wo, const Vec3<Double<Real>>& wi) {
    const Double<Real> zero(0.0F);
    return wo.z > zero && wi.z > zero;
}

/// No light.
template <class Real>
TANDEM_HD Vec3<Real> black() {
    return {Real(0.0F), Real(0.0F), Real(0.0F)};
}

/// All light.
template <class Real>
TANDEM_HD Vec3<Real> white() {
    return {Real(1.0F), Real(1.0F), Real(1.0F)};
}

/// The density of a direction that is the only one: Dirac's delta.
inline constexpr double infinite_density = __builtin_huge_val();

/// The normal in its own frame.
template <class Real>
TANDEM_HD Vec3<Double<Real>> local_normal() {
    using D = Double<Real>;
    return {D(0.0F), D(0.0F), D(1.0F)};
}

/// The least cosine that f is divided by, so that it stays finite.
template <class Real>
TANDEM_HD Double<Real> bounded_divisor(const Double<Real>& cosine) {
    return greater(cosine, Double<Real>(0x1p-60F));
}

}  // namespace tandem

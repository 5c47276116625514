/// The media along a path, their absorption, and their interfaces. A medium is identified by the material of the solid
/// that it fills; no_medium is outside of all solids.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/kernel/media/medium_stack.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fast_math.h"

namespace tandem {

template <class Real>
TANDEM_HD_INLINE Double<Real> refractive_index(const SceneView& scene, const UInt<Real>& medium,
                                               const Mask<Real>& active) {
    using D = Double<Real>;
    D result(1.0);
    for_each_unique_lane(medium, active && medium != UInt<Real>(no_medium),
                         [&](std::uint32_t material, const Mask<Real>& here) {
                             result = select(here, D(scene.optics[material].ior), result);
                         });
    return result;
}

/// exp(-depth). Out of line, so that the three calls need the registers and the code of one.
template <class Real>
TANDEM_HD_CALL Real attenuation(Double<Real> depth) {
    return to_real<Real>(exponential<Real>(-depth));
}

/// The transmittance of `distance` metres of a medium: exp(-absorption distance). Source: A. Beer, 1852. Tested by
/// tests/agree/closed_forms_test.cpp, within 1e-7.
template <class Real>
TANDEM_HD_INLINE Vec3<Real> transmittance(const SceneView& scene, const UInt<Real>& medium,
                                          const Double<Real>& distance, const Mask<Real>& active) {
    using D = Double<Real>;
    const Real one(1.0F);
    Vec3<Real> result = {one, one, one};
    for_each_unique_lane(medium, active && medium != UInt<Real>(no_medium),
                         [&](std::uint32_t material, const Mask<Real>& here) {
                             const Vec3f& absorption = scene.optics[material].absorption;
                             const auto channel = [&](float a, const Real& before) {
                                 if (!(a > 0.0F)) return before;  // also for an infinite distance
                                 return select(here, attenuation<Real>(D(a) * distance), before);
                             };
                             result = {channel(absorption.x, result.x), channel(absorption.y, result.y),
                                       channel(absorption.z, result.z)};
                         });
    return result;
}

/// Replaces the stack where dielectric solids are disjoint: there a ray inside a solid hits only this solid.
template <class Real>
struct NoMediumStack {
    TANDEM_HD_INLINE std::tuple<> per_lane() { return {}; }
    TANDEM_HD_INLINE friend NoMediumStack select(const Mask<Real>&, const NoMediumStack& a, const NoMediumStack&) {
        return a;
    }
};

/// Whether media may be nested, so that paths track them with the stack.
template <class Effects>
TANDEM_HD_INLINE bool has_stack(const SceneView& scene) {
    return Effects::has(Effect::nested_media) && scene.media_overlap != 0;
}

/// The media at the camera.
template <class Effects, class Real>
TANDEM_HD_INLINE NoMediumStack<Real> media_at_camera(const SceneView&, const NoMediumStack<Real>&) {
    return {};
}
template <class Effects, class Real>
TANDEM_HD_INLINE MediumStack<Real> media_at_camera(const SceneView& scene, const MediumStack<Real>&) {
    MediumStack<Real> stack;
    if (!has_stack<Effects>(scene)) return stack;
    for (std::uint32_t i = 0; i < scene.camera_media.count; ++i) {
        const std::uint32_t material = scene.camera_media.material[i];
        (void)stack.enter(UInt<Real>(material), UInt<Real>(scene.optics[material].priority), Mask<Real>(true));
    }
    return stack;
}

/// The medium that a path is in. `own`: the medium if solids are disjoint.
template <class Effects, class Real>
TANDEM_HD_INLINE UInt<Real> current_medium(const SceneView&, const NoMediumStack<Real>&, const UInt<Real>& own) {
    return own;
}
template <class Effects, class Real>
TANDEM_HD_INLINE UInt<Real> current_medium(const SceneView& scene, const MediumStack<Real>& stack,
                                           const UInt<Real>& own) {
    return has_stack<Effects>(scene) ? stack.current() : own;
}

/// The media on both sides of an interface.
template <class Real>
struct Interface {
    UInt<Real> before, behind;
    Mask<Real> lost = Mask<Real>(false);  ///< the stack was full, or the path left a medium that it had not entered
};

// The interface of a solid of `material`, hit from inside or outside, in the lanes of `active`. Updates `stack` to the
// state beyond the interface.
template <class Effects, class Real>
TANDEM_HD_INLINE Interface<Real> cross_interface(const SceneView&, NoMediumStack<Real>&, const UInt<Real>& material,
                                                 const Mask<Real>& from_inside, const Mask<Real>&) {
    const UInt<Real> none(no_medium);
    return {select(from_inside, material, none), select(from_inside, none, material)};
}
template <class Effects, class Real>
TANDEM_HD_INLINE Interface<Real> cross_interface(const SceneView& scene, MediumStack<Real>& stack,
                                                 const UInt<Real>& material, const Mask<Real>& from_inside,
                                                 const Mask<Real>& active) {
    using Word = UInt<Real>;
    if (!has_stack<Effects>(scene)) {
        NoMediumStack<Real> none;
        return cross_interface<Effects>(scene, none, material, from_inside, active);
    }
    Interface<Real> interface;
    interface.before = stack.current();
    Word priority(0U);
    for_each_unique_lane(material, active, [&](std::uint32_t value, const Mask<Real>& here) {
        priority = select(here, Word(scene.optics[value].priority), priority);
    });
    const Mask<Real> no_room = stack.enter(material, priority, active && !from_inside);
    interface.lost = no_room || stack.leave(material, active && from_inside);
    interface.behind = stack.current();
    return interface;
}

}  // namespace tandem

/// The hits of shadow rays on primitives that may let them pass. Tested by tests/kernel/shadow_test.cpp
/// and, with packets, by tests/cpu/masked_hits_test.cpp.
#pragma once

#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/surface.h"

namespace tandem {

/// Decides what blocks shadow rays, one primitive after the other, in any order: alpha masks let a ray pass where they
/// are open, and culled faces from behind. `kinds`: the PrimitiveKinds that the scene may have.
template <std::uint32_t kinds, class Real>
class MaskedHits {
  public:
    /// The light that a ray is sent to (ShadowSource::light) blocks nothing.
    TANDEM_HD_INLINE MaskedHits(const SceneView& scene, const ShadowRay<Real>& shadow)
        : scene_(scene), shadow_(shadow) {}

    /// The lanes of `open` whose ray is blocked by primitive `id`, or has passed too many hits. Each primitive counts
    /// once.
    TANDEM_HD_INLINE Mask<Real> block(std::uint32_t id, Mask<Real> open) {
        PathSource<Real> source = {shadow_.source};
        Mask<Real> blocked(false);
        while (true) {
            Closest<Real> hit = {shadow_.t_max, UInt<Real>(no_primitive)};
            visit_primitive<kinds>(scene_, id, [&](const auto& primitive) {
                test_primitive(primitive, id, shadow_.ray, source, open, hit);
            });
            open = open && hit.t < shadow_.t_max;
            if (!any(open)) return blocked;
            const Mask<Real> passes =
                shadow_.source.light == UInt<Real>(id) || !is_opaque_at<kinds>(scene_, shadow_.ray, source, hit, open);
            passed_ = passed_ + select(open, UInt<Real>(1U), UInt<Real>(0U));
            const Mask<Real> stops = open && (!passes || passed_ >= UInt<Real>(max_masked_hits));
            blocked = blocked || stops;
            open = open && !stops;
            if (!any(open)) return blocked;
            source.last_masked.t = select(open, hit.t, source.last_masked.t);
            source.last_masked.primitive = select(open, hit.primitive, source.last_masked.primitive);
        }
    }

    /// Forgets all hits.
    TANDEM_HD_INLINE void begin_again() { passed_ = UInt<Real>(0U); }

  private:
    const SceneView& scene_;
    const ShadowRay<Real>& shadow_;
    UInt<Real> passed_ = UInt<Real>(0U);
};

}  // namespace tandem

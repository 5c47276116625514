/// Intersects a ray with one primitive of a scene, and with all of them.
#pragma once

#include "tandem/kernel/shapes/filter.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/whole.h"

namespace tandem {

/// Keeps the nearer of `best` and a hit at t, in the lanes of `hit`.
template <class Real>
TANDEM_HD_INLINE void keep_nearest(const Mask<Real>& hit, const Double<Real>& t, const UInt<Real>& primitive,
                                   Closest<Real>& best) {
    const Mask<Real> closer = hit && is_closer(t, primitive, best);
    best.t = select(closer, t, best.t);
    best.primitive = select(closer, primitive, best.primitive);
}

/// Keeps the nearer of `best` and the hit of a ray from `source` on the primitive, in the lanes of `candidate`, which
/// passed the filter. `From` is NoSource or one of the sources of ray_source.h.
template <class Real, class From, class Primitive>
TANDEM_HD_INLINE void test_primitive(const Primitive& primitive, std::uint32_t id, const Ray<Real>& ray,
                                     const From& source, const Mask<Real>& candidate, Closest<Real>& best) {
    Double<Real> t(0.0);
    Mask<Real> hit;
    const bool culls = may_be_cut_out(kind_of<Primitive>);
    if constexpr (std::is_same_v<From, PathSource<Real>>) {
        // rays pass only masked primitives and the light of a shadow ray; any other solid in front of the last masked
        // hit would have stopped the ray
        const bool is_passed = is_face<Primitive> || culls || may_emit_light(kind_of<Primitive>);
        const Source<Real>& surface = source;
        hit = is_passed ? first_hit_from(source, primitive, id, ray, candidate, best.t, t, culls)
                        : first_hit_from(surface, primitive, id, ray, candidate, best.t, t);
    } else if constexpr (std::is_same_v<From, CulledShadowSource<Real>>) {
        hit = first_hit_from(source, primitive, id, ray, candidate, best.t, t, culls);
    } else {
        hit = first_hit_from(source, primitive, id, ray, candidate, best.t, t);
    }
    keep_nearest<Real>(hit, t, UInt<Real>(id), best);
}

// The filter of each kind of primitive. A ray that leaves a surface passes the filter of its own primitive, because the
// error of its origin is less than the filter allows.
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch(const FilterRay<Real>& f, const Sphere& sphere) {
    return may_touch_sphere(f, sphere.centre, sphere.radius);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch(const FilterRay<Real>& f, const Box& box) {
    return may_touch_box(f, box.lower, box.upper);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch(const FilterRay<Real>& f, const Placement& body) {
    return may_touch(f, body.bounding_sphere);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch(const FilterRay<Real>& f, const Triangle& triangle) {
    return may_touch_triangle(f, triangle.v0, triangle.v1, triangle.v2);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch(const FilterRay<Real>& f, const Quad& quad) {
    return may_touch_quad(f, quad);
}

/// Whether a primitive is certainly behind a ray. False for kinds that do not test this, or whose may_touch() does.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_behind(const FilterRay<Real>& f, const Sphere& sphere) {
    return is_behind_sphere(f, sphere.centre, sphere.radius);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_behind(const FilterRay<Real>& f, const Placement& body) {
    return is_behind(f, body.bounding_sphere);
}
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> is_behind(const FilterRay<Real>&, const Primitive&) {
    return Mask<Real>(false);
}

/// Whether the filter pays. In the tier fast the decision costs hardly more than the filter, except for solids with a
/// transform.
template <class Real, class Primitive>
inline constexpr bool has_filter = !is_fast<Real> || std::is_base_of_v<Placement, Primitive>;

/// Intersects one primitive: first the float filter, then the decision.
template <class Real, class From, class Primitive>
TANDEM_HD_INLINE void intersect(const Primitive& primitive, std::uint32_t id, const FilterRay<Real>& f,
                                const From& source, const Mask<Real>& active, Closest<Real>& best) {
    if constexpr (!has_filter<Real, Primitive>) {
        test_primitive(primitive, id, f.ray, source, active, best);
    } else {
        const Mask<Real> candidate = active && may_touch(f, primitive);
        if (any(candidate)) test_primitive(primitive, id, f.ray, source, candidate, best);
    }
}

/// Intersects primitive `id`, of any kind. `kinds`: the kinds that the scene may have.
template <class Real, std::uint32_t kinds = PrimitiveKinds::all, class From>
TANDEM_HD_INLINE void intersect_primitive(const SceneView& scene, std::uint32_t id, const FilterRay<Real>& f,
                                          const From& source, const Mask<Real>& active, Closest<Real>& best) {
    const auto as_itself = [&](const auto& primitive) { intersect(primitive, id, f, source, active, best); };
    visit_primitive<kinds>(scene, id, as_itself);
}

/// The kind of search: the nearest hit, or any hit nearer than t_max.
enum class Search { nearest, any };

/// The initial hit of a search for any hit with t < t_max. No hit at t_max itself replaces it.
template <class Real>
TANDEM_HD_INLINE Closest<Real> closest_starting_at(const Double<Real>& t_max) {
    return {t_max, UInt<Real>(0U)};
}

/// Traces by testing every primitive: without an acceleration structure, best for few primitives. Rays must be
/// traceable (math/ray.h) in the lanes of `active`, for all tracers. `kind_set`: the PrimitiveKinds that the scene may
/// have; with fewer kinds a kernel needs fewer registers.
template <std::uint32_t kind_set>
struct LoopTracerFor {
    static constexpr std::uint32_t kinds = kind_set;
    static constexpr bool has_hierarchy = false;

    SceneView scene;

    /// The nearest hit of a ray from `source`, of any type that test_primitive() takes. Hits beyond `farthest` do not
    /// count; if there is no other, t is `farthest`.
    template <class Real, class From>
    TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const From& source, const Mask<Real>& active,
                                           const Double<Real>& farthest = no_hit<Real>().t) const {
        Closest<Real> best = {farthest, UInt<Real>(no_primitive)};
        find<Search::nearest>(ray, source, active, best);
        return best;
    }

    /// Whether the ray hits anything at t < t_max. The comparison is exact, in Double<Real>.
    template <class Real, class From>
    TANDEM_HD_INLINE Mask<Real> occluded(const Ray<Real>& ray, const Double<Real>& t_max, const From& source,
                                         const Mask<Real>& active) const {
        Closest<Real> best = closest_starting_at<Real>(t_max);
        find<Search::any>(ray, source, active, best);
        return active && best.t < t_max;
    }

  private:
    /// Those of the primitives from `first` to `end` that the ray may hit: a bit for each of up to 32.
    /// `first_id`: of primitives[0]. The source of the ray decides about few of them, so it is asked after the loop.
    template <class Real, class From, class Primitive>
    TANDEM_HD_INLINE std::uint32_t candidates_of(const FilterRay<Real>& f, const From& source, std::uint32_t first_id,
                                                 const Primitive* primitives, std::uint32_t first,
                                                 std::uint32_t end) const {
        std::uint32_t touched = 0, behind = 0;
        for (std::uint32_t i = first; i < end; ++i) {
            const Primitive& primitive = whole(primitives[i]);
            touched |= (may_touch(f, primitive) ? 1U : 0U) << (i - first);
            behind |= (is_behind(f, primitive) ? 1U : 0U) << (i - first);
        }
        std::uint32_t candidates = touched & ~behind;
        for_each_source(source, [&](std::uint32_t id) {
            const std::uint32_t bit = id - first_id - first;
            if (bit >= end - first) return;
            const std::uint32_t own = 1U << bit;
            candidates &= ~own;
            if (can_meet<Real, Primitive>(source, id, (behind & own) != 0)) candidates |= touched & own;
        });
        return candidates;
    }

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, const Mask<Real>& active,
                               Closest<Real>& best) const {
        if (!any(active)) return;
        const FilterRay<Real> f = make_filter_ray(ray);
        const Double<Real> t_max = best.t;
        std::uint32_t id = 0;
        const auto try_all = [&](const auto* primitives, std::uint32_t count) {
            using Primitive = std::decay_t<decltype(*primitives)>;
            if (search == Search::any && !any(active && !(best.t < t_max))) return;
            if constexpr (has_filter<Real, Primitive> && RealTraits<Real>::lanes == 1) {
                // first all filters, then the few decisions, so that the threads of a warp decide at the same time even
                // about different primitives
                for (std::uint32_t first = 0; first < count; first += 32) {
                    std::uint32_t candidates =
                        candidates_of(f, source, id, primitives, first, first + 32 < count ? first + 32 : count);
                    for (; candidates != 0; candidates &= candidates - 1) {
                        const std::uint32_t i = first + static_cast<std::uint32_t>(lowest_bit(candidates));
                        const Primitive& primitive = whole(primitives[i]);
                        test_primitive(primitive, id + i, ray, source, true, best);
                        if constexpr (search == Search::any) {
                            if (any(best.t < t_max)) return;  // clang compiles this for packets too
                        }
                    }
                }
            } else {
                for (std::uint32_t i = 0; i < count; ++i) {
                    Mask<Real> candidate = active;
                    if constexpr (search == Search::any) {
                        candidate = candidate && !(best.t < t_max);
                        if (!any(candidate)) return;
                    }
                    if constexpr (has_filter<Real, Primitive>) {
                        candidate = candidate &&
                                    can_meet<Real, Primitive>(source, id + i, is_behind(f, primitives[i])) &&
                                    may_touch(f, primitives[i]);
                    }
                    if (any(candidate)) test_primitive(primitives[i], id + i, ray, source, candidate, best);
                }
            }
            id += count;
        };
#define TANDEM_PRIMITIVE(Type, name, names)                                           \
    if constexpr ((kinds & PrimitiveKinds::name) != 0) {                              \
        if (may_have(PrimitiveKinds::name)) try_all(scene.names, scene.name##_count); \
    }
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    }
};
using LoopTracer = LoopTracerFor<PrimitiveKinds::all>;

}  // namespace tandem

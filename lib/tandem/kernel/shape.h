/// The interface of primitives (kernel/shapes). Every kernel checks the kinds of kernel/view/primitives.def against it
/// at compile time.
#pragma once

#include <concepts>

#include "tandem/kernel/area_lights.h"
#include "tandem/kernel/surface.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {

/// A plain struct with these functions. They are checked for single rays; packets use the same templates.
/// - bounds();
/// - may_touch(): the filter in float, which never rejects a hit;
/// - hit_interval(): where a ray may hit it, and whether it certainly does, in float, for tracers with deferred
///   decisions;
/// - first_hit(): the nearest hit in front of the ray's origin, decided in Double<Real>; for a solid also
///   first_hit_or_exit(), the hit of a ray that starts on it;
/// - record_hit(): the data about a hit that the next three need;
/// - surface_point(): the point there, and normal_at(), the shading normal;
/// - parametrisation(): texture coordinates and their derivatives;
/// - where is_light: view_light() and shines(), to sample it as an area light.
template <class Primitive, class Real>
concept KernelShape = std::is_trivially_copyable_v<Primitive> && std::is_standard_layout_v<Primitive> &&
    requires(const Primitive& primitive, const FilterRay<Real>& filter, const Ray<Real>& ray, const SceneView& scene,
             const Vec2f* texcoords, Double<Real> t, const Mask<Real>& mask, const HitRecord<Real>& record,
             const Vec3<Double<Real>>& v, const QueryRay& query) {
    { bounds(primitive) } -> std::same_as<Aabb>;
    { may_touch(filter, primitive) } -> std::same_as<Mask<Real>>;
    { hit_interval(query, primitive, true) } -> std::same_as<HitInterval>;
    { first_hit(primitive, ray, t, mask) } -> std::same_as<Mask<Real>>;
    requires is_face<Primitive> || requires {
        { first_hit_or_exit(primitive, ray, mask, mask, t) } -> std::same_as<Mask<Real>>;
    };
    { record_hit(primitive, ray, t, mask, mask) } -> std::same_as<HitRecord<Real>>;
    { surface_point(primitive, record, ray, t) } -> std::same_as<SurfacePoint<Real>>;
    { normal_at<Real>(scene, primitive, record, ray, t, mask) } -> std::same_as<Vec3<Double<Real>>>;
    { parametrisation(primitive, record, texcoords, ray, t, mask) } -> std::same_as<Parametrisation<Real>>;
    requires !is_light<Primitive> || requires {
        area_lights_detail::view_light<Real>(primitive, v, mask);
        { area_lights_detail::shines<Real>(primitive, v, v) } -> std::same_as<Mask<Real>>;
    };
};

#define TANDEM_PRIMITIVE(Type, name, names) static_assert(KernelShape<Type, float> && KernelShape<Type, double>);
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE

}  // namespace tandem

/// The quadrilateral as a light: the triangles (v0, v1, v2) and (v0, v2, v3), each sampled by its solid angle.
#pragma once

#include "tandem/kernel/lights/triangle_light.h"
#include "tandem/kernel/shapes/face_sides.h"

namespace tandem {

/// The properties of an emissive quad.
template <class Real>
struct QuadLightShape {
    Mask<Real> one_sided = Mask<Real>(false);  ///< the back does not emit
    Mask<Real> culled = Mask<Real>(false);     ///< and rays pass through it
    Mask<Real> overlaps = Mask<Real>(true);    ///< one half may occlude the other from some points
};
template <class Real>
TANDEM_HD QuadLightShape<Real> quad_light_shape(FaceSides sides, const Mask<Real>& overlaps) {
    return {Mask<Real>(sides != FaceSides::double_sided), Mask<Real>(sides == FaceSides::culled), overlaps};
}

template <class Real>
struct QuadLightView {
    TriangleLightView<Real> first;
    TriangleLightView<Real> second;
    Double<Real> solid_angle;      ///< sr: of the halves that emit towards the point
    Vec3<Double<Real>> corner[4];  ///< metres
    QuadLightShape<Real> shape;
};

/// Needs and gives: as view_triangle_light() of the halves. Each half emits from its own front, or from both sides. A
/// rectangle has a map of its own (C. Urena, M. Fajardo, A. King, "An Area-Preserving Parametrization for Spherical
/// Rectangles", EGSR 2013); two spherical triangles work for every quad, folded ones included. Everything here is
/// tested by tests/kernel/lights/quad_light_test.cpp and by the case M15 of the hard corpus.
template <class Real>
TANDEM_HD QuadLightView<Real> view_quad_light(const Vec3<Double<Real>>& point, const Vec3<Double<Real>>& v0,
                                              const Vec3<Double<Real>>& v1, const Vec3<Double<Real>>& v2,
                                              const Vec3<Double<Real>>& v3, const QuadLightShape<Real>& shape = {}) {
    using D = Double<Real>;
    QuadLightView<Real> view;
    view.first = view_triangle_light<Real>(point, v0, v1, v2);
    view.second = view_triangle_light<Real>(point, v0, v2, v3);
    if (any(shape.one_sided)) {
        const auto emitting = [&](const TriangleLightView<Real>& half) {
            return select(shape.one_sided && !half.shows_front, D(0.0F), half.solid_angle);
        };
        view.first.solid_angle = emitting(view.first);
        view.second.solid_angle = emitting(view.second);
    }
    view.solid_angle = view.first.solid_angle + view.second.solid_angle;
    view.corner[0] = v0;
    view.corner[1] = v1;
    view.corner[2] = v2;
    view.corner[3] = v3;
    view.shape = shape;
    return view;
}

namespace quad_light_detail {

/// One of two views in each lane.
template <class Real>
TANDEM_HD TriangleLightView<Real> choose(const Mask<Real>& mask, const TriangleLightView<Real>& a,
                                         const TriangleLightView<Real>& b) {
    return {select(mask, a.point, b.point),
            select(mask, a.unit, b.unit),
            select(mask, a.corner, b.corner),
            select(mask, a.edge1, b.edge1),
            select(mask, a.edge2, b.edge2),
            select(mask, a.volume, b.volume),
            select(mask, a.sine, b.sine),
            select(mask, a.cosine, b.cosine),
            select(mask, a.cotangent, b.cotangent),
            select(mask, a.cross2, b.cross2),
            select(mask, a.solid_angle, b.solid_angle),
            select(mask, a.shows_front, b.shows_front)};
}

/// The probability of one half.
template <class Real>
TANDEM_HD Double<Real> share(const QuadLightView<Real>& view, const TriangleLightView<Real>& half) {
    using D = Double<Real>;
    return half.solid_angle / select(view.solid_angle > D(0.0F), view.solid_angle, D(1.0F));
}

/// Distances whose relative difference is below this belong to the same point, on the diagonal or where the halves
/// coincide. There rays hit the first half.
template <class Real>
inline constexpr double same_distance = is_fast<Real> ? 0x1p-16 : 0x1p-40;

/// Whether a half blocks rays from the point. A culled back does not.
template <class Real>
TANDEM_HD Mask<Real> blocks_rays(const QuadLightView<Real>& view, const TriangleLightView<Real>& half) {
    return !view.shape.culled || half.shows_front;
}

/// Whether the other half occludes a point of one half at `distance`, metres. On the diagonal neither half occludes the
/// other. Computes the view of the other half again, so that a sample needs one view at a time. Keeping both takes
/// equally long (`whitted.gltf` on an H200, variants in turns).
template <class Real>
TANDEM_HD Mask<Real> is_hidden(const QuadLightView<Real>& view, const Vec3<Double<Real>>& direction,
                               const Double<Real>& distance, const Mask<Real>& other_is_first) {
    using D = Double<Real>;
    const TriangleLightView<Real> other = view_triangle_light<Real>(
        view.first.point, view.corner[0], select(other_is_first, view.corner[1], view.corner[2]),
        select(other_is_first, view.corner[2], view.corner[3]));
    const TriangleLightHit<Real> hit = find_on_light(other, direction, direction_slack<Real>);
    const D slack = constant<D>(same_distance<Real>);
    const D reach = distance * select(other_is_first, D(1.0F) + slack, D(1.0F) - slack);
    return hit.meets && blocks_rays(view, other) && hit.distance * other.unit < reach;
}

}  // namespace quad_light_detail

/// Uniform among the directions of both halves that emit towards the point: u chooses a half in proportion to its solid
/// angle and is rescaled to [0, 1]. The density is 0 where the other half occludes the sampled point.
template <class Real>
TANDEM_HD LightSample<Real> sample_light(const QuadLightView<Real>& view, const Double<Real>& u,
                                         const Double<Real>& v) {
    using D = Double<Real>;
    const D one(1.0F);
    const D target = u * view.solid_angle;
    const Mask<Real> is_first = target < view.first.solid_angle;
    const TriangleLightView<Real> half = quad_light_detail::choose<Real>(is_first, view.first, view.second);
    const D rest = select(is_first, target, target - view.first.solid_angle);
    const D stretched = lesser(rest / select(half.solid_angle > D(0.0F), half.solid_angle, one), one);
    LightSample<Real> sample = sample_light(half, stretched, v);
    sample.pdf = sample.pdf * quad_light_detail::share(view, half);
    sample.in_second_half = !is_first;
    if (any(view.shape.overlaps)) {
        const Mask<Real> hidden =
            view.shape.overlaps && quad_light_detail::is_hidden(view, sample.direction, sample.distance, !is_first);
        sample.pdf = select(hidden, D(0.0F), sample.pdf);
    }
    return sample;
}

/// Density of sample_light() for a unit direction: that of the half that is visible there, on the diagonal the first
/// one; 0 beside the quad.
template <class Real>
TANDEM_HD Double<Real> pdf_of(const QuadLightView<Real>& view, const Vec3<Double<Real>>& direction) {
    using D = Double<Real>;
    const TriangleLightHit<Real> first = find_on_light(view.first, direction, -direction_slack<Real>);
    const TriangleLightHit<Real> second = find_on_light(view.second, direction, -direction_slack<Real>);
    const D reach = first.distance * view.first.unit * (D(1.0F) - constant<D>(quad_light_detail::same_distance<Real>));
    const Mask<Real> is_nearer =
        quad_light_detail::blocks_rays(view, view.second) && second.distance * view.second.unit < reach;
    const Mask<Real> in_second =
        second.meets && (!first.meets || is_nearer || !quad_light_detail::blocks_rays(view, view.first));
    const D of_first =
        triangle_light_detail::density(view.first, first.distance) * quad_light_detail::share(view, view.first);
    const D of_second =
        triangle_light_detail::density(view.second, second.distance) * quad_light_detail::share(view, view.second);
    return select(in_second, of_second, select(first.meets, of_first, D(0.0F)));
}

}  // namespace tandem

/// The quadrilateral as a light: the triangles (v0, v1, v2) and (v0, v2, v3), each sampled by its solid angle.
#pragma once

#include "tandem/light/triangle_light.h"

namespace tandem {

template <class Real>
struct QuadLightView {
    TriangleLightView<Real> first;
    TriangleLightView<Real> second;
    Double<Real> solid_angle;  ///< sr: of both; folded halves that hide each other count twice
};

/// Needs and gives: as view_triangle_light() of the halves. A rectangle has a map of its own (C. Urena, M. Fajardo,
/// A. King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013); two spherical triangles do for
/// every quad, and for one whose corners are not in a plane too.
/// Held by tests/unit/light/quad_light_test.cpp, also of all below.
template <class Real>
TANDEM_HD QuadLightView<Real> view_quad_light(const Vec3<Double<Real>>& point, const Vec3<Double<Real>>& v0,
                                              const Vec3<Double<Real>>& v1, const Vec3<Double<Real>>& v2,
                                              const Vec3<Double<Real>>& v3) {
    QuadLightView<Real> view;
    view.first = view_triangle_light<Real>(point, v0, v1, v2);
    view.second = view_triangle_light<Real>(point, v0, v2, v3);
    view.solid_angle = view.first.solid_angle + view.second.solid_angle;
    return view;
}

namespace quad_light_detail {

/// Lane by lane one of two views.
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
            select(mask, a.solid_angle, b.solid_angle)};
}

/// Probability of one half.
template <class Real>
TANDEM_HD Double<Real> share(const QuadLightView<Real>& view, const TriangleLightView<Real>& half) {
    using D = Double<Real>;
    return half.solid_angle / select(view.solid_angle > D(0.0F), view.solid_angle, D(1.0F));
}

}  // namespace quad_light_detail

/// Uniform among the directions that meet the quad: u chooses a half in proportion to its solid angle and is stretched
/// again to [0, 1].
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
    return sample;
}

/// Density of sample_light() for a unit direction: 0 beside the quad. On the diagonal it is that of the first half.
template <class Real>
TANDEM_HD Double<Real> pdf_of(const QuadLightView<Real>& view, const Vec3<Double<Real>>& direction) {
    using D = Double<Real>;
    const D first = pdf_of(view.first, direction);
    const D second = pdf_of(view.second, direction);
    const Mask<Real> is_first = first > D(0.0F);
    const D share_first = quad_light_detail::share(view, view.first);
    const D share_second = quad_light_detail::share(view, view.second);
    return select(is_first, first * share_first, second * share_second);
}

}  // namespace tandem

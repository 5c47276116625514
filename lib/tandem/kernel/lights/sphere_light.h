/// The sphere as an area light, sampled by solid angle.
#pragma once

#include "tandem/kernel/lights/light_sample.h"
#include "tandem/math/frame.h"
#include "tandem/math/turns.h"

namespace tandem {

/// A sphere as seen from a point: from outside a cone of directions, from inside all directions.
template <class Real>
struct SphereLightView {
    using D = Double<Real>;
    Vec3<D> centre;     ///< world space
    D radius;           ///< metres
    Mask<Real> inside;  ///< the point is inside or on the surface
    Vec3<D> axis;       ///< unit, towards the centre; +z at the centre
    D distance;         ///< from the point to the centre
    D power;            ///< power of the point: distance^2 - radius^2
    D height;           ///< of the cap: 1 - cosine of the cone's half angle; 2 from inside
    D solid_angle;      ///< sr: 2 pi height
};

/// Needs: radius >= 0; magnitudes whose squares are finite.
/// Gives: the solid angle with a relative error of 2^-46 / (1 - radius / distance), however small the light; 0 for
///        radius 0, and hence no samples.
/// Method: 1 - cos = sin^2 / (1 + cos), because the difference cancels for small or far lights.
/// Everything here is tested by tests/kernel/lights/sphere_light_test.cpp.
template <class Real>
TANDEM_HD SphereLightView<Real> view_sphere_light(const Vec3<Double<Real>>& point, const Vec3<Double<Real>>& centre,
                                                  const Double<Real>& radius) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D one(1.0F);
    const Vec3<D> offset = centre - point;
    const D distance2 = dot(offset, offset);
    const D radius2 = radius * radius;
    // nearer to the centre than 2^-50 of the radius any axis is good enough
    const Mask<Real> centred = distance2 <= radius2 * D(0x1p-100F);
    const D inverse = inverse_square_root(select(centred, one, distance2));
    SphereLightView<Real> view;
    view.centre = centre;
    view.radius = radius;
    view.inside = distance2 <= radius2;
    view.axis = {select(centred, zero, offset.x * inverse), select(centred, zero, offset.y * inverse),
                 select(centred, one, offset.z * inverse)};
    view.distance = select(centred, zero, distance2 * inverse);
    view.power = distance2 - radius2;
    const D sine = radius * inverse;
    const D cosine = square_root(greater(view.power, zero)) * inverse;
    view.height = select(view.inside, D(2.0F), sine * sine / (one + cosine));
    view.solid_angle = constant<D>(2 * pi) * view.height;
    return view;
}

namespace sphere_light_detail {

template <class Real>
TANDEM_HD Double<Real> density(const SphereLightView<Real>& view) {
    using D = Double<Real>;
    const D zero(0.0F);
    const Mask<Real> seen = view.solid_angle > zero && view.radius > zero;
    return select(seen, D(1.0F) / select(seen, view.solid_angle, D(1.0F)), zero);
}

}  // namespace sphere_light_detail

/// Uniform among the directions that hit the sphere. The point is their first hit, within a few ulp of centre and
/// radius; from inside it is the exit. From a point on the surface half of the directions exit at once, with distance
/// 0.
/// Method: let theta, at the lit point, and beta, at the surface, be the angles between the line and the direction to
///         the centre. The law of sines, radius sin(beta) = distance sin(theta), gives the point by a rotation. So the
///         point is on the sphere, and the only root of a difference is that for cos(beta), whose error is along the
///         line of sight.
/// Source: P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM TOG 15(1),
///         1996, sec. 3.2.
template <class Real>
TANDEM_HD LightSample<Real> sample_light(const SphereLightView<Real>& view, const Double<Real>& u,
                                         const Double<Real>& v) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D one(1.0F);
    const D below = u * view.height;
    const D cosine = one - below;
    const D sine = square_root(below * (D(2.0F) - below));
    const SineCosine<Real> azimuth = sin_cos_turns<Real>(v);
    const Frame<D> frame = frame_around(view.axis);

    const D radius = select(view.radius > zero, view.radius, one);
    const D sine_there = lesser(sine * view.distance / radius, one);
    const D cosine_there = square_root((one - sine_there) * (one + sine_there));
    const D turned = select(view.inside, cosine_there, -cosine_there);
    const D along = view.radius * (turned * cosine - sine_there * sine);
    const D across = view.radius * (sine_there * cosine + turned * sine);

    // the product of both crossings is `power`; the one that does not cancel gives the other
    const D to_closest = view.distance * cosine;
    const D sum = absolute(to_closest) + view.radius * cosine_there;
    const D other = absolute(view.power) / select(sum > zero, sum, one);

    LightSample<Real> sample;
    sample.direction = from_frame(frame, sine * azimuth.cosine, sine * azimuth.sine, cosine);
    sample.point = view.centre + from_frame(frame, across * azimuth.cosine, across * azimuth.sine, along);
    sample.distance = select(view.inside && to_closest >= zero, sum, other);
    sample.pdf = sphere_light_detail::density(view);
    return sample;
}

/// Density of sample_light() for a unit direction: 0 beside the sphere.
template <class Real>
TANDEM_HD Double<Real> pdf_of(const SphereLightView<Real>& view, const Vec3<Double<Real>>& direction) {
    using D = Double<Real>;
    const D slack = constant<D>(direction_slack<Real>);
    const Vec3<D> sine = accurate_cross(direction, view.axis);  // the cosine is insensitive to small angles
    const D reach = view.radius + slack * view.distance;
    const Mask<Real> meets =
        dot(sine, sine) * (view.distance * view.distance) <= reach * reach && dot(direction, view.axis) >= -slack;
    return select(view.inside || meets, sphere_light_detail::density(view), D(0.0F));
}

}  // namespace tandem

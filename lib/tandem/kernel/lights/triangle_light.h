/// The triangle as an area light, sampled by solid angle: as a spherical triangle.
#pragma once

#include "tandem/kernel/lights/light_sample.h"
#include "tandem/math/turns.h"

namespace tandem {

/// A triangle as seen from a point. Lengths are in units of the distance of the farthest corner, so that the products
/// below neither overflow nor underflow, even in float. With a, b and c the corners seen from the point:
template <class Real>
struct TriangleLightView {
    using D = Double<Real>;
    Vec3<D> point;   ///< the point from which it is seen, world space
    D unit;          ///< metres
    Vec3<D> corner;  ///< a
    Vec3<D> edge1;   ///< b - a
    Vec3<D> edge2;   ///< c - a
    D volume;        ///< |a . (b x c)|
    // for the angle at a between the planes (a, b) and (a, c), both times |a x b| |a x c|
    D sine;
    D cosine;
    D cotangent;             ///< |a| |b| + a . b: cotangent of half the angle between a and b, times |a x b|
    D cross2;                ///< |a x c|
    D solid_angle;           ///< sr; 0 where the triangle is seen edge on
    Mask<Real> shows_front;  ///< its front is seen
};

namespace triangle_light_detail {

/// The sum |a| |b| + a . b, without cancellation where a and b point in opposite directions: product = |a| |b|, cross2
/// = |a x b|^2.
template <class D>
TANDEM_HD D one_plus_cosine(const D& product, const D& cosine, const D& cross2) {
    const D zero(0.0F);
    const D difference = product - cosine;
    const D by_sine = cross2 / select(difference > zero, difference, D(1.0F));
    return select(cosine < zero, by_sine, product + cosine);
}

/// The fraction of the segment from a to a + edge at which a direction rotated from a by an angle crosses it. `sine`
/// and `cosine`: of the angle, up to a common factor; `area` = |a x edge|, `length2` = |a|^2, `along` = a . edge. In
/// [0, 1]; 1 where rounding leaves no crossing.
template <class D>
TANDEM_HD D fraction_at_angle(const D& sine, const D& cosine, const D& area, const D& length2, const D& along) {
    const D numerator = sine * length2;
    const D denominator = area * cosine - sine * along;
    const Mask<D> within = numerator < denominator;
    return select(within, numerator / select(within, denominator, D(1.0F)), D(1.0F));
}

/// Below this solid angle the squares of the sampler would underflow, and area and solid angle are proportional.
template <class Real>
inline constexpr double smallest_spherical = is_fast<Real> ? 0x1p-40 : 0x1p-200;

/// Height above the plane, in `unit`, below which a point counts as lying in it, because rounding would move the
/// samples.
template <class Real>
inline constexpr double smallest_height = is_fast<Real> ? 0x1p-14 : 0x1p-40;

}  // namespace triangle_light_detail

/// Needs: magnitudes whose squares are finite.
/// Gives: the solid angle with a relative error of 2^-46 over the sine of the angle between the view and the triangle's
///        plane. 0, and so no samples, for a degenerate triangle, for a NaN, and from points in its plane: those nearer
///        to it than 2^-40 of the distance of the farthest corner (tier fast: 2^-14). There the light is edge-on, or
///        the point is on it.
/// Method: tan(E/2) from two sides and the angle between them. Unlike Girard's sum of angles it does not cancel for
///         small triangles. It is the formula of A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle",
///         IEEE Trans. Biomed. Eng. 30(2), 1983, times |a|.
/// Everything here is tested by tests/kernel/lights/triangle_light_test.cpp.
template <class Real>
TANDEM_HD_CALL_ON(device)
TriangleLightView<Real> view_triangle_light(Vec3<Double<Real>> point, Vec3<Double<Real>> v0, Vec3<Double<Real>> v1,
                                            Vec3<Double<Real>> v2) {
    using D = Double<Real>;
    using triangle_light_detail::one_plus_cosine;
    const D zero(0.0F);
    TriangleLightView<Real> view;
    const Vec3<D> to0 = v0 - point;
    const Vec3<D> to1 = v1 - point;
    const Vec3<D> to2 = v2 - point;
    const D farthest2 = greater(greater(dot(to0, to0), dot(to1, to1)), dot(to2, to2));
    const D scale = inverse_square_root(farthest2);
    view.point = point;
    view.unit = farthest2 * scale;
    view.corner = to0 * scale;
    view.edge1 = (v1 - v0) * scale;
    view.edge2 = (v2 - v0) * scale;

    const Vec3<D> a = view.corner;
    const Vec3<D> b = to1 * scale;
    const Vec3<D> c = to2 * scale;
    const Vec3<D> normal = accurate_cross(view.edge1, view.edge2);
    const Vec3<D> plane1 = accurate_cross(a, view.edge1);
    const Vec3<D> plane2 = accurate_cross(a, view.edge2);
    const D length_a = square_root(dot(a, a));
    const D product_ab = length_a * square_root(dot(b, b));
    const D product_ac = length_a * square_root(dot(c, c));
    const D cross2_ac = dot(plane2, plane2);
    const D facing = dot(a, normal);
    view.shows_front = facing < zero;
    view.volume = absolute(facing);
    view.sine = view.volume * length_a;
    view.cosine = dot(plane1, plane2);
    view.cotangent = one_plus_cosine(product_ab, dot(a, b), dot(plane1, plane1));
    view.cross2 = square_root(cross2_ac);
    const D cotangent_ac = one_plus_cosine(product_ac, dot(a, c), cross2_ac);
    const D half_turns = atan2_turns<Real>(view.sine, view.cotangent * cotangent_ac + view.cosine);
    const Mask<Real> faces =
        view.volume > constant<D>(triangle_light_detail::smallest_height<Real>) * square_root(dot(normal, normal));
    view.solid_angle = select(faces, half_turns * constant<D>(4 * pi), zero);
    return view;
}

namespace triangle_light_detail {

/// The density at a direction that hits the triangle at `distance`, in `unit`: 1 / solid angle or, for tiny triangles,
/// the density by area times distance^2 / cosine, where cosine * 2 area * distance is the volume.
template <class Real>
TANDEM_HD Double<Real> density(const TriangleLightView<Real>& view, const Double<Real>& distance) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D one(1.0F);
    const Mask<Real> seen = view.solid_angle > zero;
    const Mask<Real> spherical = view.solid_angle >= constant<D>(smallest_spherical<Real>);
    const D numerator = select(spherical, one, (distance + distance) * (distance * distance));
    const D denominator = select(spherical, view.solid_angle, view.volume);
    return select(seen, numerator / select(seen, denominator, one), zero);
}

/// 1 - cosine of an angle from `length` times its cosine and the square of `length` times its sine.
template <class D>
TANDEM_HD D one_minus_cosine(const D& length, const D& cosine, const D& sine2) {
    const D sum = length + cosine;
    const D numerator = select(cosine < D(0.0F), length - cosine, sine2 / select(sum > D(0.0F), sum, D(1.0F)));
    return numerator / select(length > D(0.0F), length, D(1.0F));
}

}  // namespace triangle_light_detail

/// Uniform among the directions that hit the triangle. The point is a mean of the corners with weights in [0, 1], so it
/// is always on the triangle.
///
/// Method: u cuts off the spherical triangle (a, b, p) with the fraction u of the area, where p is on the side ac. Then
///         v chooses a point between b and p, uniformly in the cosine of its distance from b.
/// Source: J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995. His cosine of the side ap is a
///         quotient of differences that cancel for small triangles. With E the area cut off, alpha the angle at a and c
///         the side ab, our form has no such differences: tan(ap / 2) = sin(E / 2) / (tan(c / 2) sin(alpha - E / 2)).
///         Points of the sides are computed as points of the flat edges. So it works for arbitrarily small triangles.
///         Where its squares would underflow (smallest_spherical), points are uniform over the area, by the limit of
///         the spherical map.
template <class Real>
TANDEM_HD_CALL_ON(device)
LightSample<Real> sample_light(TriangleLightView<Real> view, Double<Real> u, Double<Real> v) {
    using D = Double<Real>;
    using namespace triangle_light_detail;
    const D one(1.0F);
    const Mask<Real> spherical = view.solid_angle >= constant<D>(smallest_spherical<Real>);
    const Vec3<D> a = view.corner;
    const Vec3<D> b = a + view.edge1;

    const SineCosine<Real> half_area = sin_cos_turns<Real>(u * view.solid_angle * constant<D>(inverse_pi / 4));
    const D y = half_area.sine * view.cotangent * view.cross2;
    const D x = view.sine * half_area.cosine - view.cosine * half_area.sine;
    const D along_ac =
        fraction_at_angle(D(2.0F) * y * x, (x - y) * (x + y), view.cross2, dot(a, a), dot(view.edge2, a));
    const D g = select(spherical, along_ac, u);

    const Vec3<D> edge = view.edge2 * g - view.edge1;  // from b to the point on ac
    const Vec3<D> p = a + view.edge2 * g;
    const Vec3<D> plane = accurate_cross(b, edge);
    const D length2_b = dot(b, b);
    const D area2 = dot(plane, plane);
    const D whole = one_minus_cosine(square_root(length2_b * dot(p, p)), dot(b, p), area2);
    const D part = v * whole;
    const D along_bp = fraction_at_angle(square_root(part * (D(2.0F) - part)), one - part, square_root(area2),
                                         length2_b, dot(edge, b));
    const D f = select(spherical, along_bp, square_root(v));

    const Vec3<D> offset = a + view.edge1 * (one - f) + view.edge2 * (f * g);
    const D distance2 = dot(offset, offset);
    const D inverse = inverse_square_root(distance2);
    LightSample<Real> sample;
    sample.direction = offset * inverse;
    sample.distance = distance2 * inverse * view.unit;
    sample.point = view.point + offset * view.unit;
    sample.pdf = density(view, distance2 * inverse);
    return sample;
}

/// The hit of a line from the point on a triangle.
template <class Real>
struct TriangleLightHit {
    Mask<Real> meets;
    Double<Real> distance;  ///< in units of the view
};

/// For a unit direction. `within`: the relative distance inside the edges that a hit needs; negative values allow hits
/// outside.
template <class Real>
TANDEM_HD_CALL_ON(device)
TriangleLightHit<Real> find_on_light(TriangleLightView<Real> view, Vec3<Double<Real>> direction, double within) {
    using D = Double<Real>;
    const Vec3<D> normal = accurate_cross(view.edge1, view.edge2);
    const D sign = select(view.shows_front, D(-1.0F), D(1.0F));
    // the volumes with the edges, as in kernel/shapes/triangle.h: of one sign where the line crosses the triangle
    const D speed = sign * dot(direction, normal);
    const D w2 = sign * dot(direction, accurate_cross(view.corner, view.edge1));
    const D w1 = -sign * dot(direction, accurate_cross(view.corner, view.edge2));
    const D w0 = speed - w1 - w2;
    const D least = constant<D>(within) * (norm1(view.edge1) + norm1(view.edge2));
    const Mask<Real> meets = speed > D(0.0F) && w0 >= least && w1 >= least && w2 >= least;
    return {meets, view.volume / select(meets, speed, D(1.0F))};
}

/// Density of sample_light() for a unit direction: 0 beside the triangle.
template <class Real>
TANDEM_HD Double<Real> pdf_of(const TriangleLightView<Real>& view, const Vec3<Double<Real>>& direction) {
    const TriangleLightHit<Real> hit = find_on_light(view, direction, -direction_slack<Real>);
    return select(hit.meets, triangle_light_detail::density(view, hit.distance), Double<Real>(0.0F));
}

}  // namespace tandem

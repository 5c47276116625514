/// Where a ray hits a primitive, as an interval computed in float alone. With intervals, a traversal need not decide in
/// its loop: it keeps the few primitives whose intervals overlap the nearest one, and test_primitive() decides about
/// them afterwards.
///
/// Needs: a QueryRay of a traceable ray, and a primitive within coordinate_limit.
/// Gives: an interval that contains the query parameter of the hit, if there is one; certain_miss only if there is
///        none; a finite `hi` only if there is one. The parameter is that of the t that first_hit_from() returns. Lower
///        ends are not negative. NaN and overflow give [0, infinity],
///        unless the direction alone shows that a culled face is hit from behind.
/// Method: rounding is seen as a small change of the primitive. A solid is grown and shrunk by a bound of all errors,
///        as lengths: before the ray enters the grown one, there is no hit; where it enters the shrunk one, it has hit.
///        A face's volumes are compared with their errors, as in may_touch_triangle().
/// Bounds: with u = 2^-24, lengths as 1-norms, f = origin - centre. Near the solid of radius R, these move a point of
///        the query ray: the direction and its length, 9 u (|f| + R); the rounding of f, u |f|; products and sums, at
///        most 6 u |f|; square roots, reciprocals and their products, 8 u R. The margins are 24 u (|f| + R) + drift or
///        more. Terms with 1e-36 keep them above the loss by underflow. With or without fused multiply-adds. Tested
///        against exact arithmetic by tests/kernel/traversal/hit_interval_test.cpp.
/// Source: the filters of kernel/shapes/filter.h, of which these are the two-sided forms.
#pragma once

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/filter.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/traversal/query_ray.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/rough.h"

namespace tandem {

template <class F>
struct HitIntervalOf {
    F lo;
    F hi;  ///< infinite if the hit is not certain
};
/// Of one ray.
using HitInterval = HitIntervalOf<float>;

namespace interval_detail {

inline constexpr float infinity = __builtin_huge_valf();
/// Products of larger numbers might overflow. Such intervals are unsure.
inline constexpr float largest = 1e36F;

/// `a` if it is positive, else 0; also for NaN.
template <class F>
TANDEM_HD_INLINE F not_negative(const F& a) {
    return rough_greater(F(0.0F), a);
}

}  // namespace interval_detail

inline constexpr HitInterval certain_miss = {interval_detail::infinity, interval_detail::infinity};
inline constexpr HitInterval unsure_hit = {0.0F, interval_detail::infinity};

/// The crossings of a query ray with a solid that was grown, and with the same solid shrunk.
struct SolidCrossings {
    float outer_near, outer_far;
    float inner_near, inner_far;
    bool crosses;  ///< the shrunk solid; else its crossings mean nothing
};

/// The hit of a ray on a solid: where it enters, or leaves if it starts inside. `own`: it leaves this solid inward, so
/// it always hits the far side, at a positive t.
TANDEM_HD_INLINE HitInterval hit_of(const SolidCrossings& c, bool own) {
    using namespace interval_detail;
    if (own) {
        if (!c.crosses) return unsure_hit;
        const float hi = not_negative(c.outer_far);
        return {not_negative(c.inner_far), hi + 1e-30F};
    }
    if (c.outer_far < 0.0F || c.outer_near > c.outer_far) return certain_miss;
    if (c.outer_near > 0.0F) return {c.outer_near, c.crosses ? c.inner_near : infinity};
    return {c.crosses && c.inner_near < 0.0F ? not_negative(c.inner_far) : 0.0F,
            c.crosses && c.inner_far > 0.0F ? c.outer_far : infinity};
}

/// A query ray and a sphere, as far as the line decides. With `margin` = 24 u (|f| + radius) + drift and `doubt` =
/// margin (2 radius + margin), radius^2 - |moment|^2 errs by less than `doubt`.
struct SphereLine {
    Vec3f offset;
    float radius;
    float margin, doubt;
    float discriminant;

    TANDEM_HD_INLINE SphereLine(const QueryRay& ray, const Sphere& sphere)
        : offset(ray.origin - sphere.centre), radius(sphere.radius) {
        const Vec3f moment = loose_cross(offset, ray.direction);
        margin = loose_multiply_add(24.0F * float_roundoff, norm1(offset) + radius, ray.drift);
        doubt = loose_multiply_add(margin, loose_multiply_add(2.0F, radius, margin), 1e-36F);
        discriminant = loose_multiply_add(radius, radius, -loose_dot(moment, moment));
    }
    [[nodiscard]] TANDEM_HD_INLINE bool misses() const { return discriminant < -doubt; }
};

/// `line` does not miss. A crossing errs by `margin` along the ray, and by `doubt` over the root of the discriminant
/// because of that.
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const SphereLine& line, bool own) {
    const float middle = -loose_dot(line.offset, ray.direction);
    const bool crosses = line.discriminant > 2.0F * line.doubt;
    // if the line may just touch the sphere, the true discriminant is below 3 doubt
    const float from = crosses ? line.discriminant : 3.0F * line.doubt;
    const float inverse_root = rough_inverse_square_root(from);
    const float half = from * inverse_root;
    const float error = crosses ? loose_multiply_add(line.doubt, inverse_root, line.margin) : line.margin;
    const float near = middle - half, far = middle + half;
    return hit_of({near - error, far + error, near + error, far - error, crosses}, own);
}
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Sphere& sphere, bool own) {
    const SphereLine line(ray, sphere);
    if (line.misses() && !own) return certain_miss;
    return hit_interval(ray, line, own);
}

/// A placement in float, as hit_interval() needs it: 64 bytes.
struct alignas(16) RoughPlacement {
    Vec3f row[3];  ///< of object_from_world
    Vec3f centre;
    Vec3f row_norms;  ///< 1-norms
    float size;       ///< |centre|_1 + the radius of the bounding sphere
};
static_assert(sizeof(RoughPlacement) == 64);
struct RoughEllipsoid : RoughPlacement {};
struct RoughParallelepiped : RoughPlacement {};

TANDEM_HD_INLINE RoughPlacement rough_placement(const Placement& body) {
    RoughPlacement rough;
    for (int i = 0; i < 3; ++i) rough.row[i] = narrow(body.object_from_world.row[i]);
    rough.centre = narrow(body.centre);
    rough.row_norms = {norm1(rough.row[0]), norm1(rough.row[1]), norm1(rough.row[2])};
    rough.size = norm1(rough.centre) + body.bounding_sphere.radius;
    return rough;
}

namespace interval_detail {

/// Cuts `c` at the slab |x| <= half, where the ray is at `position` and moves with `speed`, by component; `margin`:
/// what the slab is grown and shrunk by. A speed below `least` is replaced, which moves no point as far as `margin`.
TANDEM_HD_INLINE void cut(SolidCrossings& c, float position, float speed, float half, float margin, float least) {
    const float safe = absolute(speed) < least ? (speed < 0.0F ? -least : least) : speed;
    const float inverse = rough_reciprocal(safe);
    const float middle = -position * inverse;
    const float width = absolute(inverse);
    const float grown = (half + margin) * width;
    const float shrunk = (half - margin) * width;
    c.outer_near = rough_greater(c.outer_near, middle - grown);
    c.outer_far = rough_lesser(c.outer_far, middle + grown);
    c.inner_near = rough_greater(c.inner_near, middle - shrunk);
    c.inner_far = rough_lesser(c.inner_far, middle + shrunk);
}

inline constexpr SolidCrossings whole_line = {-infinity, infinity, -infinity, infinity, false};

/// The ray that a placement moves to the space of a unit solid, in float.
struct ObjectQuery {
    Vec3f row_norms;
    Vec3f origin, direction;
    float margin;  ///< of a point near the solid, before it is moved to the solid's space
    bool is_moderate;

    TANDEM_HD_INLINE ObjectQuery(const QueryRay& ray, const RoughPlacement& body) : row_norms(body.row_norms) {
        const Vec3f offset = ray.origin - body.centre;
        const float size = norm1(offset) + body.size;
        margin = loose_multiply_add(32.0F * float_roundoff, size, 2.0F * ray.drift);
        origin = {loose_dot(body.row[0], offset), loose_dot(body.row[1], offset), loose_dot(body.row[2], offset)};
        direction = {loose_dot(body.row[0], ray.direction), loose_dot(body.row[1], ray.direction),
                     loose_dot(body.row[2], ray.direction)};
        is_moderate = norm1(row_norms) * (size + 1.0F) < largest && margin < largest &&
                      lesser(lesser(row_norms.x, row_norms.y), row_norms.z) > 1e-24F;
    }
};

}  // namespace interval_detail

TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const RoughParallelepiped& body, bool own) {
    const interval_detail::ObjectQuery object(ray, body);
    if (!object.is_moderate) return unsure_hit;
    SolidCrossings c = interval_detail::whole_line;
    const auto cut = [&](float norm, float position, float speed) {
        const float margin = loose_multiply_add(norm, object.margin, 8.0F * float_roundoff);
        interval_detail::cut(c, position, speed, 1.0F, margin, 1e-12F * norm);
    };
    cut(object.row_norms.x, object.origin.x, object.direction.x);
    cut(object.row_norms.y, object.origin.y, object.direction.y);
    cut(object.row_norms.z, object.origin.z, object.direction.z);
    c.crosses = c.inner_near <= c.inner_far;
    return hit_of(c, own);
}

TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Box& box, bool own) {
    const BoxFilter shape = make_box_filter(box.lower, box.upper);
    const Vec3f offset = ray.origin - shape.centre;
    const float margin =
        loose_multiply_add(32.0F * float_roundoff, norm1(offset) + shape.corner_norm1, 2.0F * ray.drift);
    if (!(margin < interval_detail::largest)) return unsure_hit;
    SolidCrossings c = interval_detail::whole_line;
    interval_detail::cut(c, offset.x, ray.direction.x, shape.half.x, margin, 1e-12F);
    interval_detail::cut(c, offset.y, ray.direction.y, shape.half.y, margin, 1e-12F);
    interval_detail::cut(c, offset.z, ray.direction.z, shape.half.z, margin, 1e-12F);
    c.crosses = c.inner_near <= c.inner_far;
    return hit_of(c, own);
}

/// The unit sphere, grown and shrunk. The moment and the roots in object space err by 24 u of the distance there, and
/// of the radius.
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const RoughEllipsoid& body, bool own) {
    const interval_detail::ObjectQuery object(ray, body);
    const float length2 = loose_dot(object.direction, object.direction);
    const Vec3f moment = loose_cross(object.origin, object.direction);
    const float moment2 = loose_dot(moment, moment);
    const bool is_normal = length2 > 1e-28F && length2 < interval_detail::largest && moment2 < interval_detail::largest;
    if (!object.is_moderate || !is_normal) return unsure_hit;
    const float margin = loose_multiply_add(norm1(object.row_norms), object.margin,
                                            24.0F * float_roundoff * (norm1(object.origin) + 1.0F));
    const float inverse = rough_reciprocal(length2);
    const float middle = -loose_dot(object.origin, object.direction) * inverse;
    const auto half = [&](float radius) {
        const float rest = loose_multiply_add(length2 * radius, radius, -moment2);
        // far below what the margin adds to the rest, and still normal
        return rest > 1e-36F ? rest * rough_inverse_square_root(rest) * inverse : -1.0F;
    };
    const float outer = half(1.0F + margin);
    if (outer < 0.0F && own) return unsure_hit;
    if (outer < 0.0F) return certain_miss;
    const float inner = margin < 1.0F ? half(1.0F - margin) : -1.0F;
    return hit_of({middle - outer, middle + outer, middle - inner, middle + inner, inner >= 0.0F}, own);
}

TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Parallelepiped& body, bool own) {
    return hit_interval(ray, RoughParallelepiped{rough_placement(body)}, own);
}
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Ellipsoid& body, bool own) {
    return hit_interval(ray, RoughEllipsoid{rough_placement(body)}, own);
}

/// Of one ray or a packet. With a = v0 - origin, m = direction x a, s = |e1| + |e2|: the volumes err by less than u (4
/// |a| + 7 |m| + 3 s) s + 1.5 drift s, their sum, `speed`, by 3 u s^2, and `above` by (2 u |a| + 0.5 drift) s^2, as in
/// may_touch_triangle(). The hit is at above / speed. `culls`: a hit from behind does not count. Where the side is
/// known, |speed| > 12 u s^2, and the cosine to the normal is above 2^-19, far above the error of geometric_normal().
template <class F>
TANDEM_HD_INLINE HitIntervalOf<F> hit_interval(const QueryRayOf<F>& ray, const TriangleEdges& triangle,
                                               bool culls = false) {
    const Vec3<F> e1 = broadcast<F>(triangle.e1);
    const Vec3<F> e2 = broadcast<F>(triangle.e2);
    const F size(triangle.size);
    const Vec3<F> a = broadcast<F>(triangle.v0) - ray.origin;
    const Vec3<F> moment = loose_cross(ray.direction, a);
    const Vec3<F> normal = broadcast<F>(loose_cross(triangle.e1, triangle.e2));
    const F speed = loose_dot(ray.direction, normal);
    const UInt<F> turned = bits_of(speed) & UInt<F>(0x80000000U);
    const auto in_front = [&turned](const F& x) { return float_of(bits_of(x) ^ turned); };
    const F w2 = in_front(loose_dot(moment, e1));
    const F w1 = in_front(-loose_dot(moment, e2));
    const F fast = absolute(speed);
    const F w0 = (fast - w1) - w2;
    const F distance = norm1(a);
    const F beside = loose_multiply_add(F(8.0F * float_roundoff), norm1(moment) + size, F(2.0F) * ray.drift);
    const F error = loose_multiply_add(loose_multiply_add(F(4.5F * float_roundoff), distance, beside), size, F(1e-36F));
    const F least = lesser(lesser(w0, w1), w2);
    const F size2 = size * size;
    const F speed_error = loose_multiply_add(F(4.0F * float_roundoff), size2, F(1e-36F));
    const F infinity(interval_detail::infinity);
    const auto knows_side = fast > F(4.0F) * speed_error;
    // else all signs may be turned
    auto misses = least < -error && (knows_side || greater(greater(w0, w1), w2) > error);
    if (culls) misses = misses || (knows_side && speed > F(0.0F));
    if (all(misses)) return {infinity, infinity};
    const F above = in_front(loose_dot(a, normal));
    const auto is_unsure = !knows_side || !(fast + absolute(above) < F(interval_detail::largest));
    if (all(misses || is_unsure)) return {select(misses, infinity, F(0.0F)), infinity};
    const F above_error =
        loose_multiply_add(loose_multiply_add(F(3.0F * float_roundoff), distance, ray.drift), size2, F(1e-36F));
    const F inverse = rough_reciprocal(fast);
    const F s = above * inverse;
    // the true speed is above three quarters of this one
    const F quotient_error = loose_multiply_add(absolute(s), speed_error, above_error) * F(1.5F);
    const F margin = loose_multiply_add(quotient_error, inverse,
                                        loose_multiply_add(F(16.0F * float_roundoff), absolute(s), ray.drift));
    const auto is_behind = s + margin < F(0.0F);
    if (all(is_behind)) return {infinity, infinity};
    const F lo = s - margin;
    const auto is_certain = lo > F(0.0F) && least > error;
    if constexpr (RealTraits<F>::lanes == 1) {
        return {interval_detail::not_negative(lo), is_certain ? s + margin : infinity};
    } else {
        const F start = select(is_unsure, F(0.0F), interval_detail::not_negative(lo));
        return {select(misses || (is_behind && !is_unsure), infinity, start),
                select(is_certain && !is_unsure && !misses, s + margin, infinity)};
    }
}
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Triangle& triangle, bool culls) {
    return hit_interval(ray, edges_of(triangle.v0, triangle.v1, triangle.v2), culls);
}
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const EntryTriangle& triangle, bool culls) {
    const TriangleEdges& edges = triangle;
    return hit_interval(ray, edges, culls);
}
/// The nearer hit of two. If a folded quad is hit on both halves at the same t, the side of the first half decides
/// whether that hit counts: so where the first half may be hit from behind, a front hit of the second is not certain.
TANDEM_HD_INLINE HitInterval hit_interval(const QueryRay& ray, const Quad& quad, bool culls) {
    using interval_detail::infinity;
    const TriangleEdges first_half = edges_of(quad.v0, quad.v1, quad.v2);
    const HitInterval first = hit_interval(ray, first_half, culls);
    HitInterval second = hit_interval(ray, edges_of(quad.v0, quad.v2, quad.v3), culls);
    if (culls && second.hi < infinity && !(first.hi < infinity) && hit_interval(ray, first_half).lo < infinity) {
        second.hi = infinity;
    }
    return {lesser(first.lo, second.lo), lesser(first.hi, second.hi)};
}

namespace interval_detail {

/// The interval of a hit if hits at or before the last masked one do not count.
template <class Primitive>
TANDEM_HD_INLINE HitInterval beyond_masked(const HitInterval& hit, const QueryRay& ray) {
    if (ray.passed == 0.0F || hit.lo > ray.passed) return hit;
    // a solid and a folded quad may be hit a second time
    if (std::is_same_v<Primitive, Triangle> && hit.hi < ray.start) return certain_miss;
    return {hit.lo, infinity};
}

template <class Shape>
TANDEM_HD_INLINE bool is_culled(const Shape& shape) {
    if constexpr (std::is_same_v<Shape, EntryTriangle>) {
        return may_be_cut_out(PrimitiveKinds::triangle) && shape.sides == FaceSides::culled;
    } else if constexpr (is_face<Shape>) {
        return may_be_cut_out(kind_of<Shape>) && shape.attributes.sides == FaceSides::culled;
    } else {
        return false;
    }
}

}  // namespace interval_detail

/// The hit that counts for a ray from `source`, as test_primitive() finds it, on primitive `id` of type `Primitive`.
/// `shape`: the primitive, the SphereLine of a sphere, the entry of a triangle, or a rough ellipsoid or parallelepiped.
/// `culls`: culled faces let the ray pass from behind.
template <class Real, class Primitive, class From, class Shape>
TANDEM_HD_INLINE HitInterval hit_interval_from(const From& source, std::uint32_t id, const QueryRay& ray,
                                               const Shape& shape, bool culls = passes_backs<Real, From>) {
    if (!can_meet<Real, Primitive>(source, id, false)) return certain_miss;
    if constexpr (std::is_base_of_v<ShadowSource<Real>, From>) {
        if (source.light == id) return certain_miss;
    }
    HitInterval hit;
    if constexpr (is_face<Primitive>) {
        hit = hit_interval(ray, shape, culls && interval_detail::is_culled(shape));
    } else {
        hit = hit_interval(ray, shape, leaves_inward<Real>(source, id));
    }
    if constexpr (std::is_same_v<From, PathSource<Real>>) hit = interval_detail::beyond_masked<Primitive>(hit, ray);
    return hit;
}

}  // namespace tandem

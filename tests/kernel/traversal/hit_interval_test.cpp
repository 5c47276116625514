// The intervals of hits against exact arithmetic, and against the decisions that they stand for.
#include "tandem/kernel/traversal/hit_interval.h"

#include <gtest/gtest.h>

#include "support/adversarial_rays.h"
#include "support/adversarial_triangles.h"
#include "support/exact_geometry.h"
#include "tandem/kernel/traversal/quick_proposal.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

using test::Big;
using test::BigVector;
using test::Random;

constexpr std::uint64_t cases_per_kind = 10000;

struct Counts {
    int hits = 0, sure = 0, misses = 0, sure_misses = 0;
};

/// Whether intervals say enough: most cases of the easy kind must be certain.
void expect_sharp(const Counts& counts, double sure, double sure_misses) {
    EXPECT_GT(counts.sure, sure * counts.hits) << counts.hits;
    EXPECT_GT(counts.sure_misses, sure_misses * counts.misses) << counts.misses;
}

/// The frame of a scene that has the primitive and, every second time, something else somewhere.
StructureFrame any_frame(Random& random, const Aabb& primitive) {
    if (random.coin()) return make_structure_frame(primitive);
    const float size = reach(primitive);
    const Vec3f other = narrow(test::any_unit(random) * std::exp2(random.uniform(-3.0, 8.0)));
    return make_structure_frame(merge(primitive, {other * size, other * size}));
}

/// The query parameter of a hit at t.
Big query_parameter(const Ray<float>& ray, const Proposal<float>& proposal, const Big& t) {
    return (t - Big(proposal.t_offset)) * sqrt(test::dot(test::big(ray.direction), test::big(ray.direction)));
}

void expect_contains(const HitInterval& interval, const Big& s, const std::string& where) {
    if (interval.lo > 0) {
        ASSERT_LE(Big(interval.lo), s) << where;
    }
    if (std::isfinite(interval.hi)) {
        ASSERT_LE(s, Big(interval.hi)) << where;
    }
}

/// `exact`: t of the hit; `own`: the ray leaves the solid inward, for which the decision says what is exact.
template <class Primitive>
void check(const Primitive& primitive, const Ray<float>& ray, const std::optional<Big>& exact, bool own, Random& random,
           const std::string& where, Counts& counts) {
    const StructureFrame frame = any_frame(random, bounds(primitive));
    const Proposal<float> proposal = random.coin() ? propose(ray, frame, true) : propose_quickly(ray, frame);
    if (!proposal.active) {
        ASSERT_FALSE(exact) << "lost before the bounds: " << where;
        return;
    }
    const Source<float> source = {own ? 7U : no_primitive, own};
    const HitInterval interval = hit_interval(make_query_ray(proposal, frame, source), primitive, own);
    ASSERT_GE(interval.lo, 0.0F) << where;
    ASSERT_LE(interval.lo, interval.hi) << where;
    ++(exact ? counts.hits : counts.misses);
    if (!exact) {
        ASSERT_TRUE(std::isinf(interval.hi)) << "a certain hit is a miss: " << where;
        if (std::isinf(interval.lo)) ++counts.sure_misses;
        return;
    }
    if (std::isfinite(interval.hi)) ++counts.sure;
    const auto expect_within = [&](const Big& t, const char* what) {
        const Big s = query_parameter(ray, proposal, t);
        const auto rounded = static_cast<double>(t);
        if (s > 1e-30 && Big(rounded) == t) {  // far below, subnormal floats are no bounds
            ASSERT_LE(s, Big(proposal.limit(rounded))) << what << ", limit, " << where;
            ASSERT_LE(Big(proposal.start(rounded)), s) << what << ", start, " << where;
        }
        expect_contains(interval, s, what + (", " + where));
    };
    expect_within(*exact, "exact");
    double t = 0;
    if (first_hit_from(source, primitive, 7U, ray, true, __builtin_huge_val(), t)) expect_within(Big(t), "decided");
}

std::optional<Big> exact_hit(const Sphere& sphere, const Ray<float>& ray) {
    return test::hit_ball(test::big(ray.origin) - test::big(sphere.centre), test::big(ray.direction),
                          Big(sphere.radius));
}
std::optional<Big> exact_hit(const Box& box, const Ray<float>& ray) {
    const auto hit =
        test::hit_box(test::big(ray.origin), test::big(ray.direction), test::big(box.lower), test::big(box.upper));
    return hit ? std::optional<Big>(hit->t) : std::nullopt;
}
std::optional<Big> exact_hit(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2, const Ray<float>& ray) {
    const auto hit = test::hit_triangle(test::big(ray.origin), test::big(ray.direction), test::big(v0), test::big(v1),
                                        test::big(v2));
    return hit ? std::optional<Big>(hit->t) : std::nullopt;
}
std::optional<Big> exact_hit(const Triangle& t, const Ray<float>& ray) { return exact_hit(t.v0, t.v1, t.v2, ray); }
std::optional<Big> exact_hit(const Quad& q, const Ray<float>& ray) {
    auto first = exact_hit(q.v0, q.v1, q.v2, ray);
    auto second = exact_hit(q.v0, q.v2, q.v3, ray);
    if (!first || (second && *second < *first)) return second;
    return first;
}
BigVector to_object(const Placement& body, const BigVector& v) { return body.object_from_world * v; }
std::optional<Big> exact_hit(const Ellipsoid& body, const Ray<float>& ray) {
    return test::hit_ball(to_object(body, test::big(ray.origin) - test::big(body.centre)),
                          to_object(body, test::big(ray.direction)), Big(1));
}
std::optional<Big> exact_hit(const Parallelepiped& body, const Ray<float>& ray) {
    const Big one = 1;
    const auto hit = test::hit_box(to_object(body, test::big(ray.origin) - test::big(body.centre)),
                                   to_object(body, test::big(ray.direction)), {-one, -one, -one}, {one, one, one});
    return hit ? std::optional<Big>(hit->t) : std::nullopt;
}

/// Checks the cases of make(kind, number), and rays that leave solids inward from where they are hit. Returns the
/// counts of the first kind.
template <class Make>
Counts check_cases(int kinds, std::uint64_t rays, const char* name, const Make& make) {
    Counts easy, counts;
    for (int kind = 0; kind < kinds; ++kind) {
        for (std::uint64_t number = 0; number < rays; ++number) {
            const auto [primitive, ray] = make(kind, number);
            if (!is_traceable(ray)) continue;
            Random random(number);
            const auto where = std::string(name) + "(" + std::to_string(kind) + ", " + std::to_string(number) + "), " +
                               test::reproducer(ray);
            check(primitive, ray, exact_hit(primitive, ray), false, random, where, counts);
            if constexpr (!is_face<std::decay_t<decltype(primitive)>>) {
                double t = 0;
                if (number % 4 != 0 || !first_hit(primitive, ray, t)) continue;
                const auto at = [&](float o, float d) { return static_cast<float>(widen(o) + t * widen(d)); };
                const Vec3f &o = ray.origin, &d = ray.direction;
                const Vec3f there = {at(o.x, d.x), at(o.y, d.y), at(o.z, d.z)};
                const Ray<float> onwards = {there, random.coin() ? d : narrow(test::any_unit(random))};
                const Source<float> inward = {7U, true};
                if (!is_traceable(onwards)) continue;
                (void)first_hit_from(inward, primitive, 7U, onwards, true, __builtin_huge_val(), t);
                Counts ignored;
                if (propose(onwards, make_structure_frame(bounds(primitive)), true).active) {
                    check(primitive, onwards, Big(t), true, random, where + ", onwards", ignored);
                }
            }
            if (testing::Test::HasFatalFailure()) return easy;
        }
        if (kind == 0) easy = counts;
    }
    return easy;
}

TEST(HitInterval, OfSpheres) {
    const Counts counts = check_cases(static_cast<int>(std::size(test::sphere_kinds)), cases_per_kind, "sphere_case",
                                      [](int kind, std::uint64_t number) { return test::sphere_case(kind, number); });
    expect_sharp(counts, 0.9, 0.9);
}

TEST(HitInterval, OfBoxes) {
    const Counts counts = check_cases(static_cast<int>(std::size(test::box_kinds)), cases_per_kind, "box_case",
                                      [](int kind, std::uint64_t number) { return test::box_case(kind, number); });
    expect_sharp(counts, 0.9, 0.9);
}

TEST(HitInterval, OfTriangles) {
    const auto make = [](int kind, std::uint64_t number) { return test::triangle_case(kind, number); };
    const Counts counts =
        check_cases(static_cast<int>(std::size(test::triangle_kinds)), cases_per_kind, "triangle_case", make);
    expect_sharp(counts, 0.5, 0.7);  // a third of the rays aims at edges
}

TEST(HitInterval, OfTrianglesInLanesAreThoseOfSingleRays) {
    using Packet = Lanes<float, Sse4>;
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < cases_per_kind; ++number) {
            const Triangle triangle = test::triangle_case(kind, number).triangle;
            QueryRay one[Packet::size] = {};
            QueryRayOf<Packet> packet{};
            for (int i = 0; i < Packet::size; ++i) {
                const Ray<float> ray = test::triangle_case(kind, number + static_cast<std::uint64_t>(i)).ray;
                if (is_traceable(ray)) {
                    const StructureFrame frame = make_structure_frame(bounds(triangle));
                    one[i] = make_query_ray(propose(ray, frame, true), frame, NoSource{});
                }
                for (int axis = 0; axis < 3; ++axis) {
                    packet.origin[axis].set(i, one[i].origin[axis]);
                    packet.direction[axis].set(i, one[i].direction[axis]);
                }
                packet.drift.set(i, one[i].drift);
            }
            const TriangleEdges edges = edges_of(triangle.v0, triangle.v1, triangle.v2);
            for (const bool culls : {false, true}) {
                const auto intervals = hit_interval(packet, edges, culls);
                for (int i = 0; i < Packet::size; ++i) {
                    const HitInterval want = hit_interval(one[i], edges, culls);
                    ASSERT_EQ(intervals.lo[i], want.lo)
                        << "triangle_case(" << kind << ", " << number << "), lane " << i;
                    ASSERT_EQ(intervals.hi[i], want.hi)
                        << "triangle_case(" << kind << ", " << number << "), lane " << i;
                }
            }
        }
    }
}

struct TriangleRay {
    Triangle face;
    Ray<float> ray;
};
TriangleRay triangle_ray(int kind, std::uint64_t number) {
    const auto c = test::triangle_case(kind, number);
    return {c.triangle, c.ray};
}

struct QuadRay {
    Quad face;
    Ray<float> ray;
};
/// A parallelogram, or a quad that may be folded.
QuadRay quad_ray(int kind, std::uint64_t number) {
    const auto c = test::triangle_case(kind, number);
    Random random(number + 5);
    const Vec3f &v0 = c.triangle.v0, &v1 = c.triangle.v1, &v2 = c.triangle.v2;
    const Vec3f v3 = random.coin() ? v0 + (v2 - v1) : v1 + (v2 - v1) * random.uniform(-1.0F, 2.0F);
    return {{v0, v1, v2, v3}, c.ray};
}

TEST(HitInterval, OfQuads) {
    const Counts counts = check_cases(static_cast<int>(std::size(test::triangle_kinds)), cases_per_kind / 2, "quad_ray",
                                      [](int kind, std::uint64_t number) { return quad_ray(kind, number); });
    expect_sharp(counts, 0.5, 0.5);
}

// The interval of a triangle is that of both sides, or the ray certainly comes from behind.
TEST(HitInterval, OfCulledTrianglesAreThoseOfTheirFronts) {
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < cases_per_kind; ++number) {
            const auto [triangle, ray] = triangle_ray(kind, number);
            if (!is_traceable(ray)) continue;
            const StructureFrame frame = make_structure_frame(bounds(triangle));
            const Proposal<float> proposal = propose(ray, frame, true);
            if (!proposal.active) continue;
            const QueryRay query = make_query_ray(proposal, frame, NoSource{});
            const HitInterval both = hit_interval(query, triangle, false), front = hit_interval(query, triangle, true);
            if (front.lo == both.lo && front.hi == both.hi) continue;
            ASSERT_EQ(front.lo, certain_miss.lo)
                << "triangle_ray(" << kind << ", " << number << "), " << test::reproducer(ray);
        }
    }
}

/// Checks the intervals of culled faces for the rays of paths, some of which have passed a masked hit, against the
/// decisions: the backs do not count.
template <class MakeRay>
void expect_fronts_count(const char* name, std::uint64_t rays, const MakeRay& make_ray) {
    int from_behind = 0, misses = 0, fronts = 0, certain = 0;
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < rays; ++number) {
            auto [face, ray] = make_ray(kind, number);
            if (!is_traceable(ray)) continue;
            const StructureFrame frame = make_structure_frame(bounds(face));
            const Proposal<float> proposal = propose(ray, frame, true);
            if (!proposal.active) continue;
            const auto where = std::string(name) + "(" + std::to_string(kind) + ", " + std::to_string(number) + "), " +
                               test::reproducer(ray);
            using Face = std::decay_t<decltype(face)>;
            constexpr double farthest = __builtin_huge_val();
            double t = 0;
            const bool hits = first_hit_from(NoSource{}, face, 7U, ray, true, farthest, t);
            PathSource<float> path;
            Random random(number);
            const bool has_passed = hits && random.below(4) == 0;
            if (has_passed) path.last_masked = {t, random.coin() ? 7U : 5U};
            if (has_passed && random.coin()) path.last_masked = {0.5 * t, 5U};
            face.attributes.sides = FaceSides::culled;
            const bool counts = first_hit_from(path, face, 7U, ray, true, farthest, t, true);
            const HitInterval interval =
                hit_interval_from<float, Face>(path, 7U, make_query_ray(proposal, frame, path), face);
            if (interval.lo == certain_miss.lo) {
                ASSERT_FALSE(counts) << where;
            }
            if (std::isfinite(interval.hi)) {
                ASSERT_TRUE(counts) << where;
            }
            if (counts) expect_contains(interval, query_parameter(ray, proposal, Big(t)), where);
            if (testing::Test::HasFatalFailure()) return;
            if (kind != 0 || has_passed || !hits) continue;  // intervals of the hard kinds need not be sharp
            ++(counts ? fronts : from_behind);
            if (!counts && interval.lo == certain_miss.lo) ++misses;
            if (counts && std::isfinite(interval.hi)) ++certain;
        }
    }
    EXPECT_GT(misses, 0.9 * from_behind);
    EXPECT_GT(certain, 0.4 * fronts);  // a third of the rays aims at edges, more at the diagonals of quads
    EXPECT_GT(from_behind, 500);
    EXPECT_GT(fronts, 500);
}

TEST(HitInterval, OfPathsLeavesOutTheBacksOfCulledTriangles) {
    expect_fronts_count("triangle_ray", cases_per_kind, triangle_ray);
}

TEST(HitInterval, OfPathsLeavesOutTheBacksOfCulledQuads) {
    expect_fronts_count("quad_ray", cases_per_kind / 2, quad_ray);
}

// A ShadowSource is for scenes without culled faces; a CulledShadowSource passes their backs.
TEST(HitInterval, OfShadowRaysDependsOnTheirSource) {
    for (std::uint64_t number = 0; number < 1000; ++number) {
        auto [quad, ray] = quad_ray(0, number);
        const StructureFrame frame = make_structure_frame(bounds(quad));
        const Proposal<float> proposal = propose(ray, frame, true);
        if (!proposal.active) continue;
        const QueryRay query = make_query_ray(proposal, frame, NoSource{});
        quad.attributes.sides = FaceSides::culled;
        const HitInterval both = hit_interval(query, quad, false);
        const HitInterval shadow = hit_interval_from<float, Quad>(ShadowSource<float>{}, 7U, query, quad);
        ASSERT_EQ(shadow.lo, both.lo) << "quad_ray(0, " << number << ")";
        ASSERT_EQ(shadow.hi, both.hi) << "quad_ray(0, " << number << ")";
        const HitInterval front = hit_interval(query, quad, true);
        CulledShadowSource<float> source;
        const HitInterval culled = hit_interval_from<float, Quad>(source, 7U, query, quad);
        ASSERT_EQ(culled.lo, front.lo) << "quad_ray(0, " << number << ")";
        ASSERT_EQ(culled.hi, front.hi) << "quad_ray(0, " << number << ")";
        source.light = 7;
        ASSERT_EQ((hit_interval_from<float, Quad>(source, 7U, query, quad).lo), certain_miss.lo);
    }
}

template <class Body>
struct BodyCase {
    Body body;
    Ray<float> ray;
};

/// A body that is turned, stretched up to 1 : 1000, of any size, near the origin or far from it; and a ray near it.
template <class Body>
BodyCase<Body> body_case(int kind, std::uint64_t number) {
    Random random(number * 8 + static_cast<std::uint64_t>(kind));
    const auto turn = [&] {
        return rotation_matrix({random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.3});
    };
    const double size = std::exp2(kind == 3 ? random.uniform(-60.0, 50.0) : random.uniform(-10.0, 10.0));
    const double a = size, b = size * random.uniform(0.1, 1.0), c = size * std::exp2(random.uniform(-10.0, 0.0));
    const Matrix3 world = turn() * Matrix3{{{a, 0, 0}, {0, b, 0}, {0, 0, c}}} * turn();
    Body body;
    body.object_from_world = inverse(world);
    body.centre = test::any_unit(random) * (size * (kind == 1 ? std::exp2(random.uniform(0.0, 20.0)) : 1));
    const double radius = size * std::sqrt(3.0) * 1.01;
    body.bounding_sphere = {narrow(body.centre),
                            static_cast<float>(radius * (1 + 1e-6 * (1 + norm1(body.centre) / size)))};
    body.half_extent = {radius, radius, radius};
    // a point of the unit sphere or of the cube's edge, or near it
    const auto sign = [&] { return random.coin() ? 1.0 : -1.0; };
    const Vec3d edge = {sign(), sign(), random.uniform(-1.0, 1.0)};
    const double aside = random.coin() ? 1 : random.uniform(0.8, 1.2);
    const Vec3d target = body.centre + world * ((random.coin() ? test::any_unit(random) : edge) * aside);
    const double distance = size * std::exp2(random.uniform(-3.0, kind == 2 ? 20.0 : 6.0));
    const Vec3d origin = random.below(8) == 0 ? body.centre : target + test::any_unit(random) * distance;
    const double length = std::exp2(random.uniform(-20.0, 20.0));
    return {body, {narrow(origin), narrow(normalize(target - widen(narrow(origin))) * length)}};
}

TEST(HitInterval, OfEllipsoids) {
    const Counts counts =
        check_cases(4, 2 * cases_per_kind, "body_case<Ellipsoid>",
                    [](int kind, std::uint64_t number) { return body_case<Ellipsoid>(kind, number); });
    expect_sharp(counts, 0.6, 0.4);  // half of the rays aim at edges or graze
}

TEST(HitInterval, OfParallelepipeds) {
    const auto make = [](int kind, std::uint64_t number) { return body_case<Parallelepiped>(kind, number); };
    const Counts counts = check_cases(4, 2 * cases_per_kind, "body_case<Parallelepiped>", make);
    expect_sharp(counts, 0.6, 0.4);  // half of the rays aim at edges or graze
}

// Sizes, distances and lengths over nearly all magnitudes that a scene may hold, each on its own: products under- and
// overflow here, but no t in float, in which proposals move origins.
TEST(HitInterval, HoldsOverAllMagnitudes) {
    Counts counts;
    for (std::uint64_t number = 0; number < 60000; ++number) {
        Random random(number);
        const auto any_point = [&](double lower, double upper) {
            return test::any_unit(random) * std::exp2(random.uniform(lower, upper));
        };
        const Vec3d centre = random.coin() ? Vec3d{0, 0, 0} : any_point(-60, 58);
        const double size = std::exp2(random.uniform(-60.0, 58.0));
        const Vec3d origin =
            random.coin() ? centre + test::any_unit(random) * (size * random.uniform(0.0, 3.0)) : any_point(-60, 58);
        const Vec3d target = centre + test::any_unit(random) * (size * random.uniform(0.9, 1.0));
        const double length = std::exp2(random.uniform(-140.0, 50.0));
        const Ray<float> ray = {narrow(origin), narrow(normalize(target - origin) * length)};
        if (!is_traceable(ray)) continue;
        const auto where = "magnitudes " + std::to_string(number) + ", " + test::reproducer(ray);
        const Sphere sphere = {narrow(centre), static_cast<float>(size)};
        check(sphere, ray, exact_hit(sphere, ray), false, random, where, counts);
        const Vec3d half = {size * random.uniform(0.0, 1.0), size, size * random.uniform(0.0, 1.0)};
        const Box box = {narrow(centre - half), narrow(centre + half)};
        check(box, ray, exact_hit(box, ray), false, random, where, counts);
        const Vec3d along = test::any_unit(random) * (size * random.uniform(0.0, 1.0));
        const Vec3d aside = test::any_unit(random) * (size * std::exp2(random.uniform(-20.0, 0.0)));
        const Triangle triangle = {narrow(target - along), narrow(target + along), narrow(target + aside)};
        check(triangle, ray, exact_hit(triangle, ray), false, random, where, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.sure, 1000) << counts.hits;
}

TEST(HitInterval, OfNanIsUnsure) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto expect_unsure = [](const HitInterval& interval) {
        EXPECT_EQ(interval.lo, 0.0F);
        EXPECT_TRUE(std::isinf(interval.hi));
    };
    for (const QueryRay& ray : {QueryRay{{nan, 0, -3}, {0, 0, 1}, 1e-30F}, QueryRay{{0, 0, -3}, {0, 0, 1}, nan}}) {
        for (const bool own : {false, true}) {
            expect_unsure(hit_interval(ray, Sphere{{0, 0, 0}, 1}, own));
            expect_unsure(hit_interval(ray, Box{{-1, -1, -1}, {1, 1, 1}}, own));
            expect_unsure(hit_interval(ray, Triangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, false));
            Placement body{{}, {0, 0, 0}, {{0, 0, 0}, 2}, {1, 1, 1}};
            expect_unsure(hit_interval(ray, Ellipsoid{body}, own));
            expect_unsure(hit_interval(ray, Parallelepiped{body}, own));
        }
    }
    // the side of a culled face depends on the direction alone
    expect_unsure(hit_interval({{0, 0, -3}, {0, 0, nan}, 1e-30F}, Triangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, true));
}

}  // namespace
}  // namespace tandem

// Texture coordinates against their definitions, and the directions in which they grow against the coordinates
// themselves: a ray that is moved along the surface sees them change.
#include "tandem/kernel/shapes/parametrisation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/aim.h"
#include "support/random.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/tangent_frame.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

using test::any_unit;
using test::Random;

/// The coordinates where a line at `target` first meets the body from the side of `outside`; it must.
template <class Body>
Parametrisation<double> seen(const Body& body, const Vec3d& target, const Vec3d& outside,
                             const Vec2f* texcoords = nullptr) {
    const Ray<double> ray = {target + outside, -outside};
    double t = 0;
    EXPECT_TRUE(first_hit(body, ray, t));
    return parametrisation(body, record_hit(body, ray, t, false, true), texcoords, ray, t, true);
}

/// du and dv by moving the target; `normal` at the target.
template <class Body>
void expect_directions(const Body& body, const Vec3d& target, const Vec3d& normal, std::uint64_t number,
                       const Vec2f* texcoords = nullptr, bool mirrored = false) {
    const Parametrisation<double> here = seen(body, target, normal, texcoords);
    const double step = 1e-6;
    const auto change = [&](const Vec3d& direction) {
        const Vec3d flat = normalize(direction - normal * dot(normal, direction)) * step;
        const auto moved = seen(body, target + flat, normal, texcoords);
        return Vec2f(static_cast<float>((moved.u - here.u) / step), static_cast<float>((moved.v - here.v) / step));
    };
    const Vec2f along_u = change(here.dp_du);
    const Vec2f along_v = change(here.dp_dv);
    EXPECT_GT(along_u.x, 0) << "case " << number;
    EXPECT_NEAR(along_u.y, 0, 1e-3 * double{along_u.x}) << "case " << number;
    EXPECT_GT(along_v.y, 0) << "case " << number;
    EXPECT_NEAR(along_v.x, 0, 1e-3 * double{along_v.y}) << "case " << number;
    // not mirrored: right times up points outward
    const Frame<double> frame = tangent_frame(normal, here.dp_du, here.dp_dv);
    EXPECT_NEAR(dot(cross(frame.tangent, frame.bitangent), normal), mirrored ? -1 : 1, 1e-12) << "case " << number;
    EXPECT_NEAR(dot(frame.tangent, frame.tangent), 1, 1e-12);
    EXPECT_GT(dot(frame.tangent, here.dp_du), 0);
    EXPECT_LT(dot(frame.bitangent, here.dp_dv), 0);
}

TEST(Parametrisation, OfASphereIsTheGlobe) {
    const Sphere ball = {{1, 2, 3}, 0.5F};
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        Random random(number);
        const Vec3d n = any_unit(random);
        const Parametrisation<double> found = seen(ball, Vec3d{1, 2, 3} + n * 0.5, n);
        EXPECT_NEAR(found.u, 0.5 + std::atan2(n.x, n.z) / (2 * pi), 1e-12 / (1 - std::abs(n.y))) << "case " << number;
        EXPECT_NEAR(found.v, std::acos(n.y) / pi, 1e-12 / (1 - std::abs(n.y))) << "case " << number;
    }
    const auto at = [&](const Vec3d& n) { return seen(ball, Vec3d{1, 2, 3} + n * 0.5, n); };
    EXPECT_EQ(at({0, 0, 1}).u, 0.5);
    EXPECT_EQ(at({0, 0, 1}).v, 0.5);
    EXPECT_EQ(at({1, 0, 0}).u, 0.75) << "to the east, seen from outside";
    EXPECT_EQ(at({-1, 0, 0}).u, 0.25);
    EXPECT_EQ(at({0, 1, 0}).v, 0) << "the top of the picture";
    EXPECT_EQ(at({0, -1, 0}).v, 1);
}

TEST(Parametrisation, OfASphereHasAFrameAtThePoles) {
    const Sphere ball = {{0, 0, 0}, 2};
    for (const double side : {1.0, -1.0}) {
        const Vec3d pole = {0, side, 0};
        const Parametrisation<double> found = seen(ball, pole * 2.0, pole);
        EXPECT_EQ(found.u, 0.5);
        const Frame<double> frame = tangent_frame(pole, found.dp_du, found.dp_dv);
        EXPECT_EQ(frame.tangent, Vec3d(1, 0, 0));
        EXPECT_EQ(frame.bitangent, Vec3d(0, 0, -side));
        // the limit along longitude 0
        const Parametrisation<double> beside = seen(ball, Vec3d{0, side * 2, 1e-6}, pole);
        const Frame<double> limit = tangent_frame(pole, beside.dp_du, beside.dp_dv);
        EXPECT_LT(norm1(limit.tangent - frame.tangent) + norm1(limit.bitangent - frame.bitangent), 1e-5);
    }
}

TEST(Parametrisation, GrowsWhereItsDirectionsSay) {
    for (std::uint64_t number = 0; number < 300; ++number) {
        Random random(number);
        const Vec3d n = any_unit(random);
        if (std::abs(n.y) > 0.95 || (n.z < 0 && std::abs(n.x) < 0.05)) continue;  // poles and seam
        expect_directions(Sphere{{1, 2, 3}, 1}, Vec3d{1, 2, 3} + n, n, number);
    }
}

/// The unit ball or cube under a node's transform, of a textured material or not.
PreparedScene placed(const Shape& shape, const Transform& world_from_node) {
    Scene scene;
    scene.materials.emplace_back();
    Node body;
    body.matrix = world_from_node;
    body.geometry.push_back({shape, 0, {}});
    Node eye;
    eye.camera = PerspectiveCamera{};
    scene.nodes = {body, eye};
    return prepare(scene, {.origin = Vec3d{0, 0, 0}});
}

Transform skewed(Random& random) {
    const Matrix3 turn = rotation_matrix(
        {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.2, 1.0)});
    const Matrix3 scale = {{{random.uniform(0.5, 2.0), 0.3, 0}, {0, random.uniform(0.5, 2.0), 0}, {0, 0.2, 1}}};
    return {turn * scale, {random.uniform(-3.0, 3.0), 1, 2}};
}

TEST(Parametrisation, OfAnEllipsoidIsThatOfItsSphere) {
    const Sphere unit = {{0, 0, 0}, 1};
    for (std::uint64_t number = 0; number < 300; ++number) {
        Random random(number);
        const Transform world_from_node = skewed(random);
        const PreparedScene scene = placed(SphereShape{1}, world_from_node);
        ASSERT_EQ(scene.ellipsoids.size(), 1U);
        const Ellipsoid& body = scene.ellipsoids[0];
        const Vec3d n = any_unit(random);
        if (std::abs(n.y) > 0.95 || (n.z < 0 && std::abs(n.x) < 0.05)) continue;
        const Vec3d target = transform_point(world_from_node, n);
        const Vec3d normal = to_world_normal<double>(body, n);
        const Parametrisation<double> own = seen(unit, n, n);
        const Parametrisation<double> found = seen(body, target, normal);
        EXPECT_NEAR(found.u, own.u, 1e-12) << "case " << number;
        EXPECT_NEAR(found.v, own.v, 1e-12) << "case " << number;
        expect_directions(body, target, normal, number);
    }
}

struct FaceCase {
    Vec3d normal, right, down;
};
constexpr double O = 0;
/// Each face of a box as its picture lies on it.
const FaceCase face_cases[] = {{{1, O, O}, {O, O, -1}, {O, -1, O}}, {{-1, O, O}, {O, O, 1}, {O, -1, O}},
                               {{O, 1, O}, {1, O, O}, {O, O, 1}},   {{O, -1, O}, {1, O, O}, {O, O, -1}},
                               {{O, O, 1}, {1, O, O}, {O, -1, O}},  {{O, O, -1}, {-1, O, O}, {O, -1, O}}};

TEST(Parametrisation, OfABoxIsASquareOnEachFace) {
    const Box box = {{-1, -2, -4}, {1, 2, 4}};
    const Vec3d half = {1, 2, 4};
    for (const FaceCase& face : face_cases) {
        for (const double u : {0.125, 0.5, 0.75}) {
            for (const double v : {0.25, 0.5, 0.875}) {
                const Vec3d at = (face.normal + face.right * (2 * u - 1) + face.down * (2 * v - 1)) * half;
                const Parametrisation<double> found = seen(box, at, face.normal);
                EXPECT_EQ(found.u, u);
                EXPECT_EQ(found.v, v);
                EXPECT_EQ(found.dp_du, face.right);
                EXPECT_EQ(found.dp_dv, face.down);
                expect_directions(box, at, face.normal, 0);
            }
        }
    }
}

TEST(Parametrisation, OfABoxFromWithinIsThatOfTheFaceThatIsSeen) {
    const Box box = {{0, 0, 0}, {1, 1, 1}};
    const Ray<double> ray = {{0.5, 0.5, 0.5}, {1, 0.25, 0}};
    double t = 0;
    ASSERT_TRUE(first_hit(box, ray, t));
    const auto found = parametrisation(box, record_hit(box, ray, t, false, true), nullptr, ray, t, true);
    EXPECT_EQ(found.u, 0.5);
    EXPECT_EQ(found.v, 0.375);
}

TEST(Parametrisation, OfAFlatBoxIsANumber) {
    const Box sheet = {{0, 1, 0}, {1, 1, 1}};
    const auto above = seen(sheet, {0.25, 1, 0.75}, {0, 1, 0});
    EXPECT_EQ(above.u, 0.25);
    EXPECT_EQ(above.v, 0.75);
    const auto edge = seen(sheet, {1, 1, 0.25}, {1, 0, 0});
    EXPECT_EQ(edge.u, 0.75);
    EXPECT_TRUE(edge.v >= 0 && edge.v <= 1);
}

TEST(Parametrisation, OfAParallelepipedIsThatOfItsBox) {
    for (std::uint64_t number = 0; number < 200; ++number) {
        Random random(number);
        const Transform world_from_node = skewed(random);
        const PreparedScene scene = placed(BoxShape{{2, 2, 2}}, world_from_node);
        ASSERT_EQ(scene.parallelepipeds.size(), 1U);
        const Parallelepiped& body = scene.parallelepipeds[0];
        const FaceCase& face = face_cases[random.below(6)];
        const double u = random.uniform(0.1, 0.9);
        const double v = random.uniform(0.1, 0.9);
        const Vec3d target =
            transform_point(world_from_node, face.normal + face.right * (2 * u - 1) + face.down * (2 * v - 1));
        const Vec3d normal = to_world_normal<double>(body, face.normal);
        const auto found = seen(body, target, normal);
        EXPECT_NEAR(found.u, u, 1e-12) << "case " << number;
        EXPECT_NEAR(found.v, v, 1e-12) << "case " << number;
        expect_directions(body, target, normal, number);
    }
}

Vec3f any_corner(Random& random) {
    return {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
}
Vec2f any_texcoord(Random& random) { return {random.uniform(-3.0F, 3.0F), random.uniform(-3.0F, 3.0F)}; }

TEST(Parametrisation, OfATriangleIsLinear) {
    for (std::uint64_t number = 0; number < 2'000; ++number) {
        Random random(number);
        Triangle face = {any_corner(random), any_corner(random), any_corner(random), {}};
        const Vec3d e1 = widen(face.v1) - widen(face.v0);
        const Vec3d e2 = widen(face.v2) - widen(face.v0);
        if (norm1(cross(e1, e2)) < 0.1) continue;
        const bool own = random.coin();
        const Vec2f texcoords[] = {{9, 9}, any_texcoord(random), any_texcoord(random), any_texcoord(random)};
        if (!own) face.attributes.texcoords = 1;
        const double a = random.uniform(0.05, 0.9);
        const double b = random.uniform(0.02, 0.95 - a);
        const Vec3d target = widen(face.v0) + e1 * a + e2 * b;
        const Vec3d normal = triangle_normal(face.v0, face.v1, face.v2);
        const auto found = seen(face, target, normal, texcoords);
        const Vec2f* t = texcoords + 1;
        EXPECT_NEAR(found.u, own ? a : t[0].x + a * (t[1].x - t[0].x) + b * (t[2].x - t[0].x), 2e-6)
            << "case " << number;
        EXPECT_NEAR(found.v, own ? b : t[0].y + a * (t[1].y - t[0].y) + b * (t[2].y - t[0].y), 2e-6)
            << "case " << number;
        const double area =
            double{t[1].x - t[0].x} * double{t[2].y - t[0].y} - double{t[2].x - t[0].x} * double{t[1].y - t[0].y};
        if (own || std::abs(area) < 0.3) continue;
        // on its front v runs down where the corners run round the other way
        expect_directions(face, target, normal, number, texcoords, area > 0);
    }
}

TEST(Parametrisation, OfAFaceWithoutAnAreaOnThePictureStillHasAFrame) {
    const Vec2f same[] = {{0.5F, 0.5F}, {0.5F, 0.5F}, {0.5F, 0.5F}};
    Triangle face = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {}};
    face.attributes.texcoords = 0;
    const auto found = seen(face, {0.25, 0.25, 0}, {0, 0, 1}, same);
    const Frame<double> frame = tangent_frame(Vec3d{0, 0, 1}, found.dp_du, found.dp_dv);
    EXPECT_EQ(found.u, 0.5);
    EXPECT_EQ(dot(frame.tangent, frame.tangent), 1);
    EXPECT_EQ(dot(frame.tangent, frame.normal), 0);
    EXPECT_EQ(dot(frame.bitangent, frame.bitangent), 1);
}

TEST(Parametrisation, OfAQuadIsTheSquareOrWhatItsCornersSay) {
    Quad face = {{0, 0, 0}, {2, 0, 0}, {2, 4, 0}, {0, 4, 0}, {}};
    const Vec2f texcoords[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // upright, as glTF has it
    for (std::uint64_t number = 0; number < 500; ++number) {
        Random random(number);
        const double a = random.uniform(0.01, 0.98);
        const double b = random.uniform(0.01, 0.98);
        face.attributes.texcoords = no_attributes;
        const auto own = seen(face, {2 * a, 4 * b, 0}, {0, 0, 1});
        EXPECT_NEAR(own.u, a, 5e-7) << "case " << number;
        EXPECT_NEAR(own.v, b, 5e-7) << "case " << number;
        face.attributes.texcoords = 0;
        const auto upright = seen(face, {2 * a, 4 * b, 0}, {0, 0, 1}, texcoords);
        EXPECT_NEAR(upright.u, a, 5e-7) << "case " << number;
        EXPECT_NEAR(upright.v, 1 - b, 5e-7) << "case " << number;
        expect_directions(face, {2 * a, 4 * b, 0}, {0, 0, 1}, number, texcoords);
    }
}

TEST(Parametrisation, GivesPacketsTheBitsOfSingleRays) {
    using Packet = Lanes<float, Sse4>;
    using LaneMaskOf = Mask<Packet>;
    const Quad quad = {{0, 0, 0}, {2, 0, 0}, {2, 2, 1}, {0, 2, 0}, {}};
    const Sphere ball = {{1, 1, 0}, 1.5F};
    const Box box = {{0, 0, -1}, {2, 2, 1}};
    const auto compare = [&](const auto& body, std::uint64_t number) {
        Random random(number);
        const auto any = [&](int) { return random.uniform(0.3F, 1.7F); };
        const Ray<Packet> rays = {
            {Packet::from(any), Packet::from(any), Packet(9.0F)},
            {Packet(0.0F), Packet::from([&](int) { return random.uniform(-0.01F, 0.01F); }), Packet(-1.0F)}};
        Double<Packet> t;
        ASSERT_TRUE(all(first_hit(body, rays, t)));
        const auto found =
            parametrisation<Packet>(body, record_hit<Packet>(body, rays, t, LaneMaskOf(false), LaneMaskOf(true)),
                                    nullptr, rays, t, LaneMaskOf(true));
        for (int i = 0; i < Packet::size; ++i) {
            const Ray<float> ray = {{rays.origin.x[i], rays.origin.y[i], rays.origin.z[i]},
                                    {rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]}};
            const auto single =
                parametrisation<float>(body, record_hit<float>(body, ray, t[i], false, true), nullptr, ray, t[i], true);
            ASSERT_EQ(found.u[i], single.u) << "case " << number;
            ASSERT_EQ(found.v[i], single.v) << "case " << number;
            ASSERT_EQ(found.dp_du.z[i], single.dp_du.z) << "case " << number;
            ASSERT_EQ(found.dp_dv.y[i], single.dp_dv.y) << "case " << number;
        }
    };
    for (std::uint64_t number = 0; number < 2'000; ++number) {
        compare(quad, number);
        compare(ball, number);
        compare(box, number);
    }
}

}  // namespace
}  // namespace tandem

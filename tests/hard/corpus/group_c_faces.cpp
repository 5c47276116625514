// Group C: rays and triangles and quads. The oracle is exact arithmetic on the same floats, and closed meshes must not
// leak. Contraction (C3) is tested by tests/lint: no exact build may contract.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "support/adversarial_triangles.h"
#include "support/exact_geometry.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/icosphere.h"

namespace tandem::hard {

namespace {

using test::any_across;
using test::any_unit;

constexpr const char* exact = "exact arithmetic";
constexpr const char* closed = "a closed mesh; exact arithmetic";

Scene scene_of(Mesh mesh) {
    Scene scene = hard::scene_of(std::vector<Sphere>{});
    mesh.normals.clear();
    mesh.texcoords.clear();
    scene.meshes.push_back(std::move(mesh));
    Node node{.name = "mesh"};
    node.geometry.push_back({MeshShape{0}, 0, {}});
    scene.nodes.push_back(std::move(node));
    return scene;
}

Mesh mesh_of(const std::vector<Triangle>& triangles) {
    Mesh mesh;
    for (const Triangle& triangle : triangles) {
        for (const Vec3f& corner : {triangle.v0, triangle.v1, triangle.v2}) {
            mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(corner);
        }
    }
    return mesh;
}

/// Triangles one by one, `rays` shared among them; make_triangle() and then make_ray(triangle).
template <class MakeTriangle, class MakeRay>
std::vector<RayBatch> one_by_one(std::size_t count, std::size_t rays, MakeTriangle make_triangle, MakeRay make_ray) {
    std::vector<RayBatch> batches;
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle triangle = make_triangle();
        batches.push_back({scene_of(mesh_of({triangle})), make_rays(rays / count, [&] { return make_ray(triangle); })});
    }
    return batches;
}

Vec3d in_ball(Random& random, double radius) { return any_unit(random) * (radius * random.uniform(0.0, 1.0)); }

Triangle any_triangle(Random& random) {
    return {narrow(in_ball(random, 1)), narrow(in_ball(random, 1)), narrow(in_ball(random, 1))};
}

struct Ball {
    double radius;
    Vec3d centre;
};

/// 1280 triangles; rays from inside at points of edges, or at vertices.
std::vector<RayBatch> from_inside(Random& random, std::size_t rays, const std::vector<Ball>& balls, bool at_vertices) {
    std::vector<RayBatch> batches;
    for (const Ball& ball : balls) {
        Mesh mesh = icosphere(3);
        for (Vec3f& p : mesh.positions) p = narrow(ball.centre + widen(p) * ball.radius);
        const auto any_corner = [&](std::uint32_t face, std::uint32_t i) {
            return widen(mesh.positions[mesh.triangles[3 * face + i % 3]]);
        };
        batches.push_back({scene_of(mesh), make_rays(rays / balls.size(), [&] {
                               const Vec3f from = narrow(ball.centre + in_ball(random, 0.8 * ball.radius));
                               const std::uint32_t face =
                                   random.below(static_cast<std::uint32_t>(mesh.triangles.size() / 3));
                               const std::uint32_t side = random.below(3);
                               const double part = at_vertices ? 0 : random.uniform(0.0, 1.0);
                               const Vec3d target =
                                   any_corner(face, side) * (1 - part) + any_corner(face, side + 1) * part;
                               return Ray<float>{from, narrow(target - widen(from))};
                           })});
    }
    return batches;
}

const std::vector<Ball> ordinary_balls = {{1, {0, 0, 0}}, {1, {10, -20, 30}}, {1, {1e4, 2e4, -3e4}}};

std::vector<RayBatch> edges(Random& random, std::size_t rays) {
    return from_inside(random, rays, ordinary_balls, false);
}
std::vector<RayBatch> vertices(Random& random, std::size_t rays) {
    return from_inside(random, rays, ordinary_balls, true);
}
std::vector<RayBatch> small_mesh(Random& random, std::size_t rays) {
    return from_inside(random, rays, {{1e-4, {0, 0, 0}}, {1e-20, {0, 0, 0}}, {1e-4, {0.1, 0.1, 0}}}, false);
}

/// A sphere of 384 quads, none of them flat: the faces of a cube, of 8 x 8 cells, projected to a sphere. Shared corners
/// are equal.
Mesh sphere_of_quads() {
    constexpr int cells = 8;
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, side = face % 2 == 0 ? -cells : cells;
        for (int cell = 0; cell < cells * cells; ++cell) {
            const int column = cell % cells, row = cell / cells;
            // counter-clockwise from outside
            static constexpr int corners[2][4][2] = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}},
                                                     {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
            for (const auto& corner : corners[face % 2]) {
                Vec3d p;
                p[axis] = side;
                p[(axis + 1) % 3] = 2 * (column + corner[0]) - cells;
                p[(axis + 2) % 3] = 2 * (row + corner[1]) - cells;
                mesh.quads.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                mesh.positions.push_back(narrow(normalize(p)));
            }
        }
    }
    return mesh;
}

/// From inside at edges, at diagonals and, every fourth ray, at a corner.
RayBatch from_inside_quads(Random& random, std::size_t rays) {
    Mesh mesh = sphere_of_quads();
    return {scene_of(mesh), make_rays(rays, [&] {
                const std::uint32_t quad = 4 * random.below(static_cast<std::uint32_t>(mesh.quads.size() / 4));
                const std::uint32_t first = random.below(4), second = random.coin() ? first ^ 2U : (first + 1) % 4;
                const double part = random.below(4) == 0 ? 0 : random.uniform(0.0, 1.0);
                const Vec3f from = narrow(in_ball(random, 0.8));
                const Vec3d target =
                    widen(mesh.positions[quad + first]) * (1 - part) + widen(mesh.positions[quad + second]) * part;
                return Ray<float>{from, narrow(target - widen(from))};
            })};
}

/// 200 times as many rays as requested: ten million where other cases have 50,000. Only misses are wrong.
Score many_rays(const Subject& subject, Random& random, std::size_t rays) {
    constexpr std::size_t blocks = 50;
    Score score;
    for (std::size_t block = 0; block < blocks; ++block) {
        std::vector<RayBatch> batches = from_inside(random, rays, ordinary_balls, block % 2 == 0);
        batches.push_back(from_inside_quads(random, 3 * rays));
        for (const RayBatch& batch : batches) {
            std::vector<Hit> hits(batch.rays.size());
            const auto scene = subject.backend.load(prepare(batch.scene, {.origin = Vec3d{0, 0, 0}}), subject.tier);
            score.seconds += subject.backend.trace(*scene, TraceJob{.rays = batch.rays, .hits = hits});
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const bool leak = hits[i].primitive == no_primitive;
                score.leaks += leak;
                score.decide(leak, [&] { return to_literal(batch.rays[i]) + " leaves a closed mesh"; });
            }
        }
    }
    return score;
}

/// Triangles a hundred thousand times as long as wide.
std::vector<RayBatch> needles(Random& random, std::size_t rays) {
    return one_by_one(
        16, rays,
        [&] {
            const Vec3d a = in_ball(random, 1), along = any_unit(random);
            const Vec3d across = any_across(random, along) * 1e-5;
            return Triangle{narrow(a), narrow(a + along), narrow(a + along * random.uniform(0.0, 1.0) + across)};
        },
        [&](const Triangle& triangle) {
            const Vec3f from = narrow(any_unit(random) * random.uniform(2.0, 10.0));
            return Ray<float>{from, narrow(test::point_of(random, triangle) - widen(from))};
        });
}

/// Rays within 1e-4 to 1e-10 radians of the plane.
std::vector<RayBatch> grazing(Random& random, std::size_t rays) {
    return one_by_one(
        16, rays, [&] { return any_triangle(random); },
        [&](const Triangle& triangle) {
            const Vec3d normal = triangle_normal(triangle.v0, triangle.v1, triangle.v2);
            const Vec3d target = test::point_of(random, triangle);
            const double angle = std::pow(10.0, random.uniform(-10.0, -4.0)) * (random.coin() ? 1 : -1);
            const Vec3d along = any_across(random, normal) + normal * angle;
            const Vec3f from = narrow(target - along * random.uniform(0.5, 10.0));
            return Ray<float>{from, narrow(target - widen(from))};
        });
}

/// A triangle of 2000 km, seen from 1.7 m above it.
std::vector<RayBatch> ground(Random& random, std::size_t rays) {
    int tilted = 0;
    return one_by_one(
        2, rays,
        [&] {
            const float rise = static_cast<float>(tilted++) * 700.0F;
            return Triangle{{-1e6F, -rise, -1e6F}, {0, 0, 1e6F}, {1e6F, rise, -1e6F}};
        },
        [&](const Triangle&) {
            const double elevation = -std::pow(10.0, random.uniform(-6.0, 0.0));
            const double azimuth = random.uniform(0.0, 6.28);
            return Ray<float>{{0, 1.7F, 0}, narrow(Vec3d{std::cos(azimuth), elevation, std::sin(azimuth)})};
        });
}

std::vector<RayBatch> just_above(Random& random, std::size_t rays) {
    return one_by_one(
        16, rays, [&] { return any_triangle(random); },
        [&](const Triangle& triangle) {
            const Vec3d normal = triangle_normal(triangle.v0, triangle.v1, triangle.v2);
            const Vec3d over = test::point_of(random, triangle) + normal * std::pow(10.0, random.uniform(-8.0, -5.0));
            return Ray<float>{narrow(over), narrow(any_unit(random) - normal * random.uniform(0.0, 3.0))};
        });
}

/// Degenerate faces are dropped and counted, and no others.
Score flat_faces(Random& random, std::size_t calls) {
    Score score;
    std::vector<Triangle> triangles;
    std::size_t flat = 0;
    for (std::uint64_t number = 0; number < calls; ++number) {
        // collinear and with equal corners; almost collinear; needles; anything
        static constexpr int kinds[] = {10, 11, 5, 0};
        const Triangle t = test::triangle_case(kinds[random.below(4)], number).triangle;
        triangles.push_back(t);
        const auto normal = test::cross(test::big(t.v1) - test::big(t.v0), test::big(t.v2) - test::big(t.v0));
        flat += normal.x == 0 && normal.y == 0 && normal.z == 0;
    }
    const PreparedScene scene = prepare(scene_of(mesh_of(triangles)), {.origin = Vec3d{0, 0, 0}});
    score.decide(scene.dropped_primitives != flat || scene.triangles.size() != triangles.size() - flat,
                 fmt::format("{} of {} faces are flat, {} were dropped", flat, calls, scene.dropped_primitives));
    for (const Triangle& t : scene.triangles) {
        const Vec3d normal = triangle_normal(t.v0, t.v1, t.v2);
        const double length = std::sqrt(dot(normal, normal));
        score.nans += std::isnan(length);
        score.decide(!(std::abs(length - 1) < 1e-12), [&] { return test::reproducer(t); });
    }
    return score;
}

/// Flat, folded and crossed quads, and quads with a repeated corner; integers, so that rays hit diagonals exactly.
std::vector<RayBatch> quads(Random& random, std::size_t rays) {
    Mesh mesh;
    for (int i = 0; i < 64; ++i) {
        const Vec3f place = {static_cast<float>(i % 8 * 8), static_cast<float>(i / 8 * 8), 0};
        const auto height = [&] { return static_cast<float>(random.below(5)) - 2; };
        Vec3f corners[4] = {{0, 0, height()}, {6, 0, height()}, {6, 6, height()}, {0, 6, height()}};
        if (i % 4 == 1) std::swap(corners[1], corners[2]);  // a bow tie
        if (i % 4 == 2) corners[3] = corners[i % 3];        // a corner twice
        for (const Vec3f& corner : corners) {
            mesh.quads.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(place + corner);
        }
    }
    return {{scene_of(mesh), make_rays(rays, [&] {
                 const std::uint32_t quad = random.below(64);
                 const Vec3f v0 = mesh.positions[4 * quad], v2 = mesh.positions[4 * quad + 2];
                 const float part = static_cast<float>(random.below(33)) / 32;
                 Vec3f target = v0 + (v2 - v0) * part;
                 if (random.coin()) target = target + narrow(in_ball(random, 3));
                 const Vec3f from = {static_cast<float>(random.below(64)), static_cast<float>(random.below(64)), 32};
                 return Ray<float>{from, target - from};
             })}};
}

/// Overlapping faces in one plane, level or tilted, that touch at corners: the lowest id. Integers.
std::vector<RayBatch> coplanar(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const int slope : {0, 1}) {
        Mesh mesh;
        const auto corner = [&] {
            const auto x = static_cast<float>(random.below(65)), y = static_cast<float>(random.below(65));
            return Vec3f{x, y, static_cast<float>(slope) * (x - 2 * y)};
        };
        for (std::uint32_t i = 0; i < 3 * 64; ++i) {
            mesh.triangles.push_back(i);
            mesh.positions.push_back(corner());
        }
        batches.push_back(
            {scene_of(mesh), make_rays(rays / 2, [&] {
                 Vec3f target = mesh.positions[random.below(3 * 64)];
                 if (random.coin()) target = (target + mesh.positions[random.below(3 * 64)]) * 0.5F;
                 const Vec3f from = {static_cast<float>(random.below(64)), static_cast<float>(random.below(64)), 512};
                 return Ray<float>{from, target - from};
             })});
    }
    return batches;
}

/// u and v within [0, 1], u + v too, and within 2^-22 of the exact ones: at edges, at vertices, grazing, everywhere.
Score coordinates(Random&, std::size_t calls) {
    Score score;
    for (std::uint64_t number = 0; number < calls; ++number) {
        const test::TriangleCase c = test::triangle_case(static_cast<int>(number % 9), number);
        const Triangle& t = c.triangle;
        const auto right = test::hit_triangle(test::big(c.ray.origin), test::big(c.ray.direction), test::big(t.v0),
                                              test::big(t.v1), test::big(t.v2));
        if (!right || !is_traceable(c.ray)) continue;
        const auto at = barycentrics(t.v0, t.v1, t.v2, c.ray, true);
        const auto line = [&] { return test::reproducer(t) + ", " + to_literal(c.ray); };
        score.nans += std::isnan(at.u + at.v);
        score.decide(!(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1), line);
        const test::Big off = std::max<test::Big>(abs(right->u - test::Big(at.u)), abs(right->v - test::Big(at.v)));
        score.measure(static_cast<double>(off) * 0x1p22, line);
    }
    return score;
}

}  // namespace

std::vector<HardCase> face_cases() {
    return {
        {"C1", "Edges of a closed mesh of 1280 triangles",
         "both triangles round, and one ray in ten passes between them", closed, RayCase{edges, true}},
        {"C2", "Vertices of the same mesh",
         "six triangles round; even the Moeller-Trumbore test in double loses 0.09 %", closed, RayCase{vertices, true}},
        {"C4", "The same mesh at sizes of 10^-4 and 10^-20",
         "an absolute epsilon on the determinant loses the whole mesh", closed, RayCase{small_mesh, true}},
        {"C5", "Needle triangles, 1 : 100,000", "edge functions are smaller than their rounding errors", exact,
         RayCase{needles}},
        {"C6", "Rays within 10^-4 radians of the plane",
         "the determinant is rounding noise: t is off by half of itself", exact, RayCase{grazing}},
        {"C7", "A ground triangle of 2000 km, seen from 1.7 m",
         "t as a mean of the corners' heights cancels: off by 9 %", exact, RayCase{ground}},
        {"C8", "From 10^-5 to 10^-8 above a triangle", "t cancels: its error is larger than itself", exact,
         RayCase{just_above}},
        {"C9", "Degenerate and nearly degenerate faces", "they are hit at random and have a NaN normal",
         "exact arithmetic: dropped and counted", FunctionCase{flat_faces}},
        {"C10", "Quads: flat, folded, crossed, with a repeated corner",
         "code uses the other diagonal, or the diagonal leaks", "exact arithmetic on the two triangles",
         RayCase{quads}},
        {"C11", "Coplanar overlapping triangles", "which one is visible flickers",
         "exact arithmetic; the lowest id at equal t", RayCase{coplanar}},
        {"C12", "Barycentric coordinates at edges and vertices", "u + v is above 1, or u below 0", exact,
         FunctionCase{coordinates}},
        {"C13", "Edges, vertices and diagonals, 200 rays each", "one leak in a million is a bright dot in every image",
         "topology: closed meshes", RenderCase{many_rays}},
    };
}

}  // namespace tandem::hard

// Meshes are watertight: a line through a shared edge or a shared vertex meets at least one of the faces around it.
#include <gtest/gtest.h>

#include <map>

#include "support/random.h"
#include "tandem/kernel/shapes/triangle.h"
#include "tandem/scene/icosphere.h"

namespace tandem {
namespace {

using test::Random;

/// An icosphere scaled and moved, with the faces around each vertex.
struct Ball {
    Ball(int level, double radius, const Vec3d& centre) : mesh(icosphere(level)), faces_at(mesh.positions.size()) {
        for (Vec3f& position : mesh.positions) position = narrow(centre + widen(position) * radius);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) faces_at[mesh.triangles[i]].push_back(i / 3);
    }
    [[nodiscard]] const Vec3f& corner(std::size_t face, std::size_t i) const {
        return mesh.positions[mesh.triangles[3 * face + i % 3]];
    }
    [[nodiscard]] bool is_hit(std::size_t face, const Ray<float>& ray) const {
        double t = 0;
        return first_hit(corner(face, 0), corner(face, 1), corner(face, 2), ray, t);
    }
    Mesh mesh;
    std::vector<std::vector<std::size_t>> faces_at;  ///< by vertex
};

struct Placing {
    const char* name;
    double radius;
    Vec3d centre;
};

class Watertight : public testing::TestWithParam<Placing> {
  protected:
    const Ball ball_{3, GetParam().radius, GetParam().centre};
    static constexpr std::uint64_t rays_ = 200'000;

    /// Somewhere inside.
    Vec3f origin(Random& random) const {
        const Vec3d offset = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
        return narrow(GetParam().centre + offset * GetParam().radius);
    }
};

TEST_P(Watertight, AtVertices) {
    std::uint64_t leaks = 0;
    for (std::uint64_t number = 0; number < rays_; ++number) {
        Random random(number);
        const auto vertex = random.below(static_cast<std::uint32_t>(ball_.mesh.positions.size()));
        const Vec3f from = origin(random);
        const Ray<float> ray = {from, ball_.mesh.positions[vertex] - from};
        bool hit = false;
        for (const std::size_t face : ball_.faces_at[vertex]) hit = hit || ball_.is_hit(face, ray);
        if (!hit && ++leaks <= 3) ADD_FAILURE() << "case " << number << ", vertex " << vertex;
    }
    EXPECT_EQ(leaks, 0U);
}

TEST_P(Watertight, AtEdges) {
    std::uint64_t leaks = 0;
    for (std::uint64_t number = 0; number < rays_; ++number) {
        Random random(number);
        const std::size_t face = random.below(static_cast<std::uint32_t>(ball_.mesh.triangles.size() / 3));
        const std::size_t side = random.below(3);
        const Vec3f from = origin(random);
        const double part = random.uniform(0.1, 0.9);
        const Vec3d target = widen(ball_.corner(face, side)) * part + widen(ball_.corner(face, side + 1)) * (1 - part);
        const Ray<float> ray = {from, narrow(target - widen(from))};
        bool hit = false;
        for (std::size_t end = 0; end < 2; ++end) {
            const std::uint32_t vertex = ball_.mesh.triangles[3 * face + (side + end) % 3];
            for (const std::size_t around : ball_.faces_at[vertex]) hit = hit || ball_.is_hit(around, ray);
        }
        if (!hit && ++leaks <= 3) ADD_FAILURE() << "case " << number << ", face " << face << ", side " << side;
    }
    EXPECT_EQ(leaks, 0U);
}

INSTANTIATE_TEST_SUITE_P(Balls, Watertight,
                         testing::Values(Placing{"unit", 1, {0, 0, 0}}, Placing{"tiny", 1e-4, {0, 0, 0}},
                                         Placing{"aside", 1, {10, -20, 30}}, Placing{"far", 1, {1e4, 2e4, -3e4}},
                                         Placing{"huge", 1e12, {1e12, 0, 0}}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Icosphere, IsClosedAndLooksOutward) {
    for (int level = 0; level < 4; ++level) {
        const Mesh mesh = icosphere(level);
        const std::size_t faces = mesh.triangles.size() / 3;
        EXPECT_EQ(faces, 20U << (2 * level));
        EXPECT_EQ(mesh.positions.size(), 2 + faces / 2);  // Euler
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
            const std::uint32_t* v = &mesh.triangles[i];
            for (std::size_t k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
            const Vec3f &a = mesh.positions[v[0]], &b = mesh.positions[v[1]], &c = mesh.positions[v[2]];
            EXPECT_GT(dot(triangle_normal(a, b, c), widen(a)), 0.7);
        }
        for (const auto& [edge, count] : edges) {
            EXPECT_EQ(count, 1);
            EXPECT_TRUE(edges.contains({edge.second, edge.first}));
        }
        for (const Vec3f& p : mesh.positions) EXPECT_NEAR(dot(widen(p), widen(p)), 1, 3e-7);
    }
}

}  // namespace
}  // namespace tandem

#include "tandem/scene/icosphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "tandem/math/fp_environment.h"

namespace tandem {

Mesh icosphere(int level) {
    const DefaultFpEnvironment guard;
    Mesh mesh;
    mesh.name = fmt::format("icosphere {}", level);
    std::vector<Vec3d> points;
    const auto add = [&](const Vec3d& direction) {
        points.push_back(normalize(direction));
        return static_cast<std::uint32_t>(points.size() - 1);
    };
    // the corners of three golden rectangles
    const double golden = std::numbers::phi;
    for (const double a : {1.0, -1.0}) {
        for (const double b : {golden, -golden}) {
            add({0, a, b});
            add({a, b, 0});
            add({b, 0, a});
        }
    }
    // the faces of the icosahedron join triples of neighbouring corners
    const auto are_neighbours = [&](std::uint32_t i, std::uint32_t k) { return dot(points[i], points[k]) > 0.4; };
    for (std::uint32_t a = 0; a < 12; ++a) {
        for (std::uint32_t b = a + 1; b < 12; ++b) {
            for (std::uint32_t c = b + 1; c < 12; ++c) {
                if (!are_neighbours(a, b) || !are_neighbours(b, c) || !are_neighbours(c, a)) continue;
                const bool outward = dot(points[a], cross(points[b], points[c])) > 0;
                mesh.triangles.insert(mesh.triangles.end(), {a, outward ? b : c, outward ? c : b});
            }
        }
    }
    for (int step = 0; step < level; ++step) {
        std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t i, std::uint32_t k) {
            const auto [known, is_new] = middles.try_emplace({std::min(i, k), std::max(i, k)}, 0);
            if (is_new) known->second = add(points[i] + points[k]);
            return known->second;
        };
        std::vector<std::uint32_t> finer;
        finer.reserve(4 * mesh.triangles.size());
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
            const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        mesh.triangles = std::move(finer);
    }
    for (const Vec3d& point : points) mesh.positions.push_back(narrow(point));
    mesh.normals = mesh.positions;
    return mesh;
}

}  // namespace tandem

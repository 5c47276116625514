#include "tandem/scene/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace tandem {

namespace {

/// For each vertex, the first vertex at the same position.
std::vector<std::uint32_t> welded(const std::vector<Vec3f>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        const Vec3f& p = positions[i];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    std::vector<std::uint32_t> first(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// An edge between two vertices, and whether it runs from the lower index to the higher one.
struct Edge {
    std::uint32_t low, high;
    bool forward;
};

class Walker {
  public:
    explicit Walker(const Mesh& mesh) : mesh_(mesh), vertex_(welded(mesh.positions)) {
        edges_.reserve(mesh.triangles.size() + mesh.quads.size());
    }

    bool run() {
        for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3) walk(&mesh_.triangles[i], 3);
        for (std::size_t i = 0; i < mesh_.quads.size(); i += 4) walk(&mesh_.quads[i], 4);
        return !edges_.empty() && is_balanced() && volume_ > 0;
    }

  private:
    void walk(const std::uint32_t* face, std::size_t corners) {
        for (std::size_t i = 0; i < corners; ++i) {
            const std::uint32_t from = vertex_[face[i]], to = vertex_[face[(i + 1) % corners]];
            if (from != to) edges_.push_back({std::min(from, to), std::max(from, to), from < to});
        }
        // signed volumes relative to any point; the first vertex keeps the numbers small
        const auto corner = [&](std::size_t i) { return widen(mesh_.positions[face[i]]) - widen(mesh_.positions[0]); };
        for (std::size_t i = 2; i < corners; ++i) volume_ += dot(corner(0), cross(corner(i - 1), corner(i)));
    }

    /// Whether every edge occurs as often forward as backward.
    bool is_balanced() {
        std::sort(edges_.begin(), edges_.end(),
                  [](const Edge& a, const Edge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
        for (std::size_t i = 0; i < edges_.size();) {
            int balance = 0;
            const Edge& first = edges_[i];
            for (; i < edges_.size() && edges_[i].low == first.low && edges_[i].high == first.high; ++i) {
                balance += edges_[i].forward ? 1 : -1;
            }
            if (balance != 0) return false;
        }
        return true;
    }

    const Mesh& mesh_;
    std::vector<std::uint32_t> vertex_;
    std::vector<Edge> edges_;
    double volume_ = 0;  ///< six times the volume
};

}  // namespace

bool is_closed(const Mesh& mesh) { return Walker(mesh).run(); }

}  // namespace tandem

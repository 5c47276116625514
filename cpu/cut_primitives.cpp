#include "cpu/cut_primitives.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "tandem/compile/crossed_boxes.h"
#include "tandem/kernel/shapes/body_pieces.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

struct Cell {
    std::size_t x, y, z;
};

/// How many centres of primitives are in the cells of a grid over the scene.
class CentreCounts {
  public:
    CentreCounts(const SceneView& scene, const Aabb& bounds) : bounds_(bounds) {
        const std::uint32_t count = primitive_count(scene);
        cells_ = static_cast<std::size_t>(std::clamp(accurate_cbrt(static_cast<double>(count)) / 2, 1.0, 64.0));
        size_ = (widen(bounds.upper) - widen(bounds.lower)) * (1 / static_cast<double>(cells_));
        std::vector<std::atomic<std::uint32_t>> counts(cells_ * cells_ * cells_);
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, 4096), [&](const auto& range) {
            const DefaultFpEnvironment guard;
            for (std::uint32_t id = range.begin(); id < range.end(); ++id) {
                const Aabb box = primitive_bounds(scene, id);
                const Cell cell = cell_of((widen(box.lower) + widen(box.upper)) * 0.5);
                counts[(cell.x * cells_ + cell.y) * cells_ + cell.z].fetch_add(1, std::memory_order_relaxed);
            }
        });
        before_.resize((cells_ + 1) * (cells_ + 1) * (cells_ + 1));
        for (std::size_t x = 0; x < cells_; ++x) {
            for (std::size_t y = 0; y < cells_; ++y) {
                std::uint32_t row = 0;
                for (std::size_t z = 0; z < cells_; ++z) {
                    row += counts[(x * cells_ + y) * cells_ + z];
                    const std::uint32_t all = row + before({x, y + 1, z + 1}) + before({x + 1, y, z + 1});
                    before_[place({x + 1, y + 1, z + 1})] = all - before({x, y, z + 1});
                }
            }
        }
    }

    /// How many pieces a primitive in `box` should have, by the centres in the cells that the box meets: `more` than
    /// pieces_along() gives.
    [[nodiscard]] std::uint32_t pieces(const Aabb& box, double more) const {
        const Cell from = cell_of(widen(box.lower)), last = cell_of(widen(box.upper));
        const Cell to = {last.x + 1, last.y + 1, last.z + 1};
        const auto cells = static_cast<double>((to.x - from.x) * (to.y - from.y) * (to.z - from.z));
        const double volume = cells * (size_.x * size_.y * size_.z);
        const int axis = longest_axis(box);
        const double length = double{box.upper[axis]} - double{box.lower[axis]};
        return volume > 0 ? pieces_along(more * length / accurate_cbrt(volume), in(from, to)) : 1;
    }

  private:
    [[nodiscard]] Cell cell_of(const Vec3d& point) const {
        const auto along = [&](double at, float lower, double size) {
            const double cell = size > 0 ? (at - double{lower}) / size : 0;
            return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_ - 1)));
        };
        return {along(point.x, bounds_.lower.x, size_.x), along(point.y, bounds_.lower.y, size_.y),
                along(point.z, bounds_.lower.z, size_.z)};
    }
    [[nodiscard]] std::size_t place(const Cell& cell) const {
        return (cell.x * (cells_ + 1) + cell.y) * (cells_ + 1) + cell.z;
    }
    /// The centres in all cells before this one along each axis.
    [[nodiscard]] std::uint32_t before(const Cell& cell) const { return before_[place(cell)]; }
    [[nodiscard]] std::uint32_t in(const Cell& from, const Cell& to) const {
        const auto below = [&](std::size_t z) {
            return before({to.x, to.y, z}) - before({from.x, to.y, z}) - before({to.x, from.y, z}) +
                   before({from.x, from.y, z});
        };
        return below(to.z) - below(from.z);
    }

    Aabb bounds_;
    std::size_t cells_;  ///< along each axis
    Vec3d size_;         ///< of a cell, metres
    std::vector<std::uint32_t> before_;
};

/// What f returns for the placement of a solid; false for other primitives.
template <class F>
bool of_placement(const SceneView& scene, std::uint32_t id, F f) {
    bool result = false;
    visit_primitive(scene, id, [&]<class Primitive>(const Primitive& primitive) {
        if constexpr (std::is_base_of_v<Placement, Primitive>) result = f(primitive);
    });
    return result;
}

/// Calls change(id, pieces) for all primitives in parallel, with the pieces that each has; change() may change them.
/// Returns the number of pieces after the first of each primitive.
template <class Change>
std::size_t for_each_count(std::vector<std::uint8_t>& counts, const Change& change) {
    std::atomic<std::size_t> further = 0;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(counts.size()), 4096),
                      [&](const auto& range) {
                          const DefaultFpEnvironment guard;
                          std::size_t here = 0;
                          for (std::uint32_t id = range.begin(); id < range.end(); ++id) {
                              change(id, counts[id]);
                              here += counts[id] - 1U;
                          }
                          further += here;
                      });
    return further;
}

/// The primitives from id `first` on, with the pieces after the first of each. `further`: how many these are.
CutPrimitives in_pieces(std::vector<std::uint8_t> counts, std::uint32_t first, std::size_t further) {
    if (further == 0) return {};
    CutPrimitives result{std::move(counts), {}};
    result.further.reserve(further);
    for (std::uint32_t place = 0; place < result.counts.size(); ++place) {
        const std::uint8_t count = result.counts[place];
        for (std::uint16_t i = 1; i < count; ++i) result.further.push_back({first + place, i, count});
    }
    return result;
}

}  // namespace

Aabb piece_bounds(const SceneView& scene, const PrimitivePiece& piece) {
    Aabb box;
    visit_primitive(scene, piece.primitive, [&]<class Primitive>(const Primitive& primitive) {
        if constexpr (can_have_pieces<Primitive>) {
            box = bounds_within(primitive, slab_of_piece(bounds(primitive), piece.number, piece.count));
        }
    });
    return box;
}

CutPrimitives cut_primitives(const SceneView& scene, std::uint32_t count, const Aabb& bounds) {
    constexpr double more = 4;  // measured (docs/performance/cpu.md)
    if (scene.masked_kinds != 0 || scene.ellipsoid_count + scene.parallelepiped_count == 0) return {};
    std::vector<std::uint8_t> counts(count);
    const std::size_t needles = for_each_count(
        counts, [&](std::uint32_t id, std::uint8_t& pieces) { pieces = of_placement(scene, id, is_needle) ? 2 : 1; });
    if (needles == 0) return {};
    const CentreCounts centres(scene, bounds);
    const std::size_t further = for_each_count(counts, [&](std::uint32_t id, std::uint8_t& pieces) {
        if (pieces == 1) return;
        pieces = static_cast<std::uint8_t>(centres.pieces(primitive_bounds(scene, id), more));
        const auto pays = [&](const Placement& placement) { return are_small(placement, pieces); };
        if (pieces > 1 && !of_placement(scene, id, pays)) pieces = 1;
    });
    return in_pieces(std::move(counts), 0, further);
}

// These numbers are chosen by measurement (docs/performance/cpu.md).
bool may_cut_triangles(const SceneView& scene, const Aabb& bounds) {
    constexpr double least_boxes = 300;
    return scene.masked_kinds == 0 && boxes_before_a_hit(scene, bounds) > least_boxes;
}

CutPrimitives cut_triangles(const SceneView& scene, const Aabb& bounds) {
    constexpr double more = 0.5;
    constexpr std::uint32_t least_pieces = 6;
    if (!may_cut_triangles(scene, bounds)) return {};
    std::vector<std::uint8_t> counts(scene.triangle_count);
    const std::size_t slivers = for_each_count(
        counts, [&](std::uint32_t i, std::uint8_t& pieces) { pieces = is_sliver(scene.triangles[i]) ? 2 : 1; });
    if (slivers == 0) return {};
    const CentreCounts centres(scene, bounds);
    const std::size_t further = for_each_count(counts, [&](std::uint32_t i, std::uint8_t& pieces) {
        if (pieces == 1) return;
        const std::uint32_t fitting = centres.pieces(tandem::bounds(scene.triangles[i]), more);
        pieces = fitting < least_pieces ? 1 : static_cast<std::uint8_t>(fitting);
    });
    return in_pieces(std::move(counts), primitive_count(scene) - scene.triangle_count - scene.quad_count, further);
}

}  // namespace tandem

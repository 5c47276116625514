/// The extent of the surfaces of a scene.
#pragma once

#include <span>
#include <vector>

#include "tandem/scene/instances.h"

namespace tandem {

/// Whether the map collapses every face to a line or a point. Authors hide objects in this way.
[[nodiscard]] bool leaves_no_area(const Matrix3& map);

/// Calls `visit(geometry, world_from_shape)` for every shape that is not hidden, once for each instance.
template <class Visit>
void for_each_shape(const Scene& scene, const std::vector<Transform>& world_from_node, const Visit& visit) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (const Geometry& geometry : scene.nodes[i].geometry) {
            const auto place = [&](const Transform& world_from_shape) {
                if (!leaves_no_area(world_from_shape.linear)) visit(geometry, world_from_shape);
            };
            if (geometry.instances.empty()) place(world_from_node[i]);
            for (const Trs& instance : geometry.instances) place(world_from_node[i] * to_transform(instance));
        }
    }
}

/// The convex hull of the surfaces of a scene at one time. Vertices that no face uses do not count.
class SurfaceReach {
  public:
    /// `time` in seconds. The scene must be valid and outlive this.
    SurfaceReach(const Scene& scene, double time);

    /// Whether there is no surface.
    [[nodiscard]] bool is_empty() const { return is_empty_; }

    /// For each direction, of any length, its largest dot product with a point of a surface, in world space: the
    /// support function of the convex hull. -infinity if there is no surface. Linear in the number of vertices; on
    /// several threads.
    [[nodiscard]] std::vector<double> along(std::span<const Vec3d> directions) const;

  private:
    std::vector<Transform> world_from_node_;
    std::vector<InstanceRange> shapes_;
    std::size_t count_ = 0;                    ///< of shapes
    std::vector<std::vector<Vec3f>> corners_;  ///< by mesh: its vertices that faces use
    bool is_empty_ = true;
};

}  // namespace tandem

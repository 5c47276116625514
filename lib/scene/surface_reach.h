/// How far the surfaces of a scene reach.
#pragma once

#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// A shape where it stands in the world.
struct PlacedShape {
    const Geometry* geometry;
    Transform world_from_shape;
};

/// All shapes of the scene at `time` seconds, but for those that a transform shrinks to a point or a line: authors hide
/// things so. The scene must be valid and outlive them.
[[nodiscard]] std::vector<PlacedShape> place_shapes(const Scene& scene, double time);

/// The surfaces of a scene at a moment, as their extreme points. Vertices that no face uses do not count.
class SurfaceReach {
  public:
    SurfaceReach(const Scene& scene, double time);

    /// Is there no surface?
    [[nodiscard]] bool is_empty() const { return bodies_.empty(); }

    /// The largest dot product of `direction`, of any length, with a point of a surface, in world space: the support
    /// function of the convex hull. -infinity if there is no surface. Linear in the number of vertices.
    [[nodiscard]] double along(const Vec3d& direction) const;

  private:
    struct Body {
        Transform world_from_shape;
        const Shape* shape;
    };

    std::vector<Body> bodies_;
    std::vector<std::vector<Vec3f>> corners_;  ///< by mesh: its vertices that faces use
};

}  // namespace tandem

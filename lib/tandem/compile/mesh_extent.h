/// How far a mesh reaches under a linear map.
#pragma once

#include <span>

#include "tandem/compile/build_bvh.h"
#include "tandem/math/transform.h"

namespace tandem {

/// Finds extents with the hierarchy of a mesh, whose boxes are relative to `centre`: this inspects a few boxes and
/// faces, not all corners, and the box may be larger by a sixteenth. `bvh` and `faces` must outlive it.
class MeshExtent {
  public:
    MeshExtent(const Bvh& bvh, std::span<const Triangle> faces, const Vec3d& centre)
        : bvh_(bvh), faces_(faces), centre_(centre) {}

    struct Range {
        Vec3d lower, upper;
    };
    /// A box that contains linear * (corner - centre) of all corners of faces, up to the rounding of products and sums.
    [[nodiscard]] Range under(const Matrix3& linear) const;

  private:
    /// Not below the dot product of `direction` with any corner relative to the centre.
    [[nodiscard]] double along(const Vec3d& direction) const;

    const Bvh& bvh_;
    std::span<const Triangle> faces_;
    Vec3d centre_;
};

}  // namespace tandem

/// What a ray of the oracle meets.
#pragma once

#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/oracle/oracle_geometry.h"
#include "tandem/oracle/oracle_textures.h"

namespace tandem::oracle {

struct NearestSurface {
    SurfaceHit surface{};
    std::uint32_t primitive = no_primitive;
};

/// Up to where a path has passed all hits, in their order: by t, then by id.
struct Passed {
    Real t = 0;
    std::uint32_t primitive = no_primitive;
};

/// In front of a line that comes from `source`; ties go to the lower id. Hits on `except` do not count. For the ray of
/// a path, with `passed`, hits count beyond that, and culled faces are not hit from behind.
[[nodiscard]] NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source,
                                             std::uint32_t except = no_primitive, const Passed* passed = nullptr);

/// A point of a surface that a path has reached.
struct Vertex {
    Vector point;
    Vector direction;  ///< of the path, unit
    Vector facet;      ///< the surface's own normal, outward
    Vector normal;     ///< for shading, as the scene says it
    Texel picture{1, 1, 1, 1};
    std::uint32_t primitive = no_primitive;
    std::uint32_t material = 0;
    bool from_inside = false;
    bool shines = false;  ///< this side emits, if the surface is emissive
    bool is_hole = false;
    Vector emission{0, 0, 0};
    Real roughness = 0, metal = 0;  ///< of microfacets
    Real anisotropy = 0;            ///< of microfacets: its strength
    Vector along{0, 0, 0};          ///< where that is above 0: unit, the direction in which they are rougher
};

/// At what the line has met.
[[nodiscard]] Vertex vertex_at(const SceneView& scene, const Line& ray, const NearestSurface& nearest);

/// What lies within this of the end of a way, relative to its length, lies at the end.
inline constexpr Real rounding = 0x1p-45L;

/// Does anything but holes and `except` stand on the way from `vertex`, up to `to` times `way`?
[[nodiscard]] bool is_stopped(const SceneView& scene, const Vertex& vertex, const Vector& way, Real to,
                              std::uint32_t except = no_primitive);

/// Is a light in the direction l on the side of the surface that is looked at, and before the normal for shading?
[[nodiscard]] bool is_in_front(const Vertex& vertex, const Vector& l);

}  // namespace tandem::oracle

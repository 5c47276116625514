/// The path vertices of the oracle.
#pragma once

#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/oracle/oracle_bounds.h"
#include "tandem/oracle/oracle_textures.h"

namespace tandem::oracle {

struct NearestSurface {
    SurfaceHit surface{};
    std::uint32_t primitive = no_primitive;
};

/// The last hit that a path has passed, in the order of t, then id.
struct Passed {
    Real t = 0;
    std::uint32_t primitive = no_primitive;
};

/// The nearest hit in front of a line from `source`; at equal t the lower id wins. Hits on `except` do not count. For
/// the ray of a path, with `passed`, only later hits count, and culled faces are not hit from behind.
[[nodiscard]] NearestSurface nearest_surface(const BoundedView& scene, const Line& line, const RaySource& source,
                                             std::uint32_t except = no_primitive, const Passed* passed = nullptr);

/// A vertex of a path.
struct Vertex {
    Vector point;
    Vector direction;  ///< of the path, unit
    Vector facet;      ///< the geometric normal, outward
    Vector normal;     ///< the shading normal, as given by the scene
    Texel picture{1, 1, 1, 1};
    std::uint32_t primitive = no_primitive;
    std::uint32_t material = 0;
    bool from_inside = false;
    bool shines = false;  ///< this side emits light if the surface is emissive
    bool is_masked_out = false;
    Vector emission{0, 0, 0};
    Real roughness = 0, metal = 0;  ///< of microfacets
    Real anisotropy = 0;            ///< of microfacets: its strength
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) Texel name{1, 1, 1, 1};
#include "tandem/kernel/bsdf/lobes.def"
    Vector along{0, 0, 0};  ///< where that is above 0: unit, the direction in which they are rougher
};

/// The vertex at a hit of the line.
[[nodiscard]] Vertex vertex_at(const SceneView& scene, const Line& ray, const NearestSurface& nearest);

/// Hits within this distance of the end of a segment, relative to its length, are at the end.
inline constexpr Real rounding = 0x1p-45L;

/// Whether anything except masked-out surfaces and `except` blocks the segment from `vertex`, up to `to` times `way`.
[[nodiscard]] bool is_blocked(const BoundedView& scene, const Vertex& vertex, const Vector& way, Real to,
                              std::uint32_t except = no_primitive);

/// Whether a light in the direction l is on the visible side of the surface, and above the plane of the shading normal.
[[nodiscard]] bool is_in_front(const Vertex& vertex, const Vector& l);

}  // namespace tandem::oracle

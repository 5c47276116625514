/// The textures of the oracle, in extended precision.
#pragma once

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// A hit point on a textured surface.
struct TexturePoint {
    Real u, v;
    Vector along_u, along_v;  ///< directions in which u and v grow, of any length
};

/// `slot`: of a face's values. `exits`: the line comes from inside the solid.
[[nodiscard]] TexturePoint texture_point(const SceneView& scene, std::uint32_t id, const Vector& point,
                                         const SurfaceHit& hit, std::uint32_t slot);

/// Red, green, blue and alpha; white without a texture.
struct Texel {
    Real r, g, b, a;
};
[[nodiscard]] Texel sample_texture(const SceneView& scene, const TextureUse& use, const TexturePoint& at);

/// Rounded to float, since alphas are compared as floats.
[[nodiscard]] Real product_of_alphas(Real a, Real b);

/// The base colour of the material of primitive `id`: its texture times the colours of a face's corners.
[[nodiscard]] Texel base_colour_at(const SceneView& scene, std::uint32_t id, const Vector& point,
                                   const SurfaceHit& hit);

}  // namespace tandem::oracle

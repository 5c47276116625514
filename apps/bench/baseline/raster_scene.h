/// A prepared scene as triangles with plain materials, for the rasteriser.
#pragma once

#include <string>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/effects.h"

namespace tandem::bench {

/// Render space, metres. The corners run counter-clockwise as seen from the front.
struct RasterTriangle {
    Vec3f corners[3];
    Vec3f normals[3];  ///< for shading, unit
    std::uint32_t material = 0;
    FaceSides sides = FaceSides::single_sided;
};

/// What Phong's model needs of a material: RGB, linear.
struct RasterMaterial {
    Vec3f ambient, diffuse, specular;
    float shininess = 0;
    Vec3f emission;
};

struct RasterScene {
    std::vector<RasterTriangle> triangles;  ///< in the order of the primitives
    std::vector<RasterMaterial> materials;
    std::vector<PunctualLight> lights;
    Environment environment;
    CameraView camera{};
    double near = 0;  ///< metres along the axis of a perspective camera: what is nearer is cut off
};

/// The effects that the rasteriser draws. It draws no other: no shadows, nothing that is reflected, refracted or lit
/// indirectly, no textures, masks, microfacets, lens or motion.
inline constexpr EffectMask rasterised_effects =
    Effect::inverse_square | Effect::spot_lights | Effect::directional_lights | Effect::emission;

/// Spheres become triangles, as many as keep them within a tenth of a pixel, up to 20 * 4^6 each; fewer if the scene
/// would have more than four million. Faces are unchanged. Throws EnvironmentError as why_not_rasterised() says.
[[nodiscard]] RasterScene make_raster_scene(const PreparedScene& scene, int width, int height);

/// Why the scene cannot be rasterised, or empty: it has more than four million triangles even with the coarsest
/// spheres.
[[nodiscard]] std::string why_not_rasterised(const PreparedScene& scene);

}  // namespace tandem::bench

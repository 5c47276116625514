/// The authored scene: a tree of named nodes with transforms relative to their parents, what is attached to them, and
/// animation. Metres, seconds, radians; right-handed, y up, cameras look along -z, as in glTF 2.0.
/// Build one in code (docs/scene-format.md has an example), by name (named_scenes.h) or from a file (gltf/import.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tandem/images/display.h"
#include "tandem/kernel/bsdf/material_parts.h"
#include "tandem/kernel/bsdf/optics.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/kernel/camera/lens.h"
#include "tandem/kernel/camera/shutter.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/kernel/shapes/face_sides.h"
#include "tandem/math/transform.h"
#include "tandem/scene/texture.h"

#define TANDEM_AUTHORED_ENVIRONMENT_HEADERS
#include "tandem/kernel/lights/lights.def"

namespace tandem {

/// Translation, rotation and scale, applied in the order scale, rotation, translation.
struct Trs {
    Vec3d translation{0, 0, 0};
    Quaternion rotation{};
    Vec3d scale{1, 1, 1};
};

[[nodiscard]] inline Transform to_transform(const Trs& trs) {
    return compose(trs.translation, trs.rotation, trs.scale);
}

/// Centred at the origin of its node.
struct SphereShape {
    double radius = 0.5;
};

/// Centred at the origin of its node; edge lengths along x, y, z.
struct BoxShape {
    Vec3d size{1, 1, 1};
};

/// Linear RGB and alpha, each in [0, 1].
struct VertexColour {
    Vec3f rgb{1, 1, 1};
    float alpha = 1;
};

/// Triangles and quadrilaterals between shared vertices, in the space of a node. The corners of a face run
/// counter-clockwise as seen from its front, also under a mirroring transform. A quad is two triangles, (v0, v1, v2)
/// and (v0, v2, v3). Degenerate faces are dropped and counted (PreparedScene::dropped_primitives).
struct Mesh {
    std::string name{};
    std::vector<Vec3f> positions{};
    std::vector<Vec3f> normals{};  ///< shading normals per vertex, unit; empty: each face uses its own normal
    /// Sets of texture coordinates, each per vertex. A texture needs the set that it names.
    std::vector<std::vector<Vec2f>> texcoords{};
    std::vector<std::uint32_t> triangles{};  ///< three vertices each
    std::vector<std::uint32_t> quads{};      ///< four vertices each
    std::vector<VertexColour> colours{};     ///< per vertex; multiply the base colour; may be empty
    bool is_closed = false;  ///< its faces enclose a volume, with their fronts outward (mesh_topology.h)
};

/// A mesh of the scene: index into Scene::meshes.
struct MeshShape {
    std::uint32_t mesh = 0;
};

using Shape = std::variant<SphereShape, BoxShape, MeshShape>;

/// A shape with a material (index into Scene::materials), once at its node or once per instance.
struct Geometry {
    Shape shape;
    std::uint32_t material = 0;
    std::vector<Trs> instances{};  ///< node_from_instance; empty means one, at the node itself
};

/// Perspective: `yfov` is the whole vertical angle, in radians.
struct PerspectiveCamera {
    double yfov = 0.8;
    Lens lens{};
    Shutter shutter{};
};

/// Orthographic: half of the height that the film shows, in metres. The width follows from the film's shape.
struct OrthographicCamera {
    double ymag = 1.0;
    Shutter shutter{};
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera>;

/// The shutter of a Camera, const or not.
template <class AnyCamera>
[[nodiscard]] auto& shutter_of(AnyCamera& camera) {
    return std::visit(
        [](auto& kind) -> auto& { return kind.shutter; }, camera);
}

enum class LightKind { point, spot, directional };

/// A punctual light at the origin of its node; spots and directional lights shine along the node's -z. Without
/// fall-off, Phong's model uses its colour times intensity at any distance, as in the paper. With `inverse_square` the
/// intensity is in candela, and a surface of diffuse reflectance kd is as bright as a Lambertian one of that albedo.
struct LightSource {
    LightKind kind = LightKind::point;
    Vec3f colour{1, 1, 1};  ///< RGB, linear
    float intensity = 1;
    double inner_cone = 0;         ///< of a spot, radians from its axis: full intensity up to this angle
    double outer_cone = 0.785398;  ///< and none from this one on; above inner_cone, up to pi / 2
    bool inverse_square = false;   ///< not for directional lights
    bool casts_shadows = true;
};

/// `sides` applies to faces of meshes: the other shapes are closed and have no back. The back of a single-sided face
/// receives only ambient light. A dielectric needs a closed shape whose faces are not culled.
struct Material {
    std::string name;
    PhongMaterial phong;
    FaceSides sides = FaceSides::single_sided;
    Optics optics{};                                     ///< mirrors, dielectrics and emission
    std::optional<TextureReference> diffuse_texture{};   ///< multiplies the diffuse and the ambient reflectance
    std::optional<TextureReference> normal_texture{};    ///< normal map, as in glTF 2.0 (kernel/texture/normal_map.h)
    std::optional<TextureReference> emissive_texture{};  ///< multiplies the emission
    // Optional parts, each described in its header: `microfacets` is the metallic-roughness model of glTF 2.0
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) std::optional<Type> name{};
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) std::optional<TextureReference> name{};
#include "tandem/kernel/bsdf/lobes.def"
    /// Linear: green multiplies the roughness, blue the metalness.
    std::optional<TextureReference> metallic_roughness_texture{};
    /// Linear: red and green are the direction in which microfacets are rougher, blue multiplies the anisotropy.
    std::optional<TextureReference> anisotropy_texture{};
    /// The diffuse reflectance, with its texture, is the radiance that is seen. The surface neither receives nor
    /// emits light (KHR_materials_unlit).
    bool unlit = false;
    float normal_scale = 1;  ///< multiplies the tangential components of the normal map
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha = 1;            ///< multiplies the alpha of the diffuse texture; from 0 to 1
    float alpha_cutoff = 0.5F;  ///< for AlphaMode::mask
};

/// Are its microfacets rougher in one direction than in others?
[[nodiscard]] inline bool is_anisotropic(const Material& material) {
    return material.microfacets && material.microfacets->anisotropy > 0 && !material.unlit;
}

/// parent: index of the parent node, or no_parent. A node may carry several things. All members have initialisers, so
/// that Node{.name = ..., .light = ...} compiles without warnings.
struct Node {
    static constexpr std::int32_t no_parent = -1;

    std::string name{};
    std::int32_t parent = no_parent;
    Trs trs{};
    std::optional<Transform> matrix{};  ///< replaces trs; the node cannot be animated then
    std::vector<Geometry> geometry{};
    std::optional<Camera> camera{};
    std::optional<LightSource> light{};
};

enum class Interpolation { step, linear, cubic };
enum class AnimatedPath { translation, rotation, scale };

/// Animates one path of one node. `times` in seconds, strictly increasing. `values`: 3 numbers per key (4 for a
/// rotation: x, y, z, w); for cubic interpolation three such groups per key: in-tangent, value, out-tangent.
/// The value is constant before the first and after the last key.
struct AnimationChannel {
    std::uint32_t node = 0;
    AnimatedPath path = AnimatedPath::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;
    std::vector<float> values;
};

struct Scene {
    std::string name;
    std::vector<Node> nodes;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<AnimationChannel> animation;
    Environment environment;
    bool indirect_light = false;  ///< diffuse surfaces receive light from other surfaces
    // each takes the place of the gradient; one at most
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) std::optional<Authored> authored{};
#include "tandem/kernel/lights/lights.def"
    Display display{};  ///< for 8-bit images; does not affect the film
    double frames_per_second = 24;
};

/// Whether the scene has an environment other than the gradient.
[[nodiscard]] bool has_environment(const Scene& scene);

/// Lights a scene by an environment instead of its background, its ambient light and other environments.
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) void light_by(Scene& scene, Authored environment);
#include "tandem/kernel/lights/lights.def"

/// Sets the number of instants of the shutter interval for all cameras of the scene.
void set_shutter_instants(Scene& scene, int instants);

/// True if the light emits anything.
[[nodiscard]] inline bool is_lit(const LightSource& light) {
    return light.intensity > 0 && (light.colour.x > 0 || light.colour.y > 0 || light.colour.z > 0);
}

/// The time of a frame, in seconds. Rounded to float, as glTF stores key times, so that frames hit their keys exactly.
[[nodiscard]] double time_of_frame(const Scene& scene, std::int32_t frame);

/// The number of frames from 0 to the last key of the animation, without repeating it; 1 for a still scene.
[[nodiscard]] std::int32_t frame_count(const Scene& scene);

/// The problems of the scene, one sentence each, naming the node, material, mesh or channel; empty if it is valid.
[[nodiscard]] std::vector<std::string> validate(const Scene& scene);

}  // namespace tandem

/// Chooses the meshes of a scene that are kept once, and places their instances.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <vector>

#include "tandem/compile/place_mesh.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/compile/render_origin.h"

namespace tandem {

/// A mesh and a material: indices into the Scene.
struct MeshUse {
    std::uint32_t mesh, material;
    // clang-tidy 14 takes the 0 of a comparison for a null pointer
    friend auto operator<=>(const MeshUse&, const MeshUse&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The meshes that are kept once: triangles alone, with a material that neither emits nor transmits, 64 faces or more,
/// and 8 instances or more. Empty if their instances have fewer than `least_faces` faces in all, or if the scene has
/// quads or a material that transmits.
[[nodiscard]] std::set<MeshUse> instanced_uses(const Scene& scene, std::uint64_t least_faces);

class InstanceList {
  public:
    InstanceList(const Scene& scene, std::set<MeshUse> uses) : scene_(scene), uses_(std::move(uses)) {}

    /// Whether the surface is kept as an instance: of a mesh that is kept once, under a transform that can be inverted
    /// with enough digits, and not too far away.
    /// Throws InputError if too many faces would have to be written out.
    [[nodiscard]] bool take(const MeshUse& use, const PlacedSurface& surface);
    [[nodiscard]] bool is_kept(const MeshUse& use) const { return uses_.count(use) > 0; }

    /// Adds the instances to the surfaces from which the origin is chosen. Inspects faces only of instances near the
    /// camera.
    void add_to(RenderOrigin& origin, const Vec3d& camera) const;

    /// Removes and returns the instances of meshes with culled faces that hides_backs(), but in whose boxes the camera
    /// may be. `prepared`: with the textures.
    [[nodiscard]] std::vector<PlacedSurface> take_back(const Vec3d& origin, const PreparedScene& prepared,
                                                       const std::function<bool(const Aabb&)>& sees_outside_of);

    /// Places the instances in render space. Faces that are degenerate in their mesh are dropped; those that rounding
    /// makes degenerate stay, and no ray hits them. The primitives of the scene must be there already. Throws
    /// InputError if there are too many faces.
    void place(const Vec3d& origin, const std::vector<CornerSlots>& slots, PreparedScene& scene) const;

  private:
    struct Key {
        MeshUse use;
        bool mirrors;
        friend auto operator<=>(const Key&, const Key&) = default;  // NOLINT(modernize-use-nullptr): as above
    };
    struct MeshFacts {
        Vec3d centre, half;  ///< of its box
        bool is_empty;       ///< all its faces are degenerate
    };
    const MeshFacts& facts(std::uint32_t mesh) const;
    bool can_take(const MeshUse& use, const PlacedSurface& surface);

    const Scene& scene_;
    std::set<MeshUse> uses_;
    std::map<Key, std::vector<PlacedSurface>> instances_;
    mutable std::map<std::uint32_t, MeshFacts> facts_;
    std::uint64_t refused_faces_ = 0;
};

}  // namespace tandem

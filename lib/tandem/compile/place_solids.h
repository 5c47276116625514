/// Turns authored spheres and boxes into the solids that kernels read, on several threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/compile/render_origin.h"
#include "tandem/scene/instances.h"

namespace tandem {

/// The spheres and boxes of a scene at one instant. There may be a hundred million, as instances of a few geometries,
/// so none is kept in double between the two passes: the first finds the kind of each, the second computes each again
/// and writes it to its place.
///
/// Spheres under rotation and uniform scale stay spheres, and boxes under diagonal transforms stay boxes; the others
/// become ellipsoids and parallelepipeds. So do textured or brushed ones that are rotated or mirrored.
class Solids {
  public:
    /// The first pass. `world_from_node`: by node. `prepared`: its camera, still in world space, and all that belongs
    /// to materials. The references must outlive this.
    Solids(const Scene& scene, std::span<const Transform> world_from_node, const PreparedScene& prepared);

    /// Throws the InputError of the first solid that cannot be placed, if it is of this geometry.
    void check(const Geometry& geometry) const;

    // Without those that cannot be placed:
    [[nodiscard]] std::size_t count() const;
    /// Those that no ray can hit: their transform hides them, or the alpha mask of their material does.
    [[nodiscard]] std::uint64_t dropped() const;
    void add_to(RenderOrigin& origin) const;

    /// The second pass: writes all solids, moved to `origin` in double and rounded once, with their materials and
    /// nodes. `result` has no primitives yet, and will get at most `faces` faces.
    void place(const Vec3d& origin, std::size_t faces, PreparedScene& result) const;

  private:
    static constexpr int kinds = 4;

    /// The spheres or boxes of a geometry. They are numbered in the order of nodes, geometries and instances.
    struct Part : InstanceRange {
        bool is_masked_out;    ///< by its material
        bool has_orientation;  ///< a texture, or grooves
    };
    /// What the first pass finds in a part of the numbers.
    struct Tally {
        std::array<RenderOrigin, kinds> origin;
        std::array<std::size_t, kinds> count{};
        std::uint64_t dropped = 0;
    };

    void list_parts();
    void find();
    [[nodiscard]] bool has_orientation(std::uint32_t material) const;
    template <class Sink>
    void visit_range(std::size_t begin, std::size_t end, const Sink& sink) const;
    template <class Sink>
    void visit(const Part& part, const Transform& world_from_object, const Sink& sink) const;
    template <class Sink>
    void visit_sphere(const Part& part, const Transform& world_from_object, const Sink& sink) const;
    template <class Sink>
    void visit_box(const Part& part, const Transform& world_from_object, const Sink& sink) const;
    template <class Body, class Sink>
    void visit_body(const Part& part, const Transform& world_from_object, const Vec3d& size, const Sink& sink) const;

    const Scene& scene_;
    std::span<const Transform> world_from_node_;
    const PreparedScene& prepared_;
    std::vector<Part> parts_;
    std::size_t solids_ = 0;
    std::vector<Tally> tallies_;  ///< by chunk of the numbers
    std::exception_ptr failure_;
    const Geometry* failed_ = nullptr;
};

}  // namespace tandem

/// Primitives that are exact copies of another one. They never show, since the lowest id wins at equal t. So copies are
/// not traced: no acceleration structure can separate them, and a ray would be tested against all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem {

struct PreparedScene;

/// A primitive that is not traced, and the primitive that it copies.
struct PrimitiveCopy {
    std::uint32_t id;
    std::uint32_t of;
};

/// The primitives that have the same shape, bit by bit, and the same material as one with a lower id, in the order of
/// their ids. Faces with an alpha mask by a texture or vertex colours are left out, since their masks may differ.
[[nodiscard]] std::vector<PrimitiveCopy> find_copies(const PreparedScene& scene);

/// The scene without its copies. The other primitives keep their order and get new ids; material_of and area_lights are
/// adapted.
[[nodiscard]] PreparedScene without_copies(const PreparedScene& scene);

/// Maps ids of a scene to ids of the scene without its copies, and back.
class TracedIds {
  public:
    /// `copies`: those of the scene, in the order of their ids; must outlive this.
    explicit TracedIds(std::span<const PrimitiveCopy> copies) : copies_(copies) {}

    /// For a copy, the id of the primitive that it copies. Numbers that name no primitive stay as they are.
    [[nodiscard]] std::uint32_t traced(std::uint32_t id) const;
    [[nodiscard]] std::uint32_t of_scene(std::uint32_t traced) const;

  private:
    std::span<const PrimitiveCopy> copies_;
};

}  // namespace tandem

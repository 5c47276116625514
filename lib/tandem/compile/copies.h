/// Primitives that are exact copies of another one. No ray can tell them apart, since the lowest id wins at equal t. So
/// copies are not traced: no acceleration structure can separate them, and a ray would be tested against all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem {

struct PreparedScene;

/// A primitive that is not traced, and the first one that it is a copy of.
struct PrimitiveCopy {
    std::uint32_t id;
    std::uint32_t of;
};

/// The primitives that have the same shape, bit by bit, and the same material as one with a lower id, in the order of
/// their ids. Faces with an alpha mask by a texture or vertex colours are left out, since their masks may differ.
[[nodiscard]] std::vector<PrimitiveCopy> find_copies(const PreparedScene& scene);

/// The scene without its copies. The others keep their order and get new ids, and what refers to primitives
/// (material_of, area_lights) is changed with them.
[[nodiscard]] PreparedScene without_copies(const PreparedScene& scene);

/// Maps the ids of a scene to the ids in the scene without its copies, and back.
class TracedIds {
  public:
    /// `copies`: of the scene, in the order of their ids; must outlive this.
    explicit TracedIds(std::span<const PrimitiveCopy> copies) : copies_(copies) {}

    /// For a copy, the id of its first. Numbers that stand for no primitive are left as they are.
    [[nodiscard]] std::uint32_t traced(std::uint32_t id) const;
    [[nodiscard]] std::uint32_t of_scene(std::uint32_t traced) const;

  private:
    std::span<const PrimitiveCopy> copies_;
};

}  // namespace tandem

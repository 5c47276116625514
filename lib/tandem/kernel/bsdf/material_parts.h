/// The optional parts of materials, which lobes.def lists, checked against their interface.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#define TANDEM_MATERIAL_PART_HEADERS
#include "tandem/kernel/bsdf/lobes.def"

namespace tandem {

namespace material_parts_detail {

struct AnyVisitor {  // nvcc takes no lambda in a concept
    template <class Number>
    constexpr void operator()(const char*, const Number&, float, float) const {}
};

}  // namespace material_parts_detail

/// A part is a plain struct without undefined bytes, because scene_hash() reads all of them. It has
///
/// is_there      1; 0 for a material without the part, in the array of a scene where another material has it
/// is_opaque     whether the material can have no mirror and transmit no light; a constant
/// visit_numbers(part, visit)   calls visit(name, number, least, most) for each number that an author sets, a float or
///               an RGB, with the range in which it is valid. Validation, descriptions and reasons follow from it
///
/// apply(part, at, surface), in the header of its lobes, makes the lobes from it (material.h). It changes the lobes of
/// another part only where surface.lobes.used.has() the effect that they need: elsewhere they are undefined in a
/// packet.
template <class Part>
concept MaterialPart = std::is_trivially_copyable_v<Part> && requires(Part& part) {
    { Part::is_opaque } -> std::convertible_to<bool>;
    { part.is_there } -> std::convertible_to<std::uint32_t>;
    Part::visit_numbers(part, material_parts_detail::AnyVisitor{});
};

#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) static_assert(MaterialPart<Type>);
#include "tandem/kernel/bsdf/lobes.def"

}  // namespace tandem

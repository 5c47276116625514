/// The types and ranges that glTF prescribes, property by property.
#pragma once

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Checks every property that Tandem or tinygltf reads: its JSON type, the range of its numbers, the length of its
/// arrays, and that indices point at something. What it has passed, the rest of the import reads without asking
/// again. Unknown properties are left alone, as glTF demands. Throws InputError with the JSON path.
///
/// Whole numbers that are written as 1.0 become integers: JSON allows them, and tinygltf overlooks them.
void check_schema(Document& document);

}  // namespace tandem::gltf

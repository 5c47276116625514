/// The types and ranges that glTF prescribes, property by property.
#pragma once

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Checks every property that Tandem reads: its JSON type, the range of its numbers, the length of its arrays, that
/// indices point at something, and the rules of structure.h for each object. What it has passed, the rest of the import
/// reads without asking again. Unknown properties are left alone, as glTF demands.
///
/// What is flawed and can be done without is taken out of the JSON, with a note. In an array whose elements cannot be
/// empty objects, such as `accessors`, a string that says why takes the element's place; what refers to it is flawed in
/// turn. So a flaw reaches as far as to the first property that may be absent. Throws InputError, with the JSON path,
/// where nothing takes it up.
///
/// Whole numbers that are written as 1.0 become integers.
void check_schema(Document& document, FlawLog& flaws);

}  // namespace tandem::gltf

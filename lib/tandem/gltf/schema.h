/// Checks a document against glTF's schema.
#pragma once

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Checks every property that Tandem reads: its JSON type, the range of its numbers, the length of its arrays, that
/// indices refer to existing elements, and the rules of structure.h for each object. The rest of the import relies on
/// these checks. Unknown properties are left alone, as glTF demands.
///
/// Flawed parts that are not essential are removed from the JSON, with a note. In an array whose elements cannot be
/// empty objects, such as `accessors`, a string with the reason replaces the element; references to it are flawed in
/// turn. So a flaw propagates to the first property that may be absent. Throws InputError, with the JSON path, if there
/// is none.
///
/// Whole numbers that are written as 1.0 become integers.
void check_schema(Document& document, FlawLog& flaws);

}  // namespace tandem::gltf

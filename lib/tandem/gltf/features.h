/// Names what a file uses and Tandem leaves out, wherever it stands.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"

namespace tandem::gltf {

/// Walks over the whole document, also what the default scene does not reach, and notes every extension that is not
/// rendered and every core feature that is not. What is rendered, or depends on values, the readers note themselves.
/// Needs check_schema().
void note_ignored_features(const Document& document, ImportReport& report);

}  // namespace tandem::gltf

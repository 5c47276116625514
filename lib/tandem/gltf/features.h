/// Reports the features of a file that Tandem ignores.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"

namespace tandem::gltf {

/// Walks over the whole document, including what the default scene does not reach, and notes every extension and every
/// core feature that is not rendered. The readers themselves note what is rendered and what depends on values. Needs
/// check_schema().
void note_ignored_features(const Document& document, ImportReport& report);

}  // namespace tandem::gltf

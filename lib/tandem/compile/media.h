/// Facts about the dielectric solids of a scene that kernels need in advance.
#pragma once

#include "tandem/compile/prepared_scene.h"

namespace tandem {

/// Fills media_overlap and camera_media; needs everything else.
///
/// Solids are disjoint if no dielectric is a mesh, which need not be closed, and the bounds of none touch those of
/// another primitive or contain the camera; spheres are compared by their distance. More than 10^8 pairs are not
/// compared, but count as overlapping. For an orthographic camera the middle of its film counts. The media around a
/// camera are ordered by the size of their solids, as if the largest had been entered first.
void find_media(PreparedScene& scene);

}  // namespace tandem

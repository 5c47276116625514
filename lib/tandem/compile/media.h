/// Facts about the dielectric solids of a scene that a kernel needs before it starts.
#pragma once

#include "tandem/compile/prepared_scene.h"

namespace tandem {

/// Fills media_overlap and camera_media; everything else must be there.
///
/// Solids are disjoint if no dielectric is a mesh, which need not be closed, and the bounds of none touch those of
/// another primitive or contain the camera; spheres are compared by their distance. Over 10^8 pairs are not compared,
/// and overlap. Of an orthographic camera the middle of its film counts. The media around a camera are ordered by the
/// size of their solids, the largest as if entered first.
void find_media(PreparedScene& scene);

}  // namespace tandem

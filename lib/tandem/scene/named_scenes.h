/// Built-in scenes, selected by name on every command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// A scene by its name, without the prefix "named:".
///   paper                    the paper's scene (docs/paper.md)
///   spheres/N  spheres/N/S   N spheres, uniform in [-1, 1]^3, radius 0.6 / cbrt(N); seed S (1)
///   boxes/N    boxes/N/S     N boxes of random size and orientation
///   mixed/N    mixed/N/S     spheres, boxes, ellipsoids and parallelepipeds in turn
///   triangles/N  quads/N     N single, double-sided faces of random size and orientation; also with /S
///   hair/N     hair/N/S      N such triangles, each 4.8 / cbrt(N) long and a thousandth of that wide
///   leaves/N   leaves/N/S    the quads, each with an alpha mask in the shape of a leaf, and with shadows
///   icosphere/LEVEL          a sphere of 20 * 4^LEVEL triangles, LEVEL from 0 to 10, with smooth normals
///   block/N    block/N/S     N turned, unevenly scaled instances of an icosphere of 20,480 triangles, in [-1, 1]^3
///   city/N     city/N/S      the same instances side by side on the ground, seen from low above its edge
///   forest/N   forest/N/S    N instances of a crown of 1000 leaves as above, in 2000 triangles, above a ground
///   giant/N    giant/N/S     the N spheres, above a sphere of 1000 km
///   hard/planet              a sphere of 6400 km, seen from 1.75 m above it
///   hard/telescope           the paper's scene from 100 km away, with a narrow view
///   hard/far-telescope       the same from 10,000 km, where the error of float is several times that of noise
/// Throws InputError with the list of names, and EnvironmentError if the memory cannot hold the scene.
[[nodiscard]] Scene named_scene(std::string_view name);

/// The patterns of scene names, for usage texts.
[[nodiscard]] std::vector<std::string> scene_names();

}  // namespace tandem

/// The planes of a film as they are written to files.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/film/film.h"

namespace tandem {

/// Row by row from the top left, the channels of a pixel adjacent (PlaneInfo::channels).
struct PlaneImage {
    FilmPlane plane;
    std::vector<float> values;           ///< of a float plane; else empty
    std::vector<std::uint32_t> numbers;  ///< of an integer plane; else empty
};

/// The planes of the film, in the order of planes.def. Means and variances are rounded once, to float. The variance of
/// a single sample is unknown, so it is infinite.
[[nodiscard]] std::vector<PlaneImage> plane_images(const Film& film);

}  // namespace tandem

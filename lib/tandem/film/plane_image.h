/// The planes of a film as files hold them.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/film/film.h"

namespace tandem {

/// Row by row from the top left, with the channels of a pixel side by side (PlaneInfo::channels).
struct PlaneImage {
    FilmPlane plane;
    std::vector<float> values;           ///< of a plane of floats; else empty
    std::vector<std::uint32_t> numbers;  ///< of a plane of whole numbers; else empty
};

/// Those that the film has, in the order of planes.def. Means and variances are rounded once, to float. The variance of
/// a single sample is not known: it is infinite.
[[nodiscard]] std::vector<PlaneImage> plane_images(const Film& film);

}  // namespace tandem

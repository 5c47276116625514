#include "tandem/render/complete_planes.h"

#include <algorithm>

namespace tandem {

void complete_planes(Film& film, std::span<const PrimitiveCopy> copies) {
    const FilmPlanes planes = film.planes();
    const std::size_t pixels = film.pixel_count();
    if (planes.count != nullptr) std::fill_n(planes.count, pixels, static_cast<std::uint32_t>(film.samples()));
    if (planes.primitive == nullptr || copies.empty()) return;
    const TracedIds ids(copies);
    std::transform(planes.primitive, planes.primitive + pixels, planes.primitive,
                   [&](std::uint32_t traced) { return ids.of_scene(traced); });
}

}  // namespace tandem

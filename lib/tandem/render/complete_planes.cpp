#include "tandem/render/complete_planes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tandem {

void complete_planes(Film& film, const FilmWindow& window, std::span<const PrimitiveCopy> copies) {
    const FilmPlanes planes = film.planes();
    const TracedIds ids(copies);
    for (int y = window.top; y < window.top + window.height; ++y) {
        const auto first = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width()) +
                           static_cast<std::size_t>(window.left);
        if (planes.count != nullptr) {
            std::fill_n(planes.count + first, window.width, static_cast<std::uint32_t>(film.samples()));
        }
        if (planes.primitive == nullptr || copies.empty()) continue;
        std::uint32_t* const row = planes.primitive + first;
        std::transform(row, row + window.width, row, [&](std::uint32_t traced) { return ids.of_scene(traced); });
    }
}

}  // namespace tandem

#include "tandem/render/copy_window.h"

#include <fmt/format.h>

#include <algorithm>

#include "tandem/base/error.h"
#include "tandem/film/plane_names.h"

namespace tandem {

void copy_window(Film& to, int left, int top, const Film& from, const FilmWindow& window) {
    const auto fits = [&](const Film& film, int x, int y) {
        return x >= 0 && y >= 0 && window.width <= film.width() - x && window.height <= film.height() - y;
    };
    if (!fits(from, window.left, window.top) || !fits(to, left, top) ||
        (from.plane_mask() | to.plane_mask()) != from.plane_mask()) {
        throw InputError(fmt::format(
            "{} x {} pixels at ({}, {}) of a film of {} x {} with the planes '{}' cannot be copied to ({}, {}) of one "
            "of {} x {} with '{}'",
            window.width, window.height, window.left, window.top, from.width(), from.height(),
            to_string(from.plane_mask()), left, top, to.width(), to.height(), to_string(to.plane_mask())));
    }
    const auto index = [](const Film& film, int x, int y) { return static_cast<std::ptrdiff_t>(y) * film.width() + x; };
    const auto copy = [&](auto* target, const auto* source) {
        for (int y = 0; y < window.height; ++y) {
            std::copy_n(source + index(from, window.left, window.top + y), window.width,
                        target + index(to, left, top + y));
        }
    };
    copy(to.sums().data(), from.sums().data());
    const FilmPlanes targets = to.planes();
    const ConstFilmPlanes sources = from.planes();
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (targets.name != nullptr) copy(targets.name, sources.name);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
}

}  // namespace tandem

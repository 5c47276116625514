/// Films whose values differ for every pixel, channel and plane.
#pragma once

#include "tandem/film/film.h"

namespace tandem::test {

/// Value i, for planes of every type.
inline void put(Vec3d& to, double value) { to = {value, value + 0.25, value + 0.5}; }
inline void put(float& to, double value) { to = static_cast<float>(value); }
inline void put(std::uint32_t& to, double value) { to = static_cast<std::uint32_t>(4e9 + value); }

inline void fill_planes(Film& film, double first = 1) {
    const FilmPlanes planes = film.planes();
    double value = first;
    const auto fill = [&](auto* values) {
        if (values == nullptr) return;
        for (std::size_t i = 0; i < film.pixel_count(); ++i) put(values[i], value++);
    };
#define TANDEM_PLANE(name, Value, rule, channels, help) fill(planes.name);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
}

inline Film plane_film(int width, int height, int samples, PlaneMask planes, double first = 1) {
    Film film(width, height, samples, planes);
    for (Vec3d& sum : film.sums()) put(sum, first++);
    fill_planes(film, first);
    return film;
}

}  // namespace tandem::test

/// The planes of a film beside its colour, as plain pointers for kernels; planes.def lists them.
#pragma once

#include <cstdint>

#include "tandem/math/vec.h"

namespace tandem {

enum class FilmPlane : std::uint32_t {
#define TANDEM_PLANE(name, Value, rule, channels, help) name,
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
};

/// How the samples of a pixel, and films of other samples, combine.
/// mean: the film keeps the sum; files hold the mean. variance: the film keeps the sum of squares; files hold the
/// unbiased estimate of the variance of the mean. first: the value of the film's first sample. count: the sum.
enum class PlaneRule { mean, variance, first, count };

/// A set of planes.
struct PlaneMask {
    std::uint32_t bits = 0;

    constexpr PlaneMask() = default;
    constexpr PlaneMask(FilmPlane plane) : bits(1U << static_cast<std::uint32_t>(plane)) {}

    [[nodiscard]] constexpr bool has(FilmPlane plane) const { return (bits & PlaneMask(plane).bits) != 0; }
    [[nodiscard]] constexpr bool has_any(PlaneMask of) const { return (bits & of.bits) != 0; }
    [[nodiscard]] constexpr bool empty() const { return bits == 0; }
    constexpr PlaneMask& operator|=(PlaneMask other) {
        bits |= other.bits;
        return *this;
    }
    friend constexpr PlaneMask operator|(PlaneMask a, PlaneMask b) { return a |= b; }
    friend constexpr bool operator==(PlaneMask, PlaneMask) = default;
};

constexpr PlaneMask operator|(FilmPlane a, FilmPlane b) { return PlaneMask(a) | PlaneMask(b); }

/// The planes that follow a rule.
[[nodiscard]] constexpr PlaneMask planes_by(PlaneRule wanted) {
    PlaneMask planes;
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (PlaneRule::rule == wanted) planes |= FilmPlane::name;
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    return planes;
}

/// The values of all pixels, by plane, row by row from the top left; null for a plane that was not requested.
struct FilmPlanes {
#define TANDEM_PLANE(name, Value, rule, channels, help) Value* name = nullptr;
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
};

/// The same, read-only.
struct ConstFilmPlanes {
#define TANDEM_PLANE(name, Value, rule, channels, help) const Value* name = nullptr;
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
};

}  // namespace tandem

#include "tandem/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"
#include "tandem/film/plane_names.h"

namespace tandem {

namespace {

constexpr std::size_t plane_alignment = 64;

std::size_t aligned(std::size_t bytes) { return (bytes + plane_alignment - 1) / plane_alignment * plane_alignment; }

/// Calls f(FilmPlane, its values) for each plane of the film; `Planes`: FilmPlanes or ConstFilmPlanes.
template <class Planes, class F>
void for_each_plane(const Planes& planes, F f) {
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (planes.name != nullptr) f(FilmPlane::name, planes.name);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
}

}  // namespace

std::size_t film_bytes(std::size_t pixels, PlaneMask planes) {
    std::size_t bytes = pixels * sizeof(Vec3d);
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (planes.has(FilmPlane::name)) bytes = aligned(bytes) + pixels * sizeof(Value);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    return bytes;
}

FilmPlanes planes_in(Vec3d* sums, std::size_t pixels, PlaneMask planes) {
    FilmPlanes result;
    PlaneMask before;
    auto* const memory = reinterpret_cast<std::byte*>(sums);
#define TANDEM_PLANE(name, Value, rule, channels, help)                                       \
    if (planes.has(FilmPlane::name)) {                                                        \
        result.name = reinterpret_cast<Value*>(memory + aligned(film_bytes(pixels, before))); \
        before |= FilmPlane::name;                                                            \
    }
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    return result;
}

Film::Film(int width, int height, int samples, PlaneMask planes)
    : width_(width), height_(height), samples_(samples), plane_mask_(planes) {
    const std::size_t bytes = film_bytes(pixel_count(), planes);
    sums_ =
        std::shared_ptr<Vec3d>(new Vec3d[(bytes + sizeof(Vec3d) - 1) / sizeof(Vec3d)], std::default_delete<Vec3d[]>());
    std::memset(static_cast<void*>(sums_.get()), 0, bytes);
}

Film::Film(int width, int height, int samples, std::shared_ptr<Vec3d> owner, PlaneMask planes)
    : width_(width), height_(height), samples_(samples), plane_mask_(planes), sums_(std::move(owner)) {}

FilmPlanes Film::planes() { return planes_in(sums_.get(), pixel_count(), plane_mask_); }

ConstFilmPlanes Film::planes() const {
    const FilmPlanes planes = planes_in(sums_.get(), pixel_count(), plane_mask_);
    return {
#define TANDEM_PLANE(name, Value, rule, channels, help) planes.name,
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    };
}

void Film::add(const Film& later) {
    if (has_own_samples() || later.has_own_samples()) {
        throw InputError("a film whose pixels have different numbers of samples cannot be added to another");
    }
    if (later.width_ != width_ || later.height_ != height_ || later.plane_mask_ != plane_mask_) {
        throw InputError(fmt::format(
            "a film of {} x {} with the planes '{}' cannot be added to one of {} x {} with '{}'", later.width_,
            later.height_, to_string(later.plane_mask_), width_, height_, to_string(plane_mask_)));
    }
    const auto sum = [this](auto* to, const auto* from) {
        std::transform(to, to + pixel_count(), from, to, [](const auto& a, const auto& b) { return a + b; });
    };
    sum(sums_.get(), later.sums_.get());
    const FilmPlanes to = planes();
    const ConstFilmPlanes from = later.planes();
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (to.name != nullptr && PlaneRule::rule != PlaneRule::first) sum(to.name, from.name);
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    samples_ += later.samples_;
}

std::string film_hash(const Film& film) {
    Sha256 hash;
    hash.update_value(std::int32_t{film.width()});
    hash.update_value(std::int32_t{film.height()});
    hash.update_value(std::int32_t{film.samples()});
    for (std::size_t i = 0; film.has_own_samples() && i < film.pixel_count(); ++i) {
        hash.update_value(film.samples_of(i));
    }
    hash.update(film.sums().data(), film.sums().size_bytes());
    return hash.hex();
}

std::string plane_hash(const Film& film, FilmPlane plane) {
    Sha256 hash;
    for_each_plane(film.planes(), [&](FilmPlane at, const auto* values) {
        if (at == plane) hash.update(values, film.pixel_count() * sizeof(*values));
    });
    return hash.hex();
}

}  // namespace tandem

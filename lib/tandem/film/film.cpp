#include "tandem/film/film.h"

#include <cstdint>

#include "tandem/base/sha256.h"

namespace tandem {

Film::Film(int width, int height, int samples) : width_(width), height_(height), samples_(samples) {
    sums_ = std::shared_ptr<Vec3d>(new Vec3d[pixel_count()], std::default_delete<Vec3d[]>());
    for (Vec3d& sum : sums()) sum = {0, 0, 0};
}

Film::Film(int width, int height, int samples, std::shared_ptr<Vec3d> owner)
    : width_(width), height_(height), samples_(samples), sums_(std::move(owner)) {}

std::string film_hash(const Film& film) {
    Sha256 hash;
    hash.update_value(std::int32_t{film.width()});
    hash.update_value(std::int32_t{film.height()});
    hash.update_value(std::int32_t{film.samples()});
    hash.update(film.sums().data(), film.sums().size_bytes());
    return hash.hex();
}

}  // namespace tandem

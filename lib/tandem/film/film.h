/// What a camera saw: the sums of the samples of every pixel.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "tandem/math/vec.h"

namespace tandem {

/// Linear RGB sums in double, row by row from the top left. The samples of a pixel are added in the order of their
/// numbers, so the sums are the same bits from every backend, thread count and tile order. Memory may belong to a
/// backend (page-locked buffers); the film keeps it alive.
class Film {
  public:
    Film() = default;
    /// Zeroed, in ordinary memory.
    Film(int width, int height, int samples);
    /// Over memory of width * height sums that `owner` keeps alive.
    Film(int width, int height, int samples, std::shared_ptr<Vec3d> owner);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int samples() const { return samples_; }
    [[nodiscard]] std::size_t pixel_count() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    [[nodiscard]] std::span<Vec3d> sums() { return {sums_.get(), pixel_count()}; }
    [[nodiscard]] std::span<const Vec3d> sums() const { return {sums_.get(), pixel_count()}; }

    /// Mean radiance of a pixel, one rounding to float.
    [[nodiscard]] Vec3f mean(std::size_t pixel) const { return narrow(sums()[pixel] / static_cast<double>(samples_)); }

  private:
    int width_ = 0;
    int height_ = 0;
    int samples_ = 0;
    std::shared_ptr<Vec3d> sums_;
};

/// SHA-256 of size, samples and the bits of all sums (little endian), in hexadecimal: equal hashes mean equal
/// films, bit for bit.
[[nodiscard]] std::string film_hash(const Film& film);

}  // namespace tandem

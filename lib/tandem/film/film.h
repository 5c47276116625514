/// The film: the sums of the samples of every pixel, and the other planes that were requested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tandem/film/film_planes.h"
#include "tandem/math/vec.h"

namespace tandem {

/// Linear RGB sums in double, row by row from the top left. The samples of a pixel are added in the order of their
/// numbers, so the sums are the same bits from every backend, thread count and tile order. Memory may belong to a
/// backend (page-locked buffers); the film keeps it alive.
class Film {
  public:
    Film() = default;
    /// Zeroed, in ordinary memory.
    Film(int width, int height, int samples, PlaneMask planes = {});
    /// Over film_bytes() of memory that `owner` keeps alive: the sums, and the planes after them.
    Film(int width, int height, int samples, std::shared_ptr<Vec3d> owner, PlaneMask planes = {});

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    /// Per pixel; the most if pixels have their own numbers.
    [[nodiscard]] int samples() const { return samples_; }
    /// The samples of a pixel: samples(), unless set_samples() was called.
    [[nodiscard]] std::uint32_t samples_of(std::size_t pixel) const {
        return own_samples_ ? (*own_samples_)[pixel] : static_cast<std::uint32_t>(samples_);
    }
    [[nodiscard]] bool has_own_samples() const { return own_samples_ != nullptr; }
    /// Gives each pixel a number of samples of its own, none of them above samples().
    void set_samples(std::vector<std::uint32_t> of_pixels) {
        own_samples_ = std::make_shared<const std::vector<std::uint32_t>>(std::move(of_pixels));
    }
    [[nodiscard]] std::size_t pixel_count() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    [[nodiscard]] std::span<Vec3d> sums() { return {sums_.get(), pixel_count()}; }
    [[nodiscard]] std::span<const Vec3d> sums() const { return {sums_.get(), pixel_count()}; }

    /// The planes of the film.
    [[nodiscard]] PlaneMask plane_mask() const { return plane_mask_; }
    [[nodiscard]] FilmPlanes planes();
    [[nodiscard]] ConstFilmPlanes planes() const;

    /// Mean radiance of a pixel, rounded once to float.
    [[nodiscard]] Vec3f mean(std::size_t pixel) const {
        return narrow(sums()[pixel] / static_cast<double>(samples_of(pixel)));
    }

    /// Adds a film of the following samples. Throws InputError if size or planes differ, or if pixels have their own
    /// numbers of samples.
    void add(const Film& later);

  private:
    int width_ = 0;
    int height_ = 0;
    int samples_ = 0;
    PlaneMask plane_mask_;
    std::shared_ptr<Vec3d> sums_;
    std::shared_ptr<const std::vector<std::uint32_t>> own_samples_;  ///< null: all pixels have samples_
};

/// The size of a film's memory.
[[nodiscard]] std::size_t film_bytes(std::size_t pixels, PlaneMask planes);

/// The addresses of the planes in the memory of a film, which starts at `sums`, on the host or on a GPU.
[[nodiscard]] FilmPlanes planes_in(Vec3d* sums, std::size_t pixels, PlaneMask planes);

/// SHA-256 of size, samples (of each pixel too, if they have their own) and the bits of all sums (little endian), in
/// hexadecimal: equal hashes mean equal films, bit for bit. The planes beside the colour are not included.
[[nodiscard]] std::string film_hash(const Film& film);

/// SHA-256 of the bits of one plane, in hexadecimal. The film must have the plane.
[[nodiscard]] std::string plane_hash(const Film& film, FilmPlane plane);

}  // namespace tandem

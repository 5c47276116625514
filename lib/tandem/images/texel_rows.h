/// Converts rows of an image to texels, at its own size or smaller.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "tandem/images/texels.h"

namespace tandem {

/// Takes the rows of an image from the top, and turns every square of 2^shift x 2^shift pixels into a texel: the mean
/// of each channel, in the levels of the file, rounded to the nearest. Squares at the right and the lower edge may be
/// incomplete. So a large image never has to be in memory as a whole.
class TexelRows {
  public:
    static constexpr std::uint32_t channels = 4;

    TexelRows(std::uint32_t width, std::uint32_t height, unsigned shift)
        : width_(width), height_(height), shift_(shift) {
        result_.width = shrunk_edge(width, shift);
        result_.height = shrunk_edge(height, shift);
        result_.texels.resize(std::size_t{result_.width} * result_.height);
        if (shift > 0) sums_.resize(std::size_t{result_.width} * channels);
    }

    /// Adds a row of RGBA pixels. Throws nothing.
    void add(const std::uint8_t* row) {
        if (shift_ == 0) {
            std::memcpy(&result_.texels[std::size_t{row_} * width_], row, std::size_t{width_} * channels);
            ++row_;
            return;
        }
        for (std::uint32_t x = 0; x < width_; ++x) {
            std::uint32_t* sum = &sums_[std::size_t{x >> shift_} * channels];
            for (std::uint32_t c = 0; c < channels; ++c) sum[c] += row[std::size_t{x} * channels + c];
        }
        ++row_;
        if (row_ == height_ || row_ % (1U << shift_) == 0) finish_squares();
    }

    /// Returns the texels, after the last row.
    Texels take() { return std::move(result_); }

  private:
    void finish_squares() {
        const std::uint32_t y = (row_ - 1) >> shift_;
        const std::uint32_t rows = row_ - (y << shift_);
        std::uint32_t* texels = &result_.texels[std::size_t{y} * result_.width];
        for (std::uint32_t x = 0; x < result_.width; ++x) {
            const std::uint32_t count = rows * std::min(1U << shift_, width_ - (x << shift_));
            std::uint32_t texel = 0;
            for (std::uint32_t c = 0; c < channels; ++c) {
                const std::uint32_t sum = sums_[std::size_t{x} * channels + c];
                texel |= (sum + count / 2) / count << 8 * c;
            }
            texels[x] = texel;
        }
        std::fill(sums_.begin(), sums_.end(), 0U);
    }

    std::uint32_t width_, height_;
    unsigned shift_;
    std::uint32_t row_ = 0;            ///< number of rows so far
    std::vector<std::uint32_t> sums_;  ///< of the current squares; 2^24 pixels of 255 fit
    Texels result_;
};

}  // namespace tandem

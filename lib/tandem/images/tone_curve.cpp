#include "tandem/images/tone_curve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "tandem/math/fp_environment.h"
#include "tandem/math/srgb.h"

namespace tandem {

namespace {

// The levels of a transfer function are found in two steps. place() is arithmetic alone, so compilers vectorise loops
// over it; at() may look into a table. In one loop, the table would keep all of it scalar.

/// 255 times the clamped value, rounded to the nearest. The product is exact in double, so there is one rounding.
struct LinearLevels {
    [[nodiscard]] static std::uint32_t place(float linear) {
        const double with_half = static_cast<double>(clamp_to_unit(linear)) * 255.0 + 0.5;
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(with_half));
    }
    [[nodiscard]] static std::uint8_t at(std::uint32_t place) { return static_cast<std::uint8_t>(place); }
};

/// The levels of sRGB, from a table indexed by the upper half of a float's bits. Each entry covers at most one border
/// between levels and stores it: the least float of the upper level. So a level is exact if the borders are, which a
/// test checks with many digits.
class SrgbLevels {
  public:
    SrgbLevels() {
        std::size_t from = 0;
        for (std::uint32_t level = 1; level <= 255; ++level) {
            const std::uint32_t border = place(least_float_from(linear_of_srgb((level - 0.5) / 255.0)));
            const std::size_t last = border >> 16;
            for (; from < last; ++from) entries_[from] = (level - 1) << 16;
            entries_[from++] = ((level - 1) << 16) + (0x10000 - (border & 0xFFFF));
        }
        for (; from < entries_.size(); ++from) entries_[from] = 255 << 16;
    }

    /// The distance from `least`, in floats; a NaN becomes black.
    [[nodiscard]] static std::uint32_t place(float linear) {
        const float positive = linear > least ? linear : least;
        const float clamped = positive < 1 ? positive : 1.0F;
        return std::bit_cast<std::uint32_t>(clamped) - std::bit_cast<std::uint32_t>(least);
    }
    [[nodiscard]] std::uint8_t at(std::uint32_t place) const {
        return static_cast<std::uint8_t>((entries_[place >> 16] + (place & 0xFFFF)) >> 16);
    }

  private:
    static constexpr float least = 0x1p-13F;  ///< less than any border

    static float least_float_from(double value) {
        const float nearest = narrow(value);
        return widen(nearest) < value ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
    }

    /// From 2^-13 to 1, one for each 2^16 floats, so 128 for each power of two: 2^16 times the level of the first
    /// float, plus how many of the floats are not below the border. With the lower half of a place added, it carries
    /// into the next level from the border on.
    std::array<std::uint32_t, 13 * 128 + 1> entries_{};
};

template <class Levels>
const Levels& levels_of() {
    static const Levels levels;
    return levels;
}

/// Pixels that are converted together: their values stay in the cache.
constexpr std::size_t block_pixels = 256;

/// `means(first, pixels, to)` writes the linear values of the pixels from `first` on, three floats for each.
template <class Levels, class Means>
ToneMapped tone_map(int width, int height, double factor, const Means& means) {
    const Levels& levels = levels_of<Levels>();
    ToneMapped result{{width, height, {}}, 0};
    const std::size_t pixels = pixel_count(result.image);
    result.image.values.resize(3 * pixels);
    std::uint8_t* to = result.image.values.data();
    // a loop for each step, so that compilers vectorise all but the table
    std::array<float, 3 * block_pixels> values;
    std::array<std::uint32_t, 3 * block_pixels> places;
    for (std::size_t first = 0; first < pixels; first += block_pixels) {
        const std::size_t count = std::min(block_pixels, pixels - first);
        means(first, count, values.data());
        const auto find_places = [&](const auto& exposed) {
            std::uint32_t nan_values = 0;
            for (std::size_t i = 0; i < 3 * count; ++i) {
                nan_values += values[i] != values[i] ? 1 : 0;
                places[i] = Levels::place(exposed(values[i]));
            }
            result.nan_values += nan_values;
        };
        if (factor == 1) {
            find_places([](float value) { return value; });
        } else {
            find_places([&](float value) { return static_cast<float>(static_cast<double>(value) * factor); });
        }
        for (std::size_t i = 0; i < 3 * count; ++i) to[i] = levels.at(places[i]);
        to += 3 * count;
    }
    return result;
}

template <class Means>
ToneMapped tone_map(int width, int height, const Display& display, const Means& means) {
    const double factor = exposure_factor(display);
    if (display.transfer == TransferFunction::linear) return tone_map<LinearLevels>(width, height, factor, means);
    return tone_map<SrgbLevels>(width, height, factor, means);
}

/// The value of levels for one float.
template <class Levels>
std::uint8_t level_of(float linear) {
    return levels_of<Levels>().at(Levels::place(linear));
}

}  // namespace

std::uint8_t to_level(float linear, TransferFunction transfer) {
    return transfer == TransferFunction::linear ? level_of<LinearLevels>(linear) : level_of<SrgbLevels>(linear);
}

ToneMapped tone_map(const FloatImage& image, const Display& display) {
    const DefaultFpEnvironment guard;
    const auto means = [&](std::size_t first, std::size_t count, float* to) {
        std::memcpy(to, &image.pixels[first], count * sizeof(Vec3f));
    };
    return tone_map(image.width, image.height, display, means);
}

ToneMapped tone_map(const Film& film, const Display& display) {
    const DefaultFpEnvironment guard;
    const double samples = film.samples();
    const auto means = [&](std::size_t first, std::size_t count, float* to) {
        if (film.has_own_samples()) {
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3f mean = film.mean(first + i);
                std::copy_n(&mean.x, 3, to + 3 * i);
            }
            return;
        }
        const auto* sums = reinterpret_cast<const double*>(&film.sums()[first]);
        // as Film::mean(), whose narrow() cannot be vectorised
        for (std::size_t i = 0; i < 3 * count; ++i) to[i] = static_cast<float>(sums[i] / samples);
    };
    return tone_map(film.width(), film.height(), display, means);
}

std::vector<float> values_of_levels(std::uint32_t most, const Display& display) {
    const DefaultFpEnvironment guard;
    const double factor = exposure_factor(display);
    std::vector<float> values;
    values.reserve(most + 1);
    for (std::uint32_t level = 0; level <= most; ++level) {
        const double share = static_cast<double>(level) / most;
        const float shown = narrow(display.transfer == TransferFunction::srgb ? linear_of_srgb(share) : share);
        values.push_back(narrow(widen(shown) / factor));
    }
    return values;
}

FloatImage to_float(const ByteImage& image, const Display& display) {
    FloatImage result{image.width, image.height, {}};
    result.pixels.resize(pixel_count(image));
    const std::vector<float> values = values_of_levels(255, display);
    const auto value = [&](std::size_t i) { return values[image.values[i]]; };
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        result.pixels[i] = {value(3 * i), value(3 * i + 1), value(3 * i + 2)};
    }
    return result;
}

}  // namespace tandem

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

/// 255 times the clamped value, rounded to the nearest. The product is exact in double, so there is one rounding.
inline std::uint8_t linear_level(float linear) {
    const double with_half = static_cast<double>(clamp_to_unit(linear)) * 255.0 + 0.5;
    return static_cast<std::uint8_t>(static_cast<int>(with_half));
}

/// The levels of sRGB, from a table indexed by the upper half of a float's bits. Each entry covers at most one border
/// between levels and stores it: the least float of the upper level. So a level is exact if the borders are, which a
/// test checks with many digits.
class SrgbLevels {
  public:
    SrgbLevels() {
        entries_.fill({infinity, 0});
        std::size_t from = 0;
        for (int level = 1; level <= 255; ++level) {
            const float border = least_float_from(linear_of_srgb((level - 0.5) / 255.0));
            const std::size_t at = index_of(border);
            for (; from <= at; ++from) entries_[from].below = static_cast<std::uint8_t>(level - 1);
            entries_[at].border = border;
        }
        for (; from < entries_.size(); ++from) entries_[from].below = 255;
    }

    [[nodiscard]] std::uint8_t operator()(float linear) const {
        const float clamped = linear > least ? (linear < 1 ? linear : 1.0F) : least;  // a NaN becomes black
        const Entry& entry = entries_[index_of(clamped)];
        return static_cast<std::uint8_t>(entry.below + (clamped >= entry.border ? 1 : 0));
    }

  private:
    struct Entry {
        float border;
        std::uint8_t below;  ///< level of the floats that are less
    };

    static constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr float least = 0x1p-13F;  ///< less than any border

    static std::size_t index_of(float value) {
        return (std::bit_cast<std::uint32_t>(value) - std::bit_cast<std::uint32_t>(least)) >> 16;
    }
    static float least_float_from(double value) {
        const float nearest = narrow(value);
        return widen(nearest) < value ? std::nextafter(nearest, infinity) : nearest;
    }

    std::array<Entry, 13 * 128 + 1> entries_{};  ///< from 2^-13 to 1, 128 for each power of two
};

const SrgbLevels& srgb_levels() {
    static const SrgbLevels levels;
    return levels;
}

/// `pixel` gives the linear colour of a pixel by its number, `level` the level of a value.
template <class Pixel, class Level>
ToneMapped tone_map(int width, int height, double factor, const Pixel& pixel, const Level& level) {
    ToneMapped result{{width, height, {}}, 0};
    const std::size_t pixels = pixel_count(result.image);
    result.image.values.resize(3 * pixels);
    std::uint8_t* levels = result.image.values.data();
    // in blocks of plain floats, which compilers vectorise
    constexpr std::size_t block_pixels = 256;
    float values[3 * block_pixels];
    for (std::size_t first = 0; first < pixels; first += block_pixels) {
        const std::size_t count = std::min(block_pixels, pixels - first);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f linear = pixel(first + i);
            std::memcpy(&values[3 * i], &linear, sizeof linear);
        }
        std::uint32_t nan_values = 0;
        for (std::size_t i = 0; i < 3 * count; ++i) {
            levels[i] = level(static_cast<float>(static_cast<double>(values[i]) * factor));
            nan_values += values[i] != values[i] ? 1 : 0;
        }
        result.nan_values += nan_values;
        levels += 3 * count;
    }
    return result;
}

template <class Pixel>
ToneMapped tone_map(int width, int height, const Display& display, const Pixel& pixel) {
    const double factor = exposure_factor(display);
    if (display.transfer == TransferFunction::linear) {
        return tone_map(width, height, factor, pixel, [](float linear) { return linear_level(linear); });
    }
    return tone_map(width, height, factor, pixel, srgb_levels());
}

}  // namespace

std::uint8_t to_level(float linear, TransferFunction transfer) {
    return transfer == TransferFunction::linear ? linear_level(linear) : srgb_levels()(linear);
}

ToneMapped tone_map(const FloatImage& image, const Display& display) {
    const DefaultFpEnvironment guard;
    return tone_map(image.width, image.height, display, [&](std::size_t i) { return image.pixels[i]; });
}

ToneMapped tone_map(const Film& film, const Display& display) {
    const DefaultFpEnvironment guard;
    return tone_map(film.width(), film.height(), display, [&](std::size_t i) { return film.mean(i); });
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

#include "tandem/images/tone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "tandem/math/fp_environment.h"
#include "tandem/math/srgb.h"

namespace tandem {

namespace {

float least_float_from(double value) {
    const float nearest = narrow(value);
    return widen(nearest) < value ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

SrgbLevels::Entries make_entries() {
    SrgbLevels::Entries entries{};
    std::size_t from = 0;
    for (std::uint32_t level = 1; level <= 255; ++level) {
        const std::uint32_t border = SrgbLevels::place(least_float_from(linear_of_srgb((level - 0.5) / 255.0)));
        const std::size_t last = border >> 16;
        for (; from < last; ++from) entries[from] = (level - 1) << 16;
        entries[from++] = ((level - 1) << 16) + (0x10000 - (border & 0xFFFF));
    }
    for (; from < entries.size(); ++from) entries[from] = 255 << 16;
    return entries;
}

template <class Levels>
Levels levels_of();
template <>
LinearLevels levels_of() {
    return {};
}
template <>
SrgbLevels levels_of() {
    return {srgb_level_entries().data()};
}

/// Pixels that are converted together: their values stay in the cache.
constexpr std::size_t block_pixels = 256;

/// `means(first, pixels, to)` writes the linear values of the pixels from `first` on, three floats for each.
template <class Levels, class Means>
ToneMapped tone_map(int width, int height, double factor, const Means& means) {
    const Levels levels = levels_of<Levels>();
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
        const auto find_places = [&](const auto& shown) {
            std::uint32_t nan_values = 0;
            for (std::size_t i = 0; i < 3 * count; ++i) {
                nan_values += values[i] != values[i] ? 1 : 0;
                places[i] = Levels::place(shown(values[i]));
            }
            result.nan_values += nan_values;
        };
        if (factor == 1) {
            find_places([](float value) { return value; });
        } else {
            find_places([&](float value) { return exposed(value, factor); });
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

const SrgbLevels::Entries& srgb_level_entries() {
    static const SrgbLevels::Entries entries = [] {
        const DefaultFpEnvironment guard;
        return make_entries();
    }();
    return entries;
}

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
        for (std::size_t i = 0; i < 3 * count; ++i) to[i] = mean_of_sum(sums[i], samples);
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

#include "tandem/render/flip_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "tandem/film/variance.h"
#include "tandem/images/flip.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

constexpr int block_edge = 16;

/// What is known of the pixels of a film: row by row from the top left.
struct Pixels {
    int width = 0, height = 0;
    std::vector<Vec3d> means;
    std::vector<Vec3d> variances;  ///< of the means
    std::vector<Vec3d> contrasts;  ///< as random as the means are, without a mean of their own

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

void add_tile(Pixels& pixels, const FilmWindow& window, const Film& all, const Film& fresh) {
    const double samples = all.samples(), part = fresh.samples(), others = samples - part;
    const double scale = std::sqrt(part * others) / samples;
    const Vec3d* const squares = all.planes().variance;
    std::size_t i = 0;
    for (int y = window.top; y < window.top + window.height; ++y) {
        for (int x = window.left; x < window.left + window.width; ++x, ++i) {
            const std::size_t to = pixels.index(x, y);
            const Vec3d &a = all.sums()[i], &f = fresh.sums()[i];
            pixels.means[to] = a / samples;
            pixels.variances[to] = {variance_of_mean(a.x, squares[i].x, samples),
                                    variance_of_mean(a.y, squares[i].y, samples),
                                    variance_of_mean(a.z, squares[i].z, samples)};
            pixels.contrasts[to] = (f / part - (a - f) / others) * scale;
        }
    }
}

/// Calls f(x, y, index) for the pixels of the film that are within `radius` of a pixel.
template <class F>
void for_neighbours(const Pixels& pixels, int x, int y, int radius, F f) {
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, pixels.height - 1); ++v) {
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, pixels.width - 1); ++u) {
            f(u, v, pixels.index(u, v));
        }
    }
}

/// Calls f(x, y, index) for every pixel, row by row.
template <class F>
void for_each_pixel(const Pixels& pixels, F f) {
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) f(x, y, pixels.index(x, y));
    }
}

double smoothed(double value, double mean, double spread, double noise) {
    if (!(spread > 0)) return value;
    return mean + std::max(0.0, 1 - noise / spread) * (value - mean);
}

std::vector<Vec3d> without_noise(const Pixels& pixels) {
    std::vector<Vec3d> result(pixels.means.size());
    for_each_pixel(pixels, [&](int x, int y, std::size_t i) {
        Vec3d sum{0, 0, 0}, squares{0, 0, 0}, noise{0, 0, 0};
        double count = 0;
        for_neighbours(pixels, x, y, 2, [&](int, int, std::size_t j) {
            // relative to the pixel, so that nothing cancels
            const Vec3d d = pixels.means[j] - pixels.means[i];
            sum = sum + d;
            squares = squares + d * d;
            noise = noise + pixels.variances[j];
            count += 1;
        });
        const Vec3d &at = pixels.means[i], m = sum / count;
        const Vec3d spread = (squares - sum * m) / std::max(count - 1, 1.0), v = noise / count;
        result[i] = {smoothed(at.x, at.x + m.x, spread.x, v.x), smoothed(at.y, at.y + m.y, spread.y, v.y),
                     smoothed(at.z, at.z + m.z, spread.z, v.z)};
    });
    return result;
}

/// The sums of f(index) over the window of every pixel.
template <class F>
std::vector<Vec3d> window_sums(const Pixels& pixels, int radius, F f) {
    std::vector<Vec3d> rows(pixels.means.size()), sums(pixels.means.size());
    for_each_pixel(pixels, [&](int x, int y, std::size_t i) {
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, pixels.width - 1); ++u) {
            rows[i] = rows[i] + f(pixels.index(u, y));
        }
    });
    for_each_pixel(pixels, [&](int x, int y, std::size_t i) {
        for (int v = std::max(y - radius, 0); v <= std::min(y + radius, pixels.height - 1); ++v) {
            sums[i] = sums[i] + rows[pixels.index(x, v)];
        }
    });
    return sums;
}

/// Where all values of a wide window spread as little as their noise does, within three standard errors of a variance:
/// replaces the truth of a channel by their mean, and the variance of its noise by the mean variance.
void smooth_widely(const Pixels& pixels, int radius, std::vector<Vec3d>& truth, std::vector<Vec3d>& variances) {
    const auto sums = window_sums(pixels, radius, [&](std::size_t i) { return pixels.means[i]; });
    const auto squares = window_sums(pixels, radius, [&](std::size_t i) { return pixels.means[i] * pixels.means[i]; });
    const auto noise = window_sums(pixels, radius, [&](std::size_t i) { return pixels.variances[i]; });
    const auto length = [&](int at, int size) {
        return std::min(at + radius, size - 1) - std::max(at - radius, 0) + 1;
    };
    for_each_pixel(pixels, [&](int x, int y, std::size_t i) {
        const double count = static_cast<double>(length(x, pixels.width)) * length(y, pixels.height);
        const double most = 1 + 3 * std::sqrt(2 / count);
        const auto smooth_channel = [&](double sum, double square, double of_noise, double& value, double& variance) {
            const double spread = (square - sum * sum / count) / std::max(count - 1, 1.0);
            if (!(spread <= most * of_noise / count)) return;
            value = sum / count;
            variance = of_noise / count;
        };
        const Vec3d &s = sums[i], &s2 = squares[i], &n = noise[i];
        smooth_channel(s.x, s2.x, n.x, truth[i].x, variances[i].x);
        smooth_channel(s.y, s2.y, n.y, truth[i].y, variances[i].y);
        smooth_channel(s.z, s2.z, n.z, truth[i].z, variances[i].z);
    });
}

/// Noise for every pixel, with its variance.
std::vector<Vec3d> some_noise(const Pixels& pixels, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Vec3d> result(pixels.means.size());
    for_each_pixel(pixels, [&](int x, int y, std::size_t i) {
        std::array<std::uint64_t, 3> bits{random(), random(), random()};
        int used = 0;
        Vec3d sum{0, 0, 0}, squares{0, 0, 0};
        for_neighbours(pixels, x, y, 1, [&](int, int, std::size_t j) {
            // from -1 to 1 in 2^16 steps, with the variance 1 / 3
            const auto word = (bits[static_cast<std::size_t>(used % 3)] >> (16 * (used / 3))) & 0xFFFF;
            const double factor = (static_cast<double>(word) + 0.5) / 32768 - 1;
            const Vec3d& d = pixels.contrasts[j];
            sum = sum + d * factor;
            squares = squares + d * d / 3.0;
            ++used;
        });
        const auto of_channel = [](double value, double square, double variance) {
            return square > 0 ? value * std::sqrt(variance / square) : 0;
        };
        const Vec3d& v = pixels.variances[i];
        result[i] = {of_channel(sum.x, squares.x, v.x), of_channel(sum.y, squares.y, v.y),
                     of_channel(sum.z, squares.z, v.z)};
    });
    return result;
}

FloatImage image_of(const Pixels& pixels, const std::vector<Vec3d>& truth, const std::vector<Vec3d>* noise,
                    double scale) {
    FloatImage image{pixels.width, pixels.height, {}};
    image.pixels.reserve(truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        image.pixels.push_back(narrow(noise != nullptr ? truth[i] + (*noise)[i] * scale : truth[i]));
    }
    return image;
}

/// The exponent of a tile whose errors at twice as many samples are `later`.
double exponent_of(double now, double later) {
    constexpr double ln2 = 0.6931471805599453;
    if (!(now > 0) || !(later > 0)) return 1;
    const double exponent = log_wide<float>(now / later) / ln2;
    return std::clamp(exponent, 0.05, 1.0);
}

/// The variance of the sum of a film's FLIP over each block, from the FLIP of two films.
std::vector<double> block_variances(const FlipDifference& a, const FlipDifference& b) {
    const TileGrid blocks{a.width, a.height, block_edge};
    std::vector<double> variances;
    for (std::size_t i = 0; i < blocks.count(); ++i) {
        const FilmWindow block = blocks.tile(i);
        double difference = 0;
        for (int y = block.top; y < block.top + block.height; ++y) {
            for (int x = block.left; x < block.left + block.width; ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
                difference += a.errors[at] - b.errors[at];
            }
        }
        variances.push_back(0.5 * difference * difference);
    }
    return variances;
}

}  // namespace

std::vector<TileErrors> flip_errors(const TiledFilm& all, const std::vector<Film>& fresh, const Display& display) {
    const DefaultFpEnvironment guard;
    const TileGrid& grid = all.grid();
    Pixels pixels{grid.width, grid.height, {}, {}, {}};
    const std::size_t count = pixels.index(0, grid.height);
    for (auto* values : {&pixels.means, &pixels.variances, &pixels.contrasts}) values->resize(count);
    for (std::size_t i = 0; i < grid.count(); ++i) add_tile(pixels, grid.tile(i), all.tile(i), fresh[i]);

    std::vector<Vec3d> truth = without_noise(pixels), variances_of_noise = pixels.variances;
    for (const int radius : {4, 8}) smooth_widely(pixels, radius, truth, variances_of_noise);
    pixels.variances = std::move(variances_of_noise);
    const std::vector<Vec3d> first = some_noise(pixels, 1), second = some_noise(pixels, 2);
    const std::array films = {image_of(pixels, truth, &first, 1), image_of(pixels, truth, &second, 1),
                              image_of(pixels, truth, &first, std::sqrt(0.5))};
    const FlipReference reference(image_of(pixels, truth, nullptr, 0), {.display = display});
    std::vector<FlipDifference> flips;
    for (const FloatImage& film : films) flips.push_back(reference.difference(film));

    const std::vector<double> variances = block_variances(flips[0], flips[1]);
    const TileGrid blocks{grid.width, grid.height, block_edge};
    std::vector<TileErrors> result(grid.count());
    for (std::size_t i = 0; i < grid.count(); ++i) {
        TileErrors& tile = result[i];
        const FilmWindow window = grid.tile(i);
        tile.samples = all.samples(i);
        tile.errors.pixels = static_cast<double>(pixel_count(window));
        std::array<double, 3> sums{};
        for (int y = window.top; y < window.top + window.height; ++y) {
            for (int x = window.left; x < window.left + window.width; ++x) {
                for (std::size_t f = 0; f < 3; ++f) sums[f] += flips[f].errors[pixels.index(x, y)];
                // each pixel has its share of the block's; the mean of two films has half the variance of one
                const std::size_t block =
                    static_cast<std::size_t>(y / block_edge) * static_cast<std::size_t>(blocks.columns()) +
                    static_cast<std::size_t>(x / block_edge);
                const double share = variances[block] / static_cast<double>(pixel_count(blocks.tile(block)));
                tile.errors.squares += 0.5 * (1 + 0.5) * share;
            }
        }
        tile.errors.sum = 0.5 * (sums[0] + sums[1]);
        tile.exponent = exponent_of(sums[0], sums[2]);
    }
    return result;
}

}  // namespace tandem

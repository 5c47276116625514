// The tables by which directions are sampled from an environment picture (kernel/lights/environment_picture.h).
#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "tandem/compile/environments.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

constexpr std::uint32_t all_numbers = 1U << 31;

/// (1 - cos(angle)) / 2 = sin^2(angle / 2) at the upper border of each band, from the pole to behind the equator.
std::vector<double> band_borders(std::uint32_t height) {
    std::vector<double> borders = {0};
    for (std::uint32_t band = 1; band <= height / 2 + 1; ++band) {
        const double sine = sin_cos_turns<double>((band - 0.5) / (4.0 * height)).sine;
        borders.push_back(sine * sine);
    }
    return borders;
}

/// Distributes all units in proportion to the weights; each weight above 0 gets at least one.
void share_out(std::span<const double> weights, std::span<std::uint32_t> ends) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const auto lit = static_cast<std::uint32_t>(
        std::count_if(weights.begin(), weights.end(), [](double weight) { return weight > 0; }));
    double sum = 0;  // in the order of `total`, so that the last quotient is 1
    std::uint32_t passed = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        if (weights[i] > 0) ++passed;
        ends[i] = lit == 0 ? 0 : passed + static_cast<std::uint32_t>(sum / total * (all_numbers - lit));
    }
}

/// The probabilities of the bands and of the cells of each band.
///
/// Gives: probabilities in proportion to the solid angle of a cell times its brightness (r + g) + b, in units of 2^-31.
///        A cell that is not black has at least one unit, a black one none. They are the same on every machine: sums in
///        double, in one order, no function of the C library.
void set_probabilities(PreparedScene& scene) {
    const std::uint32_t width = scene.environment_picture.width, height = scene.environment_picture.height;
    const std::span<const Vec3f> texels = scene.environment_texels;
    scene.environment_band_ends.resize(height + 1);
    scene.environment_cell_ends.resize((std::size_t{height} + 1) * width);
    std::vector<double> of_columns(width), of_cells(width), of_bands;
    for (std::uint32_t band = 0; band <= height; ++band) {
        const auto row = [&](std::uint32_t y) { return texels.subspan(std::size_t{y} * width, width); };
        const auto upper = row(band > 0 ? band - 1 : 0), lower = row(std::min(band, height - 1));
        const auto brightness = [](const Vec3f& a) { return norm1(widen(a)); };
        for (std::size_t x = 0; x < width; ++x) of_columns[x] = brightness(upper[x]) + brightness(lower[x]);
        for (std::size_t x = 0; x < width; ++x) of_cells[x] = of_columns[x] + of_columns[(x + 1) % width];
        share_out(of_cells, std::span(scene.environment_cell_ends).subspan(std::size_t{band} * width, width));

        const std::uint32_t from_pole = std::min(band, height - band);
        // of the sphere, whose area is 1
        const double extent = scene.environment_borders[from_pole + 1] - scene.environment_borders[from_pole];
        of_bands.push_back(std::accumulate(of_cells.begin(), of_cells.end(), 0.0) * extent);
    }
    share_out(of_bands, scene.environment_band_ends);
}

}  // namespace

void prepare_environment(const EnvironmentImage& image, PreparedScene& scene) {
    const DefaultFpEnvironment guard;
    const FloatImage& picture = image.picture;
    const auto width = static_cast<std::uint32_t>(picture.width), height = static_cast<std::uint32_t>(picture.height);
    scene.environment_picture = {image.rotation / (2 * pi), width, height, image.intensity};
    scene.environment_texels = picture.pixels;
    scene.environment_borders = band_borders(height);
    set_probabilities(scene);
}

}  // namespace tandem

#include "tandem/compile/environment_tables.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

Vec3d sum_of(std::span<const Vec3f> texels) {
    Vec3d sum{0, 0, 0};
    for (const Vec3f& texel : texels) sum += widen(texel);
    return sum;
}

}  // namespace

EnvironmentTables make_environment_tables(std::uint32_t width, std::uint32_t height, std::span<const Vec3f> texels) {
    const DefaultFpEnvironment guard;
    EnvironmentTables tables;
    tables.borders = band_borders(height);
    tables.band_ends.resize(height + 1);
    tables.cell_ends.resize((std::size_t{height} + 1) * width);
    std::vector<double> of_columns(width), of_cells(width), of_bands;
    for (std::uint32_t band = 0; band <= height; ++band) {
        const auto row = [&](std::uint32_t y) { return texels.subspan(std::size_t{y} * width, width); };
        const auto upper = row(band > 0 ? band - 1 : 0), lower = row(std::min(band, height - 1));
        const auto brightness = [](const Vec3f& a) { return norm1(widen(a)); };
        for (std::size_t x = 0; x < width; ++x) of_columns[x] = brightness(upper[x]) + brightness(lower[x]);
        for (std::size_t x = 0; x < width; ++x) of_cells[x] = of_columns[x] + of_columns[(x + 1) % width];
        share_out(of_cells, std::span(tables.cell_ends).subspan(std::size_t{band} * width, width));

        const std::uint32_t from_pole = std::min(band, height - band);
        const double extent = tables.borders[from_pole + 1] - tables.borders[from_pole];  // of the sphere, 1
        of_bands.push_back(std::accumulate(of_cells.begin(), of_cells.end(), 0.0) * extent);
        tables.mean_radiance += (sum_of(upper) + sum_of(lower)) * (extent / (2.0 * width));
    }
    share_out(of_bands, tables.band_ends);
    return tables;
}

void add_environment_picture(PreparedScene& scene, const EnvironmentImage& image) {
    const FloatImage& picture = image.picture;
    const auto width = static_cast<std::uint32_t>(picture.width), height = static_cast<std::uint32_t>(picture.height);
    scene.environment_picture = {image.rotation / (2 * pi), width, height, image.intensity};
    scene.environment_texels = picture.pixels;
    EnvironmentTables tables = make_environment_tables(width, height, picture.pixels);
    scene.environment_borders = std::move(tables.borders);
    scene.environment_band_ends = std::move(tables.band_ends);
    scene.environment_cell_ends = std::move(tables.cell_ends);
}

EnvironmentPictureView view_of(const EnvironmentPicture& picture, std::span<const Vec3f> texels,
                               const EnvironmentTables& tables) {
    return {picture, texels.data(), tables.borders.data(), tables.band_ends.data(), tables.cell_ends.data()};
}

}  // namespace tandem

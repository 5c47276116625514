/// The tables for sampling directions from an environment picture (environment_picture.h). On the host.
#pragma once

#include <span>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/lights/environment_picture.h"
#include "tandem/scene/environment_image.h"

namespace tandem {

struct EnvironmentTables {
    std::vector<double> borders;
    std::vector<std::uint32_t> band_ends, cell_ends;
    /// The mean over all directions, linear RGB, without `intensity`.
    Vec3d mean_radiance{0, 0, 0};
};

/// Needs: width and height from 1 to 65536, and width * height texels, finite and not negative, of at most 2^100.
/// Gives: probabilities in proportion to the solid angle of a cell times its brightness (r + g) + b, in units of 2^-31,
///        for the bands and for the cells of a band. A cell that is not black has at least one unit, a black one none.
///        The tables are the same on every machine: sums in double, in one order, no function of the C library.
[[nodiscard]] EnvironmentTables make_environment_tables(std::uint32_t width, std::uint32_t height,
                                                        std::span<const Vec3f> texels);

/// The environment picture and its tables.
void add_environment_picture(PreparedScene& scene, const EnvironmentImage& image);

/// `texels` and `tables` must outlive the view.
[[nodiscard]] EnvironmentPictureView view_of(const EnvironmentPicture& picture, std::span<const Vec3f> texels,
                                             const EnvironmentTables& tables);

}  // namespace tandem

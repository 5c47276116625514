/// The tables by which directions are drawn from a picture of the environment (environment_picture.h). On the host.
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
    /// Over all directions, linear RGB, without `intensity`. Times 4 pi the light that a point receives from all sides.
    Vec3d mean_radiance{0, 0, 0};
};

/// Needs: width and height from 1 to 65536, and width * height texels, finite and not negative, of at most 2^100.
/// Gives: chances in proportion to the solid angle of a cell times the brightness (r + g) + b in it, in units of 2^-31
/// of
///        the band, and of the sphere. What is not black has at least one unit, and what is black has none. The same
///        tables on every machine: sums in double, in one order, and no function of the C library.
[[nodiscard]] EnvironmentTables make_environment_tables(std::uint32_t width, std::uint32_t height,
                                                        std::span<const Vec3f> texels);

/// The picture of the environment and its tables.
void add_environment_picture(PreparedScene& scene, const EnvironmentImage& image);

/// `texels` and `tables` have to live as long as the view.
[[nodiscard]] EnvironmentPictureView view_of(const EnvironmentPicture& picture, std::span<const Vec3f> texels,
                                             const EnvironmentTables& tables);

}  // namespace tandem

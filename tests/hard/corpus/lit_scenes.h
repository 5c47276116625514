/// Small scenes for the light cases: a black background, one lamp, one surface; and statistics of their films.
#pragma once

#include <functional>
#include <string>

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

/// No background and no ambient light, and an orthographic camera at `eye` that looks along -z of `turn` and shows
/// 2 `ymag` metres.
[[nodiscard]] Scene dark_scene(const Vec3d& eye, double ymag, const Quaternion& turn = {});
/// To look straight down.
[[nodiscard]] Quaternion downward();

[[nodiscard]] Material lambertian_material(const std::string& name, float reflectance);
[[nodiscard]] Material mirror_lobe(const std::string& name, float shininess);  ///< Phong's highlight alone
[[nodiscard]] Material emissive(const std::string& name, float radiance);
[[nodiscard]] Material bright(const std::string& name);  ///< reflects only ambient light, all of it

/// A horizontal square around (x, y, z), its front above.
struct Square {
    Vec3f corner[4];
    Square(float x, float y, float z, float half)
        : corner{{x - half, y, z + half}, {x + half, y, z + half}, {x + half, y, z - half}, {x - half, y, z - half}} {}
};

/// Adds a material; returns its number.
std::uint32_t add_material(Scene& scene, Material material);
void add_shape(Scene& scene, const Shape& shape, const Vec3d& at, std::uint32_t material, const Quaternion& turn = {});
/// One quad with these corners, or two triangles.
void add_sheet(Scene& scene, const Vec3f (&corner)[4], std::uint32_t material, bool as_triangles = false);
Node& add_lamp(Scene& scene, const LightSource& light, const Vec3d& at, const Quaternion& turn = {});

/// All pixels of a square film as estimates of one number: red.
struct FilmMean {
    double mean;
    double error;  ///< standard error
    std::uint64_t invalid;
};
[[nodiscard]] FilmMean mean_of(Backend& backend, const PreparedScene& scene, const RenderJob& job, Score& score);

/// Expects the mean of a film within 5 standard errors, plus the relative tolerance `slack`. A relative error above
/// `most` is a failure, since the comparison would prove nothing.
void judge_mean(Score& score, const FilmMean& film, double right, double slack, double most, const std::string& what);

/// A square film.
[[nodiscard]] RenderJob square_film(const Subject& subject, int edge, int samples);

/// Calls judge(backend, name) with the subject's backend, and with the oracle in an exact tier.
void with_oracle(const Subject& subject, const std::function<void(Backend& backend, const std::string& name)>& judge);

}  // namespace tandem::hard

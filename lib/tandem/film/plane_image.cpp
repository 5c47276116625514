#include "tandem/film/plane_image.h"

#include <type_traits>

#include "tandem/film/variance.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// The value of a pixel in files; `sum`: that of the colour.
template <PlaneRule rule>
Vec3f written(const Vec3d& value, const Vec3d& sum, double samples) {
    if constexpr (rule == PlaneRule::mean) return narrow(value / samples);
    return narrow(Vec3d{variance_of_mean(sum.x, value.x, samples), variance_of_mean(sum.y, value.y, samples),
                        variance_of_mean(sum.z, value.z, samples)});
}

template <PlaneRule rule, class Value>
PlaneImage image_of(FilmPlane plane, const Value* values, const Film& film) {
    PlaneImage image{plane, {}, {}};
    const std::size_t pixels = film.pixel_count();
    if constexpr (std::is_same_v<Value, Vec3d>) {
        image.values.reserve(3 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            const Vec3f at = written<rule>(values[i], film.sums()[i], film.samples_of(i));
            image.values.insert(image.values.end(), {at.x, at.y, at.z});
        }
    } else if constexpr (std::is_same_v<Value, float>) {
        image.values.assign(values, values + pixels);
    } else {
        image.numbers.assign(values, values + pixels);
    }
    return image;
}

}  // namespace

std::vector<PlaneImage> plane_images(const Film& film) {
    const DefaultFpEnvironment guard;
    std::vector<PlaneImage> images;
    const ConstFilmPlanes planes = film.planes();
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    if (planes.name != nullptr) images.push_back(image_of<PlaneRule::rule>(FilmPlane::name, planes.name, film));
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    return images;
}

}  // namespace tandem

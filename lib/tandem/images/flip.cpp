#include "tandem/images/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tandem/base/error.h"
#include "tandem/base/processor_level.h"
#include "tandem/images/separable_filter.h"
#include "tandem/images/tone_curve.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/srgb.h"

namespace tandem {

/// An image as perceived: blurred colours, and features of the unblurred image.
struct flip_detail::Seen {
    /// At each pixel.
    struct Features {
        Plane edges;
        Plane points;
    };

    std::vector<Vec3d> lab;
    Features features;
};

namespace {

using flip_detail::Seen;

constexpr double pi = std::numbers::pi;

/// body(i) for each i below `count`, by a processor with FMA.
template <class Body>
[[gnu::target("avx2,fma"), gnu::flatten]] void for_each_with_fma(std::size_t count, const Body& body) {
    for (std::size_t i = 0; i < count; ++i) body(i);
}

/// body(i) for each i below `count`. Compiled twice, because without FMA each fused operation in power() is a call of
/// the C library. The bits are the same.
template <class Body>
void for_each(std::size_t count, const Body& body) {
    if (x86_64_level() >= 3) return for_each_with_fma(count, body);
    for (std::size_t i = 0; i < count; ++i) body(i);
}

double sum(const Vec3d& v) { return v.x + v.y + v.z; }

/// XYZ relative to white, so that white is (1, 1, 1).
Vec3d relative_xyz(const Vec3d& rgb) {
    return {dot(x_of_rgb, rgb) / sum(x_of_rgb), dot(y_of_rgb, rgb) / sum(y_of_rgb), dot(z_of_rgb, rgb) / sum(z_of_rgb)};
}

Vec3d rgb_of(const Vec3d& relative) {
    const Vec3d xyz{relative.x * sum(x_of_rgb), relative.y * sum(y_of_rgb), relative.z * sum(z_of_rgb)};
    const Vec3d yz = cross(y_of_rgb, z_of_rgb), zx = cross(z_of_rgb, x_of_rgb), xy = cross(x_of_rgb, y_of_rgb);
    return (yz * xyz.x + zx * xyz.y + xy * xyz.z) / dot(x_of_rgb, yz);
}

/// CIELAB with a and b scaled by lightness: colours matter less in the dark (the paper, section 4.1.2).
Vec3d hunt_lab(const Vec3d& rgb) {
    constexpr double delta = 6.0 / 29;
    const auto curve = [](double t) {
        return t > delta * delta * delta ? power<float>(t, 1.0 / 3) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const Vec3d xyz = relative_xyz(rgb);
    const Vec3d f{curve(xyz.x), curve(xyz.y), curve(xyz.z)};
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// HyAB: city-block distance in lightness, Euclidean distance in colour.
double hyab(const Vec3d& a, const Vec3d& b) { return std::abs(a.x - b.x) + length(a.y - b.y, a.z - b.z); }

constexpr double colour_exponent = 0.7;
constexpr double feature_exponent = 0.5;

/// The compressed HyAB distance of green and blue, the colours that are farthest apart.
double largest_colour_error() { return power<float>(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), colour_exponent); }

/// Maps to [0, 1]: the lower 0.4 of the range becomes 0.95 of it.
double compressed(double error, double largest) {
    constexpr double knee = 0.4, height = 0.95;
    const double at = knee * largest;
    return error < at ? height / at * error : height + (error - at) / (largest - at) * (1 - height);
}

/// A term of the eye's point spread function: amplitude * sqrt(pi / width) * exp(-(pi x)^2 / width), x in degrees.
struct Spread {
    double amplitude;
    double width;
};

constexpr double widest_spread = 0.04;
constexpr std::array lightness_spread = {Spread{1, 0.0047}};
constexpr std::array red_green_spread = {Spread{1, 0.0053}};
constexpr std::array blue_yellow_spread = {Spread{34.1, widest_spread}, Spread{13.5, 0.025}};

/// A sum of separable Gaussians whose weights sum to 1.
Plane blurred(const Plane& plane, std::span<const Spread> spreads, double pixels_per_degree) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest_spread / (2 * pi * pi)) * pixels_per_degree));
    Plane result{plane.width, plane.height, std::vector<double>(plane.values.size())};
    double total = 0;
    for (const Spread& spread : spreads) {
        const AxisWeights weights = axis_weights(radius, [&](double pixels) {
            const double degrees = pixels / pixels_per_degree;
            return exp_wide<float>(-pi * pi * degrees * degrees / spread.width);
        });
        double along = 0;
        for (const double weight : weights) along += weight;
        const double share = spread.amplitude * std::sqrt(pi / spread.width) * along * along;
        const AxisWeights unit = normalised(weights);
        const Plane part = filtered(plane, unit, unit);
        for (std::size_t i = 0; i < part.values.size(); ++i) result.values[i] += share * part.values[i];
        total += share;
    }
    for (double& value : result.values) value /= total;
    return result;
}

Seen::Features features_of(const Plane& luminance, double pixels_per_degree) {
    constexpr double width_of_edge = 0.082;  // degrees
    const double deviation = 0.5 * width_of_edge * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gauss = [&](double x) { return exp_wide<float>(-x * x / (2 * deviation * deviation)); };
    const AxisWeights blur = normalised(axis_weights(radius, gauss));
    const auto magnitude = [&](const AxisWeights& across) {
        Plane result = filtered(luminance, across, blur);
        const Plane down = filtered(luminance, blur, across);
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            result.values[i] = length(result.values[i], down.values[i]);
        }
        return result;
    };
    const AxisWeights first = axis_weights(radius, [&](double x) { return -x * gauss(x); });
    const AxisWeights second =
        axis_weights(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); });
    return {magnitude(normalised(first)), magnitude(normalised(second))};
}

Seen seen(const FloatImage& image, const FlipOptions& options) {
    const double pixels_per_degree = options.pixels_per_degree;
    const double factor = exposure_factor(options.display);
    // the light from a screen that interprets the values of the file as sRGB
    const auto light = [&](float linear) {
        const double value = widen(clamp_to_unit(narrow(widen(linear) * factor)));
        return options.display.transfer == TransferFunction::srgb ? value : linear_of_srgb(value);
    };
    const auto plane = [&] { return Plane{image.width, image.height, std::vector<double>(image.pixels.size())}; };
    // lightness, red-green, blue-yellow (YCxCz), without the offset of Y, which a blur preserves
    Plane luminance = plane(), red_green = plane(), blue_yellow = plane();
    for_each(image.pixels.size(), [&](std::size_t i) {
        const Vec3f& p = image.pixels[i];
        const Vec3d xyz = relative_xyz({light(p.x), light(p.y), light(p.z)});
        luminance.values[i] = xyz.y;
        red_green.values[i] = xyz.x - xyz.y;
        blue_yellow.values[i] = xyz.y - xyz.z;
    });
    Seen result{{}, features_of(luminance, pixels_per_degree)};
    luminance = blurred(luminance, lightness_spread, pixels_per_degree);
    red_green = blurred(red_green, red_green_spread, pixels_per_degree);
    blue_yellow = blurred(blue_yellow, blue_yellow_spread, pixels_per_degree);
    result.lab.resize(image.pixels.size());
    for_each(image.pixels.size(), [&](std::size_t i) {
        const double y = luminance.values[i];
        const Vec3d rgb = rgb_of({y + red_green.values[i], y, y - blue_yellow.values[i]});
        const auto unit = [](double value) { return std::clamp(value, 0.0, 1.0); };
        result.lab[i] = hunt_lab({unit(rgb.x), unit(rgb.y), unit(rgb.z)});
    });
    return result;
}

FlipDifference difference_of(const Seen& p, const Seen& q, const FloatImage& size) {
    const double largest = largest_colour_error();
    FlipDifference result{size.width, size.height, std::vector<double>(p.lab.size()), 0};
    for_each(p.lab.size(), [&](std::size_t i) {
        const double colour = compressed(power<float>(hyab(p.lab[i], q.lab[i]), colour_exponent), largest);
        const double edges = std::abs(p.features.edges.values[i] - q.features.edges.values[i]);
        const double points = std::abs(p.features.points.values[i] - q.features.points.values[i]);
        const double feature = power<float>(std::max(edges, points) / std::numbers::sqrt2, feature_exponent);
        result.errors[i] = std::clamp(power<float>(colour, 1 - std::min(feature, 1.0)), 0.0, 1.0);
        result.mean += result.errors[i];
    });
    result.mean /= static_cast<double>(result.errors.size());
    return result;
}

}  // namespace

FlipReference::FlipReference(const FloatImage& image, const FlipOptions& options)
    : options_(options), width_(image.width), height_(image.height) {
    if (image.pixels.empty()) throw InputError("FLIP needs two images, but one has no pixels");
    if (!(options.pixels_per_degree > 0 && options.pixels_per_degree <= 1000)) {
        throw InputError(fmt::format("FLIP needs more than 0 and at most 1000 pixels per degree, not {}",
                                     options.pixels_per_degree));
    }
    const DefaultFpEnvironment guard;
    seen_ = std::make_shared<const Seen>(seen(image, options));
}

FlipDifference FlipReference::difference(const FloatImage& image) const {
    if (image.width != width_ || image.height != height_) {
        throw InputError(fmt::format("FLIP needs two images of equal size, but they have {} x {} and {} x {} pixels",
                                     width_, height_, image.width, image.height));
    }
    const DefaultFpEnvironment guard;
    return difference_of(*seen_, seen(image, options_), image);
}

FlipDifference flip(const FloatImage& a, const FloatImage& b, const FlipOptions& options) {
    return FlipReference(a, options).difference(b);
}

FloatImage flip_map(const FlipDifference& difference) {
    const DefaultFpEnvironment guard;
    // matplotlib's magma, interpolated linearly between its quarters
    static const std::array<Vec3d, 5> quarters = {Vec3d{0, 0, 0.02}, Vec3d{0.32, 0.07, 0.48}, Vec3d{0.72, 0.21, 0.47},
                                                  Vec3d{0.99, 0.54, 0.38}, Vec3d{0.99, 0.99, 0.75}};
    FloatImage map{difference.width, difference.height, {}};
    map.pixels.reserve(difference.errors.size());
    for (const double error : difference.errors) {
        const auto below = std::min(static_cast<std::size_t>(4 * error), std::size_t{3});
        const double share = 4 * error - static_cast<double>(below);
        map.pixels.push_back(narrow(quarters[below] * (1 - share) + quarters[below + 1] * share));
    }
    return map;
}

}  // namespace tandem

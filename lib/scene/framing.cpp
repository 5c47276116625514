#include "tandem/scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string_view>

#include "tandem/math/turns.h"
#include "tandem/scene/surface_reach.h"

namespace tandem {

namespace {

constexpr double vertical_angle = 40 * pi / 180;
/// Of half the height, or width, of the film: what the scene fills.
constexpr double fill = 0.9;

/// Degrees. The azimuth turns from the front (+z) to the right (+x).
struct View {
    std::string_view name;
    std::string_view words;
    int azimuth = 0;
    std::optional<int> elevation{};  ///< empty: by how flat the scene is
};

constexpr std::string_view automatic = "auto";

const View views[] = {
    {automatic, "from the front"},         {"front", "from the front"},
    {"back", "from the back", 180},        {"left", "from the left", -90},
    {"right", "from the right", 90},       {"top", "from the top", 0, 90},
    {"bottom", "from the bottom", 0, -90}, {"three-quarter", "between the front and the right", 35, 25}};

const View* find_view(const std::string& name) {
    const View* found = std::find_if(std::begin(views), std::end(views), [&](const View& v) { return v.name == name; });
    return found == std::end(views) ? nullptr : found;
}

/// From 0 below `lower` to 1 above `upper`.
double ramp(double x, double lower, double upper) { return std::clamp((x - lower) / (upper - lower), 0.0, 1.0); }

int rounded(double degrees) { return static_cast<int>(std::lround(degrees)); }

/// The flatter the scene, the higher the camera: in degrees.
int elevation_for(const Vec3d& size) {
    const double across = std::sqrt(size.x) * std::sqrt(size.z);
    const double flatness = across > 0 ? size.y / across : 1;
    return rounded(50 - 30 * ramp(flatness, 0.05, 0.4));
}

/// A deep and narrow scene shows little from the front: in degrees.
int azimuth_for(const Vec3d& size) { return rounded(40 * ramp(size.z, 2 * size.x, 5 * size.x)); }

/// Axes of a camera in world space, as camera_axes() has them.
Matrix3 axes_at(int azimuth, int elevation) {
    const auto [sin_a, cos_a] = sin_cos_turns<float>(azimuth / 360.0);
    const auto [sin_e, cos_e] = sin_cos_turns<float>(elevation / 360.0);
    const Vec3d backward = {sin_a * cos_e, sin_e, cos_a * cos_e};
    const Vec3d right = {cos_a, 0, -sin_a};
    return {{right, cross(backward, right), backward}};
}

/// Seen from where a scene just fits between two planes through the camera.
struct Fit {
    double centre;    ///< of the camera, along the axis across the planes
    double distance;  ///< of the camera, along the backward axis
};

/// The tightest pair of planes that lean `slope` to either side of the backward axis. All is relative to `middle`.
Fit fit(const SurfaceReach& reach, const Vec3d& middle, const Vec3d& across, const Vec3d& backward, double slope) {
    const auto along = [&](const Vec3d& direction) { return reach.along(direction) - dot(direction, middle); };
    const double upper = along(across + backward * slope);
    const double lower = along(backward * slope - across);
    return {(upper - lower) / 2, (upper + lower) / (2 * slope)};
}

/// Where the camera is along `across` if it is `distance` away: a scene that does not fill the film in this direction
/// stands in its middle. Finds the slope at which it would fill it.
double centre_at(const SurfaceReach& reach, const Vec3d& middle, const Vec3d& across, const Vec3d& backward,
                 double slope, double distance) {
    Fit tight = fit(reach, middle, across, backward, slope);
    for (int i = 0; i < 8 && tight.distance > 0 && tight.distance < 0.99 * distance; ++i) {
        slope *= tight.distance / distance;
        tight = fit(reach, middle, across, backward, slope);
    }
    return tight.centre;
}

/// The scene at the first moment at which it shows something.
SurfaceReach reach_of(const Scene& scene) {
    const std::int32_t last = frame_count(scene) - 1;
    for (const std::int32_t frame : {0, last / 2}) {
        SurfaceReach reach(scene, time_of_frame(scene, frame));
        if (!reach.is_empty()) return reach;
    }
    return {scene, time_of_frame(scene, last)};
}

/// Stands in for what cannot be framed.
const Scene& cube() {
    static const Scene scene = [] {
        Scene result;
        result.nodes.resize(1);
        result.nodes[0].geometry = {{BoxShape{}, 0}};
        return result;
    }();
    return scene;
}

struct Bounds {
    Vec3d lower, upper;
};

Bounds bounds_of(const SurfaceReach& reach) {
    return {-Vec3d{reach.along({-1, 0, 0}), reach.along({0, -1, 0}), reach.along({0, 0, -1})},
            {reach.along({1, 0, 0}), reach.along({0, 1, 0}), reach.along({0, 0, 1})}};
}

/// Far enough from the limit of coordinates that the camera keeps it too.
bool can_be_framed(const Bounds& bounds) {
    constexpr double most = 1e17;
    for (int i = 0; i < 3; ++i) {
        if (!(bounds.lower[i] >= -most && bounds.upper[i] <= most)) return false;
    }
    return true;
}

Vec3d place_camera(const SurfaceReach& reach, const Bounds& bounds, const Matrix3& axes, double aspect) {
    const auto& [right, up, backward] = axes.row;
    const Vec3d middle = bounds.lower + (bounds.upper - bounds.lower) * 0.5;
    const double slope_up = fill * std::tan(vertical_angle / 2);
    const double slope_right = slope_up * aspect;
    const Vec3d size = bounds.upper - bounds.lower;
    // a line that is seen end-on fits into every picture, and so does a point: the camera keeps off them
    const double gap = norm1(size) > 0 ? 0.05 * norm1(size) : std::max(1.0, 1e-3 * norm1(middle));
    const double closest = reach.along(backward) - dot(backward, middle) + gap;
    const double distance = std::max({closest, fit(reach, middle, right, backward, slope_right).distance,
                                      fit(reach, middle, up, backward, slope_up).distance});
    return middle + right * centre_at(reach, middle, right, backward, slope_right, distance) +
           up * centre_at(reach, middle, up, backward, slope_up, distance) + backward * distance;
}

}  // namespace

std::string view_names() {
    std::string names;
    for (const View& view : views) names += (names.empty() ? "" : ", ") + std::string(view.name);
    return names;
}

bool is_view(const std::string& name) { return find_view(name) != nullptr; }

Framing frame_scene(const Scene& scene, const std::string& name, double aspect) {
    const View* view = find_view(name);
    assert(view != nullptr);
    const SurfaceReach found = reach_of(scene);
    const bool has_bounds = !found.is_empty() && can_be_framed(bounds_of(found));
    const SurfaceReach reach = has_bounds ? found : SurfaceReach(cube(), 0);
    const Bounds bounds = bounds_of(reach);
    const Vec3d size = bounds.upper - bounds.lower;
    const int azimuth = view->azimuth + (view->name == automatic ? azimuth_for(size) : 0);
    const int elevation = view->elevation.value_or(elevation_for(size));
    const Matrix3 axes = axes_at(azimuth, elevation);
    Framing framing;
    framing.node.name = name;
    framing.node.matrix = {transpose(axes), place_camera(reach, bounds, axes, aspect)};
    framing.node.camera = PerspectiveCamera{vertical_angle};
    framing.description = view->words;
    if (azimuth != view->azimuth) framing.description += fmt::format(", turned {} degrees to the right", azimuth);
    if (std::abs(elevation) < 90) framing.description += fmt::format(", {} degrees above", elevation);
    framing.is_empty = found.is_empty();
    return framing;
}

}  // namespace tandem

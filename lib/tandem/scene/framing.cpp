#include "tandem/scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "tandem/base/error.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/turns.h"
#include "tandem/scene/surface_reach.h"

namespace tandem {

namespace {

constexpr double vertical_angle = 40 * pi / 180;
/// The fraction of the film's height, or width, that the scene fills.
constexpr double fill = 0.9;

/// Degrees. The azimuth turns from the front (+z) to the right (+x).
struct View {
    std::string_view name;
    std::string_view words;
    int azimuth = 0;
    std::optional<int> elevation{};  ///< empty: depends on how flat the scene is
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

/// Rises from 0 at `lower` to 1 at `upper`.
double ramp(double x, double lower, double upper) { return std::clamp((x - lower) / (upper - lower), 0.0, 1.0); }

int rounded(double degrees) { return static_cast<int>(std::lround(degrees)); }

/// The elevation of the camera, higher for flatter scenes: in degrees.
int elevation_for(const Vec3d& size) {
    const double across = std::sqrt(size.x) * std::sqrt(size.z);
    const double flatness = across > 0 ? size.y / across : 1;
    return rounded(50 - 30 * ramp(flatness, 0.05, 0.4));
}

/// The azimuth for a deep and narrow scene, whose front shows little of it: in degrees.
int azimuth_for(const Vec3d& size) { return rounded(40 * ramp(size.z, 2 * size.x, 5 * size.x)); }

/// The axes of a camera in world space, as from camera_axes().
Matrix3 axes_at(int azimuth, int elevation) {
    const auto [sin_a, cos_a] = sin_cos_turns<float>(azimuth / 360.0);
    const auto [sin_e, cos_e] = sin_cos_turns<float>(elevation / 360.0);
    const Vec3d backward = {sin_a * cos_e, sin_e, cos_a * cos_e};
    const Vec3d right = {cos_a, 0, -sin_a};
    return {{right, cross(backward, right), backward}};
}

/// A scene between two planes through a camera that lean `slope` to either side of its backward axis, and touch it.
struct Fit {
    double slope;
    double centre;    ///< of the camera, along the axis across the planes
    double distance;  ///< of the camera, along the backward axis
};

/// A scene as a camera sees it that looks along an axis. Positions are relative to `middle`.
class Sight {
  public:
    Sight(const SurfaceReach& reach, const Vec3d& middle, const Vec3d& backward)
        : reach_(reach), middle_(middle), backward_(backward) {}

    /// The position of the nearest point to the camera, along the backward axis.
    [[nodiscard]] double front() const { return along({backward_})[0]; }

    [[nodiscard]] Fit fit(const Vec3d& across, double slope) const {
        const std::vector<double> most = along({across + backward_ * slope, backward_ * slope - across});
        return {slope, (most[0] - most[1]) / 2, (most[0] + most[1]) / (2 * slope)};
    }

    /// The camera's position along `across` if it is farther away than `tight` requires: centres an object that does
    /// not fill the film, by finding the slope at which it would.
    [[nodiscard]] double centre(const Vec3d& across, Fit tight, double distance) const {
        for (int i = 0; i < 8 && tight.distance > 0 && tight.distance < 0.99 * distance; ++i) {
            tight = fit(across, tight.slope * tight.distance / distance);
        }
        return tight.centre;
    }

  private:
    [[nodiscard]] std::vector<double> along(const std::vector<Vec3d>& directions) const {
        std::vector<double> most = reach_.along(directions);
        for (std::size_t i = 0; i < most.size(); ++i) most[i] -= dot(directions[i], middle_);
        return most;
    }

    const SurfaceReach& reach_;
    Vec3d middle_, backward_;
};

/// The scene at the first time at which it has visible surfaces.
SurfaceReach reach_of(const Scene& scene) {
    const std::int32_t last = frame_count(scene) - 1;
    for (const std::int32_t frame : {0, last / 2}) {
        SurfaceReach reach(scene, time_of_frame(scene, frame));
        if (!reach.is_empty()) return reach;
    }
    return {scene, time_of_frame(scene, last)};
}

struct Bounds {
    Vec3d lower, upper;
};

Bounds bounds_of(const SurfaceReach& reach) {
    const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    const std::vector<double> most = reach.along(axes);
    return {-Vec3d{most[3], most[4], most[5]}, {most[0], most[1], most[2]}};
}

/// Whether the scene is so far within the limit of coordinates that the camera is within it too.
bool can_be_framed(const Bounds& bounds) {
    constexpr double most = 1e17;
    for (int i = 0; i < 3; ++i) {
        if (!(bounds.lower[i] >= -most && bounds.upper[i] <= most)) return false;
    }
    return true;
}

Vec3d place_camera(const SurfaceReach& reach, const Bounds& bounds, const Matrix3& axes, double aspect) {
    const auto& [right, up, backward] = axes.row;
    const Vec3d size = bounds.upper - bounds.lower;
    const Vec3d middle = bounds.lower + size * 0.5;
    const Sight sight(reach, middle, backward);
    const double slope = fill * accurate_tan(vertical_angle / 2);
    const Fit width = sight.fit(right, slope * aspect);
    const Fit height = sight.fit(up, slope);
    // a line seen end-on fits into any film, and so does a point: the camera keeps a distance
    const double gap = norm1(size) > 0 ? 0.05 * norm1(size) : std::max(1.0, 1e-3 * norm1(middle));
    const double distance = std::max({sight.front() + gap, width.distance, height.distance});
    return middle + right * sight.centre(right, width, distance) + up * sight.centre(up, height, distance) +
           backward * distance;
}

/// Used if the scene cannot be framed.
Scene cube() {
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].geometry = {{BoxShape{}, 0}};
    return scene;
}

}  // namespace

std::string view_names() {
    std::string names;
    for (const View& view : views) names += (names.empty() ? "" : ", ") + std::string(view.name);
    return names;
}

bool is_view(const std::string& name) { return find_view(name) != nullptr; }

Framing frame_scene(const Scene& scene, const std::string& name, double aspect) {
    const DefaultFpEnvironment guard;
    const View* view = find_view(name);
    if (view == nullptr) throw InputError(fmt::format("there is no view '{}'; the views are {}", name, view_names()));
    if (!(aspect > 0 && std::isfinite(aspect))) {
        throw InputError(fmt::format("a film whose width is {} times its height cannot be framed", aspect));
    }
    Framing framing;
    SurfaceReach reach = reach_of(scene);
    framing.is_empty = reach.is_empty();
    const Scene stand_in = cube();
    if (reach.is_empty() || !can_be_framed(bounds_of(reach))) reach = SurfaceReach(stand_in, 0);
    const Bounds bounds = bounds_of(reach);
    const Vec3d size = bounds.upper - bounds.lower;
    const int azimuth = view->azimuth + (view->name == automatic ? azimuth_for(size) : 0);
    const int elevation = view->elevation.value_or(elevation_for(size));
    const Matrix3 axes = axes_at(azimuth, elevation);
    framing.node.name = name;
    framing.node.matrix = {transpose(axes), place_camera(reach, bounds, axes, aspect)};
    framing.node.camera = PerspectiveCamera{vertical_angle};
    framing.description = view->words;
    if (azimuth != view->azimuth) framing.description += fmt::format(", turned {} degrees to the right", azimuth);
    if (std::abs(elevation) < 90) framing.description += fmt::format(", {} degrees above", elevation);
    return framing;
}

}  // namespace tandem

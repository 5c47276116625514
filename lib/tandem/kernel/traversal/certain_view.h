/// A scene of a few spheres and boxes under point lights, as a pinhole camera sees it: what certain_hit() and
/// certain_light() need, in the parameters of the kernel. The host makes it for each job.
///
/// Needs: a perspective camera without a lens; spheres and boxes that do not contain it and are not near it; whole
///        shininesses; magnitudes far from the limits of float. Otherwise the view is not valid, and the kernel
///        computes every sample by the general code.
#pragma once

#include "tandem/kernel/shapes/box.h"
#include "tandem/kernel/shapes/sphere.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

// All lengths in metres, from the origin of the camera's rays.

struct CertainSphere {
    Vec3d offset;  ///< origin - centre, exact
    double c;      ///< |offset|^2 - radius^2
    double radius, inverse_radius;
    double distance2_per_radius;  ///< |offset|^2 / radius
    // for the test in float, u = 2^-24
    Vec3f rough_offset;
    float rough_c, rough_inverse_radius;
    float margin;  ///< 24 u |offset|^2
    float slack;   ///< 16 u |offset| times the length of the longest direction
};

struct CertainBox {
    Vec3d lower, upper;  ///< the faces - origin
    Vec3f rough_lower, rough_upper;
};

struct CertainMaterial {
    Vec3f ambient;  ///< times the ambient light
    Vec3f diffuse, specular;
    std::uint32_t shininess;
    std::uint32_t odd_part, squarings;  ///< shininess = odd_part * 2^squarings
    double small_slope;                 ///< of c^shininess for c <= 0.26, at most
};

struct CertainLight {
    Vec3d offset;  ///< light - origin
    Vec3f rough_offset;
    Vec3f intensity;
};

struct CertainView {
    static constexpr std::uint32_t max_spheres = 8, max_boxes = 4, max_lights = 4;
    static constexpr std::uint32_t max_shininess = 1024;
    /// The first slots, for which there is code that tests no others.
    static constexpr std::uint32_t few_spheres = 4, few_boxes = 1;
    static constexpr std::uint32_t few_slots = ((1U << few_spheres) - 1) | ((1U << few_boxes) - 1) << max_spheres;

    CertainSphere spheres[max_spheres];
    CertainBox boxes[max_boxes];
    CertainMaterial materials[max_spheres + max_boxes];  ///< of the spheres; of the boxes, from max_spheres on
    CertainLight lights[max_lights];
    double extent;  ///< bounds the coordinates of the origin, the lights and the solids, summed
    std::uint32_t sphere_count, box_count, light_count;
    std::uint32_t slots;          ///< those of the solids, as bits
    std::uint32_t is_valid;       ///< 0 or 1
    std::uint32_t is_finite_sky;  ///< 1: the background of camera rays is finite, with any camera of moderate size
};

/// The data of a scene that the host keeps to make its views.
struct CertainScene {
    Sphere spheres[CertainView::max_spheres];
    Box boxes[CertainView::max_boxes];
    PhongMaterial materials[CertainView::max_spheres + CertainView::max_boxes];  ///< in the slots of the view
    PunctualLight lights[CertainView::max_lights];
    Environment environment;
    std::uint32_t sphere_count, box_count, light_count;
    bool fits;  ///< the scene has no more
};

/// `scene`: in host memory, with no primitives but spheres and boxes.
[[nodiscard]] inline CertainScene make_certain_scene(const SceneView& scene) {
    CertainScene kept{};
    kept.environment = scene.environment;
    kept.fits = scene.sphere_count <= CertainView::max_spheres && scene.box_count <= CertainView::max_boxes &&
                scene.light_count <= CertainView::max_lights;
    if (!kept.fits) return kept;
    const auto material_of = [&](std::uint32_t primitive) { return scene.materials[scene.material_of[primitive]]; };
    for (std::uint32_t i = 0; i < scene.sphere_count; ++i) {
        kept.spheres[i] = scene.spheres[i];
        kept.materials[i] = material_of(i);
    }
    for (std::uint32_t i = 0; i < scene.box_count; ++i) {
        kept.boxes[i] = scene.boxes[i];
        kept.materials[CertainView::max_spheres + i] = material_of(scene.sphere_count + i);
    }
    for (std::uint32_t i = 0; i < scene.light_count; ++i) kept.lights[i] = scene.lights[i];
    kept.sphere_count = scene.sphere_count;
    kept.box_count = scene.box_count;
    kept.light_count = scene.light_count;
    return kept;
}

/// A window of the film, in pixels: the half-open ranges of x and y.
struct PixelRange {
    std::uint32_t left, right, top, bottom;
};

namespace certain_detail {

inline constexpr double smallest = 0x1p-20, largest = 0x1p20;
inline bool is_moderate(double length) { return length >= smallest && length <= largest; }
inline double length_of(const Vec3d& a) { return square_root(dot(a, a)); }

/// Not negative, not -0, and so small that sums of products stay finite.
inline bool is_plain_colour(const Vec3f& colour) {
    const auto plain = [](float a) { return bits_of(a) <= bits_of(1e6F); };
    return plain(colour.x) && plain(colour.y) && plain(colour.z);
}

/// a - b, and whether it is exact.
inline bool exact_difference(const Vec3d& a, const Vec3d& b, Vec3d& difference) {
    difference = a - b;
    return two_sum(a.x, -b.x).low == 0 && two_sum(a.y, -b.y).low == 0 && two_sum(a.z, -b.z).low == 0;
}

/// Whether 2^-24 of each component is exact, and its products with whole numbers are.
inline bool can_be_scaled(const Vec3d& step) {
    const auto can = [](double a) { return a == 0 || absolute(a) >= 0x1p-100; };
    const Vec3d rounded = widen(narrow(step));
    return can(rounded.x) && can(rounded.y) && can(rounded.z);
}

/// The lengths of camera rays' directions, at least and at most: the depth along the view axis is the same for all.
struct DirectionLengths {
    double least, most;
};
inline DirectionLengths direction_lengths(const CameraView& camera, const PixelRange& pixels) {
    const Vec3d axis = cross(camera.direction_dx, camera.direction_dy);
    DirectionLengths lengths = {absolute(dot(camera.direction, axis)) / length_of(axis), 0};
    for (const std::uint32_t x : {pixels.left, pixels.right}) {
        for (const std::uint32_t y : {pixels.top, pixels.bottom}) {
            const Vec3d corner = camera.direction + camera.direction_dx * static_cast<double>(x) +
                                 camera.direction_dy * static_cast<double>(y);
            lengths.most = greater(lengths.most, length_of(corner));
        }
    }
    return {lengths.least * 0.999, lengths.most * 1.001};
}

inline bool make(const Sphere& sphere, const Vec3d& origin, double longest, CertainSphere& result) {
    const bool exact = exact_difference(origin, widen(sphere.centre), result.offset);
    const double radius = widen(sphere.radius), distance = length_of(result.offset);
    const Pair<double> distance2 = [&] {
        const auto square = [](double a) { return two_product(a, a); };
        return square(result.offset.x) + square(result.offset.y) + square(result.offset.z);
    }();
    const Pair<double> c = distance2 - two_product(radius, radius);
    result.c = c.high;
    result.radius = radius;
    result.inverse_radius = 1 / radius;
    result.distance2_per_radius = distance2.high / radius;
    result.rough_offset = narrow(result.offset);
    result.rough_c = narrow(result.c);
    result.rough_inverse_radius = narrow(result.inverse_radius);
    result.margin = narrow(24 * 0x1p-24 * 1.001 * distance2.high);
    result.slack = narrow(16 * 0x1p-24 * 1.001 * distance * longest);
    return exact && is_moderate(radius) && is_moderate(distance) && result.c >= 0.25 * distance2.high;
}

inline bool make(const Box& box, const Vec3d& origin, CertainBox& result) {
    result.lower = widen(box.lower) - origin;
    result.upper = widen(box.upper) - origin;
    result.rough_lower = narrow(result.lower);
    result.rough_upper = narrow(result.upper);
    bool moderate = true;
    for (int axis = 0; axis < 3; ++axis) {
        moderate = moderate && is_moderate(absolute(result.lower[axis])) && is_moderate(absolute(result.upper[axis]));
    }
    return moderate;
}

inline bool make(const PhongMaterial& material, const Vec3f& ambient_light, CertainMaterial& result) {
    result.ambient = material.ambient * ambient_light;
    result.diffuse = material.diffuse;
    result.specular = material.specular;
    const bool whole = material.shininess >= 1 && material.shininess <= CertainView::max_shininess &&
                       material.shininess == static_cast<float>(static_cast<std::uint32_t>(material.shininess));
    result.shininess = whole ? static_cast<std::uint32_t>(material.shininess) : 1;
    result.odd_part = result.shininess;
    for (; result.odd_part % 2 == 0; result.odd_part /= 2) ++result.squarings;
    result.small_slope = result.shininess;
    for (std::uint32_t i = 1; i < result.shininess; ++i) result.small_slope *= 0.26;
    return whole && is_plain_colour(result.ambient) && is_plain_colour(result.diffuse) &&
           is_plain_colour(result.specular);
}

}  // namespace certain_detail

[[nodiscard]] inline CertainView make_certain_view(const CertainScene& scene, const CameraView& camera,
                                                   const PixelRange& pixels) {
    using namespace certain_detail;
    CertainView view{};
    if (camera.orthographic || camera.has_lens) return view;
    const DirectionLengths lengths = direction_lengths(camera, pixels);
    if (!(lengths.least >= smallest && lengths.most <= largest)) return view;
    if (!can_be_scaled(camera.direction_dx) || !can_be_scaled(camera.direction_dy)) return view;
    const Environment& sky = scene.environment;
    view.is_finite_sky = is_plain_colour(sky.bottom) && is_plain_colour(sky.top) ? 1 : 0;
    if (view.is_finite_sky == 0 || !scene.fits) return view;

    const Vec3d origin = widen(narrow(camera.origin));
    double extent = norm1(origin);
    double farthest = 0;
    bool valid = true;
    const auto add_material = [&](std::uint32_t slot) {
        valid = make(scene.materials[slot], sky.ambient, view.materials[slot]) && valid;
    };
    for (std::uint32_t i = 0; i < scene.sphere_count; ++i) {
        valid = make(scene.spheres[i], origin, lengths.most, view.spheres[i]) && valid;
        add_material(i);
        farthest = greater(farthest, norm1(view.spheres[i].offset) + 2 * view.spheres[i].radius);
    }
    for (std::uint32_t i = 0; i < scene.box_count; ++i) {
        valid = make(scene.boxes[i], origin, view.boxes[i]) && valid;
        add_material(CertainView::max_spheres + i);
        farthest = greater(farthest, norm1(view.boxes[i].lower) + norm1(view.boxes[i].upper));
    }
    extent += farthest;
    farthest = 0;
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const PunctualLight& light = scene.lights[i];
        const Vec3d offset = widen(light.position) - origin;
        view.lights[i] = {offset, narrow(offset), light.intensity};
        valid = valid && is_plain_colour(light.intensity);
        farthest = greater(farthest, norm1(widen(light.position)));
    }
    view.sphere_count = scene.sphere_count;
    view.box_count = scene.box_count;
    view.light_count = scene.light_count;
    view.slots = ((1U << scene.sphere_count) - 1) | ((1U << scene.box_count) - 1) << CertainView::max_spheres;
    view.extent = 1.001 * (extent + farthest);
    view.is_valid = valid && view.extent <= largest ? 1 : 0;
    return view;
}

}  // namespace tandem

#include "tandem/scene/default_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tandem/images/levels.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/frame.h"
#include "tandem/math/lengths.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/surface_reach.h"

namespace tandem {

namespace {

/// A scene whose surfaces have a higher mean radiance counts as lit by them.
constexpr double enough_emission = 0.2;

const Environment sky = {{0.11F, 0.115F, 0.13F}, {0.30F, 0.335F, 0.39F}, {1, 1, 1}, 1};
constexpr float key_intensity = 0.52F;
constexpr float fill_intensity = 0.1F;
/// The direction to the key light, along the camera's right, up and backward axes.
constexpr Vec3d to_key = {-0.5, 0.75, 0.9};

/// Square metres, in world space. For an ellipsoid, the area of the sphere with its volume.
double area_of(const Scene& scene, const Shape& shape, const Matrix3& m) {
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        const double radius = sphere->radius * accurate_cbrt(std::abs(determinant(m)));
        return 4 * std::numbers::pi * radius * radius;
    }
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        const Matrix3 axes = transpose(m);
        const Vec3d edge[3] = {axes.row[0] * box->size.x, axes.row[1] * box->size.y, axes.row[2] * box->size.z};
        return 2 *
               (length(cross(edge[0], edge[1])) + length(cross(edge[1], edge[2])) + length(cross(edge[2], edge[0])));
    }
    const Mesh& mesh = scene.meshes[std::get<MeshShape>(shape).mesh];
    double area = 0;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3d start = widen(mesh.positions[a]);
        area += length(cross(m * (widen(mesh.positions[b]) - start), m * (widen(mesh.positions[c]) - start))) / 2;
    };
    const auto& t = mesh.triangles;
    for (std::size_t i = 0; i < t.size(); i += 3) add(t[i], t[i + 1], t[i + 2]);
    const auto& q = mesh.quads;
    for (std::size_t i = 0; i < q.size(); i += 4) {
        add(q[i], q[i + 1], q[i + 2]);
        add(q[i], q[i + 2], q[i + 3]);
    }
    return area;
}

/// The mean of red, green and blue over an image, linear.
double mean_level(const Image& image) {
    const std::vector<float> levels = texture_levels();
    double sum = 0;
    for (const std::uint32_t texel : image.texels) {
        for (const int shift : {0, 8, 16}) sum += double{levels[texel >> shift & 255U]};
    }
    return sum / (3.0 * static_cast<double>(image.texels.size()));
}

/// The mean radiance of the surface of each material. Each image is read only once, however many materials use it.
std::vector<double> radiance_of_materials(const Scene& scene) {
    std::vector<double> level(scene.images.size(), -1);
    std::vector<double> radiance;
    for (const Material& material : scene.materials) {
        double mean = material.unlit ? 0 : norm1(widen(material.optics.emission)) / 3;
        if (mean != 0 && material.emissive_texture) {
            const std::size_t image = scene.textures[material.emissive_texture->texture].image;
            if (level[image] < 0) level[image] = mean_level(scene.images[image]);
            mean *= level[image];
        }
        radiance.push_back(mean);
    }
    return radiance;
}

/// The mean radiance over all surfaces.
double mean_emission(const Scene& scene) {
    const std::vector<double> radiance = radiance_of_materials(scene);
    if (std::none_of(radiance.begin(), radiance.end(), [](double r) { return r > 0; })) return 0;
    double total = 0, area = 0;
    const auto add = [&](const Geometry& geometry, const Transform& world_from_shape) {
        const double part = area_of(scene, geometry.shape, world_from_shape.linear);
        area += part;
        total += part * radiance[geometry.material];
    };
    for_each_shape(scene, world_from_nodes(scene, time_of_frame(scene, 0)), add);
    return area > 0 ? total / area : 0;
}

/// Whether there is a surface that reflects light.
bool needs_light(const Scene& scene) {
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
        return std::any_of(node.geometry.begin(), node.geometry.end(),
                           [&](const Geometry& geometry) { return !scene.materials[geometry.material].unlit; });
    });
}

}  // namespace

bool has_light(const Scene& scene) {
    const auto shines = [](const Node& node) { return node.light && is_lit(*node.light); };
    return !needs_light(scene) || std::any_of(scene.nodes.begin(), scene.nodes.end(), shines) ||
           mean_emission(scene) > enough_emission;
}

void add_default_light(Scene& scene, std::size_t camera) {
    const DefaultFpEnvironment guard;
    scene.environment = sky;
    const Transform world_from_camera = world_from_nodes(scene, time_of_frame(scene, 0))[camera];
    const Matrix3 axes = camera_axes(world_from_camera).value_or(Matrix3{});
    const auto add = [&](const char* name, const Vec3d& to_light, float intensity, bool casts_shadows) {
        const Frame<double> frame = frame_around(normalize(transpose(axes) * to_light));
        Node node;
        node.name = name;
        node.matrix = {transpose({{frame.tangent, frame.bitangent, frame.normal}}), {0, 0, 0}};
        node.light =
            LightSource{.kind = LightKind::directional, .intensity = intensity, .casts_shadows = casts_shadows};
        scene.nodes.push_back(std::move(node));
    };
    add("key light", to_key, key_intensity, true);
    add("fill light", {0, 0, 1}, fill_intensity, false);
}

}  // namespace tandem

#include "tandem/compile/media.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/shapes/triangle.h"
#include "tandem/math/lengths.h"

namespace tandem {

namespace {

bool touch(const Aabb& a, const Aabb& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

bool may_touch(const SceneView& scene, std::uint32_t a, std::uint32_t b) {
    if (!touch(primitive_bounds(scene, a), primitive_bounds(scene, b))) return false;
    if (a >= scene.sphere_count || b >= scene.sphere_count) return true;
    const Sphere &s = scene.spheres[a], &t = scene.spheres[b];
    const Vec3d between = widen(s.centre) - widen(t.centre);
    const double reach = double{s.radius} + double{t.radius};
    return dot(between, between) <= reach * reach * (1 + 1e-6);
}

bool holds(const Sphere& sphere, const Vec3d& point) {
    const Vec3d offset = point - widen(sphere.centre);
    return dot(offset, offset) < double{sphere.radius} * double{sphere.radius};
}
bool holds(const Box& box, const Vec3d& point) {
    const Vec3d lower = widen(box.lower), upper = widen(box.upper);
    return lower.x < point.x && point.x < upper.x && lower.y < point.y && point.y < upper.y && lower.z < point.z &&
           point.z < upper.z;
}
Vec3d in_object(const Placement& body, const Vec3d& point) { return body.object_from_world * (point - body.centre); }
bool holds(const Ellipsoid& body, const Vec3d& point) {
    const Vec3d local = in_object(body, point);
    return dot(local, local) < 1;
}
bool holds(const Parallelepiped& body, const Vec3d& point) {
    const Vec3d local = in_object(body, point);
    return max_norm(local) < 1;
}

/// The faces of one material along a line from the camera: how often it leaves minus how often it enters.
int crossing(const Triangle& face, const Ray<double>& ray) {
    double t = 0;
    if (!first_hit(face, ray, t)) return 0;
    return dot(geometric_normal<double>(face.v0, face.v1, face.v2), ray.direction) > 0 ? 1 : -1;
}
int crossing(const Quad& face, const Ray<double>& ray) {
    double t = 0;
    if (!first_hit(face, ray, t)) return 0;
    const bool first = is_in_first_half(record_hit(face, ray, t, false, true));
    const Vec3d normal = first ? geometric_normal<double>(face.v0, face.v1, face.v2)
                               : geometric_normal<double>(face.v0, face.v2, face.v3);
    return dot(normal, ray.direction) > 0 ? 1 : -1;
}

struct Body {
    std::uint32_t material;
    float size;
};

float size_of(const Aabb& bounds) { return norm1(bounds.upper - bounds.lower); }

std::vector<Body> bodies_around(const SceneView& scene, const std::vector<std::uint32_t>& glass, const Vec3d& camera) {
    struct Faces {
        int crossings = 0;
        Aabb bounds;
    };
    std::vector<Body> around;
    std::map<std::uint32_t, Faces> faces;                                 // by material
    const Ray<double> ray = {camera, {0.5403023, 0.8414710, 0.3817733}};  // parallel to no plane of a typical model
    for (const std::uint32_t id : glass) {
        const std::uint32_t material = scene.material_of[id];
        visit_primitive(scene, id, [&](const auto& primitive) {
            using Kind = std::decay_t<decltype(primitive)>;
            if constexpr (std::is_same_v<Kind, Triangle> || std::is_same_v<Kind, Quad>) {
                faces[material].crossings += crossing(primitive, ray);
                faces[material].bounds = merge(faces[material].bounds, bounds(primitive));
            } else if (holds(primitive, camera)) {
                around.push_back({material, size_of(bounds(primitive))});
            }
        });
    }
    for (const auto& [material, surface] : faces) {
        for (int i = 0; i < surface.crossings; ++i) around.push_back({material, size_of(surface.bounds)});
    }
    std::stable_sort(around.begin(), around.end(), [](const Body& a, const Body& b) { return a.size > b.size; });
    return around;
}

}  // namespace

void find_media(PreparedScene& prepared) {
    const SceneView scene = view(prepared);
    const std::uint32_t count = primitive_count(scene);
    std::vector<std::uint32_t> glass;
    const bool has_glass = std::any_of(prepared.optics.begin(), prepared.optics.end(),
                                       [](const Optics& optics) { return optics.transmission > 0; });
    for (std::uint32_t id = 0; has_glass && id < count; ++id) {
        if (scene.optics[scene.material_of[id]].transmission > 0) glass.push_back(id);
    }
    const std::vector<Body> around = bodies_around(scene, glass, prepared.camera.render_from_camera.translation);
    prepared.camera_media = {};
    for (const Body& body : around) {
        if (prepared.camera_media.count == std::size(prepared.camera_media.material)) break;
        prepared.camera_media.material[prepared.camera_media.count++] = body.material;
    }
    const std::uint32_t first_face = count - scene.quad_count - scene.triangle_count;
    const bool has_mesh = !glass.empty() && glass.back() >= first_face;
    const bool too_many = glass.size() * std::uint64_t{count} > 100'000'000;
    prepared.media_overlap = !around.empty() || has_mesh || too_many;
    for (std::size_t i = 0; i < glass.size() && !prepared.media_overlap; ++i) {
        for (std::uint32_t id = 0; id < count && !prepared.media_overlap; ++id) {
            prepared.media_overlap = id != glass[i] && may_touch(scene, glass[i], id);
        }
    }
}

}  // namespace tandem

/// The window through which kernels see a prepared scene, on the CPU and on the GPU.
#pragma once

#include "tandem/camera/camera.h"
#include "tandem/geometry/affine.h"
#include "tandem/light/environment.h"
#include "tandem/light/point_light.h"
#include "tandem/material/phong.h"

namespace tandem {

/// Pointers are to memory of the side that reads them. Ids as in PreparedScene.
struct SceneView {
    const Sphere* spheres;
    const Box* boxes;
    const Placement* ellipsoids;
    const Placement* parallelepipeds;
    const std::uint32_t* material_of;
    const PhongMaterial* materials;
    const PointLight* lights;
    std::uint32_t sphere_count;
    std::uint32_t box_count;
    std::uint32_t ellipsoid_count;
    std::uint32_t parallelepiped_count;
    std::uint32_t light_count;
    Environment environment;
};

TANDEM_HD std::uint32_t primitive_count(const SceneView& scene) {
    return scene.sphere_count + scene.box_count + scene.ellipsoid_count + scene.parallelepiped_count;
}

/// Calls one of four functions with the index of primitive `id` within its kind.
template <class OnSphere, class OnBox, class OnEllipsoid, class OnParallelepiped>
TANDEM_HD void visit_primitive(const SceneView& scene, std::uint32_t id, OnSphere on_sphere, OnBox on_box,
                               OnEllipsoid on_ellipsoid, OnParallelepiped on_parallelepiped) {
    if (id < scene.sphere_count) return on_sphere(scene.spheres[id]);
    id -= scene.sphere_count;
    if (id < scene.box_count) return on_box(scene.boxes[id]);
    id -= scene.box_count;
    if (id < scene.ellipsoid_count) return on_ellipsoid(scene.ellipsoids[id]);
    on_parallelepiped(scene.parallelepipeds[id - scene.ellipsoid_count]);
}

/// World-space bounds of primitive `id`, not padded.
TANDEM_HD Aabb primitive_bounds(const SceneView& scene, std::uint32_t id) {
    Aabb result;
    const auto take = [&](const auto& primitive) TANDEM_INLINE_LAMBDA { result = bounds(primitive); };
    visit_primitive(scene, id, take, take, take, take);
    return result;
}

}  // namespace tandem

#include "tandem/compile/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"
#include "tandem/compile/prepare.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

std::size_t primitive_count(const PreparedScene& scene) { return scene.material_of.size(); }

SceneView view(const PreparedScene& scene) {
    const auto count = [](const auto& array) { return static_cast<std::uint32_t>(array.size()); };
    return {
#define TANDEM_SCENE_ARRAY(Type, names) .names = scene.names.data(),
#include "tandem/kernel/view/scene_arrays.def"
        .textures = view(scene.textures),
#define TANDEM_COUNTED_SCENE_ARRAY(Type, name, names) .name##_count = count(scene.names),
#include "tandem/kernel/view/scene_arrays.def"
        .area_light_kinds = scene.area_light_kinds,
        .area_lights_cast_shadows = scene.area_light_shadows ? 1U : 0U,
        .several_slots = scene.several_slots ? 1U : 0U,
        .cutout_kinds = scene.cutout_kinds,
        .masked_kinds = scene.masked_kinds,
        .indirect_light = scene.indirect_light ? 1U : 0U,
        .roulette_from = scene.roulette_from,
        .media_overlap = scene.media_overlap ? 1U : 0U,
        .camera_media = scene.camera_media,
        .environment = scene.environment,
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) .name = scene.name,
#include "tandem/kernel/lights/lights.def"
    };
}

CameraView camera_view(const PreparedCamera& camera, int width, int height, double reach) {
    const DefaultFpEnvironment guard;
    // one pixel on the plane at distance 1, or in metres for an orthographic camera
    const double pixel = 2 * camera.half_height / height;
    const Matrix3 axes = transpose(camera.render_from_camera.linear);
    const Vec3d right = axes.row[0] * pixel;
    const Vec3d down = axes.row[1] * -pixel;
    const Vec3d to_corner = right * (-0.5 * width) + down * (-0.5 * height);
    const Vec3d forward = -axes.row[2];
    const Vec3d eye = camera.render_from_camera.translation;
    const Vec3d zero{0, 0, 0};
    CameraView view = camera.orthographic ? CameraView{eye + to_corner, right, down, forward, zero, zero, true}
                                          : CameraView{eye, zero, zero, forward + to_corner, right, down, false};
    if (camera.lens.aperture_radius > 0 && !camera.orthographic) {
        view.has_lens = true;
        view.lens_x = axes.row[0] * camera.lens.aperture_radius;
        view.lens_y = axes.row[1] * camera.lens.aperture_radius;
        view.inverse_focus = 1 / camera.lens.focus_distance;
        view.rotation = camera.lens.rotation / (2 * pi);
        view.blades = camera.lens.blades;
    }
    // rays are affine in the film position: if the corner rays are traceable, all are
    for (const double x : {-reach, width + reach}) {
        for (const double y : {-reach, height + reach}) {
            if (is_traceable(camera_ray<float>(view, x, y, 0.0F, 0.0F))) continue;
            throw InputError(
                camera.orthographic
                    ? "the orthographic camera shows points farther than 1e18 from the origin; make ymag smaller"
                    : "the camera sends rays that cannot be traced: it is farther than 1e18 from the origin, or not a "
                      "number");
        }
    }
    return view;
}

Vec3d render_from_world(const PreparedScene& scene, const Vec3d& world) { return world - scene.origin; }

Vec3d world_from_render(const PreparedScene& scene, const Vec3d& render) { return render + scene.origin; }

PrimitiveOwner owner_of(const PreparedScene& scene, std::uint32_t primitive) {
    const std::uint64_t count = primitive_count(scene) + instanced_face_count(scene.instances);
    if (primitive >= count) {
        throw InputError(fmt::format("there is no primitive {}: the prepared scene has {}", primitive, count));
    }
    if (primitive < primitive_count(scene)) return {scene.node_of[primitive], scene.material_of[primitive]};
    // the last one whose first id is not greater; the ids ascend
    const auto find = [&](const auto& list) {
        const auto after = std::upper_bound(list.begin(), list.end(), primitive,
                                            [](std::uint32_t id, const auto& entry) { return id < entry.first_id; });
        return static_cast<std::size_t>(after - list.begin()) - 1;
    };
    const PreparedInstances& all = scene.instances;
    return {all.node_of[find(all.instances)], all.meshes[find(all.meshes)].material};
}

// It reads everything that determines the image. It leaves out node_of and the numbers of dropped things, which only
// serve messages; copies, which follow from the rest; and origin, effects, time and shutter.
std::string scene_hash(const PreparedScene& scene) {
    Sha256 hash;
    const auto add = [&](const auto& array) {
        hash.update_value(std::uint64_t{array.size()});
        hash.update(array.data(), array.size() * sizeof(array[0]));
    };
#define TANDEM_SCENE_ARRAY(Type, names) add(scene.names);
#define TANDEM_RARE_SCENE_ARRAY(Type, name, names) \
    if (!scene.names.empty()) add(scene.names);
#include "tandem/kernel/view/scene_arrays.def"
    hash.update_value(std::uint8_t{scene.area_light_shadows});
    hash.update_value(scene.roulette_from);
    hash.update_value(scene.camera_media);
    hash.update_value(std::uint8_t{scene.media_overlap});
    hash.update_value(scene.environment);
    hash.update_value(std::uint32_t{scene.indirect_light});
    hash.update_value(scene.camera.render_from_camera);
    hash.update_value(std::uint8_t{scene.camera.orthographic});
    hash.update_value(scene.camera.half_height);
    hash.update_value(scene.camera.lens.aperture_radius);
    hash.update_value(scene.camera.lens.focus_distance);
    hash.update_value(scene.camera.lens.blades);
    hash.update_value(scene.camera.lens.rotation);
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    if (is_there(scene.name)) hash.update_value(scene.name);
#include "tandem/kernel/lights/lights.def"
    if (!scene.instances.empty()) {
        add(scene.instances.instances);
        add(scene.instances.meshes);
        add(scene.instances.faces);
        add(scene.instances.normals);
    }
    if (!scene.textures.materials.empty()) {  // scenes without textures keep their older hash
        add(scene.textures.texels);
        add(scene.textures.textures);
        add(scene.textures.materials);  // levels are constant
    }
    return hash.hex();
}

}  // namespace tandem

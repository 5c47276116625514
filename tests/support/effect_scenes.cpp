#include "support/effect_scenes.h"

#include <cmath>

#include "tandem/scene/named_scenes.h"

namespace tandem::test {

namespace {

Material matt(std::string name, const Vec3f& diffuse) {
    return {std::move(name), {diffuse * 0.1F, diffuse, {0.3F, 0.3F, 0.3F}, 24}};
}
Material mirror(const Vec3f& reflectance) {
    Material material{"mirror", {{0, 0, 0}, {0.02F, 0.02F, 0.02F}, {0.5F, 0.5F, 0.5F}, 200}};
    material.optics.mirror = reflectance;
    return material;
}
Material glass(std::string name, float ior, const Vec3f& absorption = {0, 0, 0}, std::uint32_t priority = 0) {
    Material material{std::move(name), {{0, 0, 0}, {0, 0, 0}, {0.5F, 0.5F, 0.5F}, 200}};
    material.optics = {{0, 0, 0}, 1, ior, absorption, priority};
    return material;
}

/// A camera, a floor, three bodies and no light. Materials: 0 floor, 1 to 3 bodies.
Scene still_life(const Material& first, const Material& second, const Material& third) {
    Scene scene;
    scene.materials = {matt("floor", {0.7F, 0.7F, 0.6F}), first, second, third};
    Node eye{.name = "eye", .camera = PerspectiveCamera{0.9}};
    eye.trs.translation = {0.1, 0.9, 3.2};
    eye.trs.rotation = {std::sin(-0.1), 0, 0, std::cos(-0.1)};
    scene.nodes.push_back(eye);
    const auto add = [&](const char* name, const Vec3d& at, const Shape& shape, std::uint32_t material) {
        Node node{.name = name, .trs = {.translation = at}};
        node.geometry.push_back({shape, material, {}});
        scene.nodes.push_back(node);
    };
    add("floor", {0, -0.6, 0}, BoxShape{{8, 0.1, 8}}, 0);
    add("ball", {-0.9, 0, 0}, SphereShape{0.5}, 1);
    add("block", {0.8, 0, -0.3}, BoxShape{{0.8, 0.9, 0.7}}, 2);
    add("small ball", {0, -0.25, 0.8}, SphereShape{0.25}, 3);
    return scene;
}
Scene matt_scene() {
    return still_life(matt("red", {0.8F, 0.2F, 0.2F}), matt("green", {0.2F, 0.7F, 0.2F}),
                      matt("blue", {0.2F, 0.2F, 0.8F}));
}

Scene lit(Scene scene, const LightSource& light, const Vec3d& at = {1.5, 3, 2}) {
    Node lamp{.name = "lamp", .trs = {.translation = at}, .light = light};
    if (light.kind != LightKind::point) {  // down and to the left
        lamp.trs.rotation = {-0.5, 0.3, 0.1, 0.8};
    }
    scene.nodes.push_back(lamp);
    return scene;
}
LightSource without_shadows() { return {.casts_shadows = false}; }

/// The bodies as meshes of triangles: an icosahedron in place of each sphere.
Scene with_meshes(Scene scene) {
    const Scene icosphere = named_scene("icosphere/2");
    scene.meshes = icosphere.meshes;
    for (Node& node : scene.nodes) {
        for (Geometry& geometry : node.geometry) {
            if (const auto* sphere = std::get_if<SphereShape>(&geometry.shape)) {
                node.trs.scale = Vec3d{1, 1, 1} * (2 * sphere->radius);
                geometry.shape = MeshShape{0};
            }
        }
    }
    return scene;
}

/// A ball of water in a ball of glass, a bubble of air in a block, and a body that reaches into another.
Scene nested() {
    Scene scene = still_life(glass("glass", 1.5F, {0.3F, 0.1F, 0.2F}, 2), glass("block", 1.6F, {0, 0.4F, 0.8F}, 1),
                             glass("water", 1.33F, {0.6F, 0.2F, 0.1F}, 1));
    scene.materials.push_back(glass("air", 1.0F, {0, 0, 0}, 9));
    const auto add = [&](const char* name, const Vec3d& at, double radius, std::uint32_t material) {
        Node node{.name = name, .trs = {.translation = at}};
        node.geometry.push_back({SphereShape{radius}, material, {}});
        scene.nodes.push_back(node);
    };
    add("water in glass", {-0.9, 0.02, 0}, 0.4, 3);
    add("bubble", {0.8, 0.1, -0.2}, 0.2, 4);
    add("reaches into the glass", {-0.4, 0.2, 0.1}, 0.3, 3);
    return scene;
}

Scene camera_in_water() {
    Scene scene = still_life(glass("glass", 1.5F), matt("green", {0.2F, 0.7F, 0.2F}),
                             glass("water", 1.33F, {0.2F, 0.05F, 0.02F}));
    Node pool{.name = "pool", .trs = {.translation = {0, 0.9, 3.2}}};
    pool.geometry.push_back({SphereShape{1.5}, 3, {}});
    scene.nodes.push_back(pool);
    return scene;
}

std::vector<EffectScene> make_scenes() {
    const Effect shadows = Effect::shadows;
    const EffectMask glass_only = Effect::refraction;
    std::vector<EffectScene> scenes;
    const LightSource plain = without_shadows();
    scenes.push_back({"phong", lit(matt_scene(), plain), {}});
    scenes.push_back({"no light at all", matt_scene(), {}});
    scenes.push_back({"shadows", lit(matt_scene(), {}), shadows});
    scenes.push_back({"fall-off", lit(matt_scene(), {.intensity = 9, .inverse_square = true, .casts_shadows = false}),
                      Effect::inverse_square});
    scenes.push_back({"spot", lit(matt_scene(), {.kind = LightKind::spot, .inner_cone = 0.1, .outer_cone = 0.5}),
                      shadows | Effect::spot_lights});
    scenes.push_back(
        {"sun", lit(matt_scene(), {.kind = LightKind::directional}), shadows | Effect::directional_lights});
    scenes.push_back({"shadows of meshes", lit(with_meshes(matt_scene()), {}), shadows});
    scenes.push_back(
        {"mirrors",
         lit(still_life(mirror({0.9F, 0.8F, 0.7F}), mirror({0.5F, 0.5F, 0.9F}), matt("blue", {0.2F, 0.2F, 0.8F})),
             plain),
         Effect::reflection});
    const Material clear = glass("glass", 1.5F);
    scenes.push_back({"glass", lit(still_life(clear, matt("green", {0.2F, 0.7F, 0.2F}), glass("diamond", 2.4F)), plain),
                      glass_only});
    scenes.push_back(
        {"tinted glass",
         lit(still_life(glass("tinted", 1.5F, {2, 0.5F, 0.1F}), glass("ice", 1.31F), matt("blue", {0.2F, 0.2F, 0.8F})),
             plain),
         glass_only | Effect::absorption});
    scenes.push_back({"nested glass", lit(nested(), plain), glass_only | Effect::absorption | Effect::nested_media});
    scenes.push_back(
        {"camera in water", lit(camera_in_water(), plain), glass_only | Effect::absorption | Effect::nested_media});
    scenes.push_back(
        {"glass meshes",
         lit(with_meshes(still_life(clear, mirror({0.6F, 0.6F, 0.6F}), glass("tinted", 1.4F, {1, 1, 0}))), {}),
         shadows | glass_only | Effect::absorption | Effect::nested_media | Effect::reflection});
    Scene everything = lit(nested(), {.intensity = 9, .inverse_square = true});
    everything.materials[3].optics.mirror = {0.2F, 0.1F, 0.1F};
    everything.materials[2].optics.transmission = 0.7F;
    everything = lit(lit(everything, {.kind = LightKind::spot, .outer_cone = 0.6}, {-1, 3, 1}),
                     {.kind = LightKind::directional, .intensity = 0.2F});
    scenes.push_back({"everything", everything, all_effects});
    return scenes;
}

}  // namespace

const std::vector<EffectScene>& effect_scenes() {
    static const std::vector<EffectScene> scenes = make_scenes();
    return scenes;
}

}  // namespace tandem::test

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

PreparedScene one_of_each() {
    PreparedScene scene;
    scene.spheres = {{{1, 2, 3}, 4}};
    scene.boxes = {{{0, 0, 0}, {1, 1, 1}}};
    scene.ellipsoids.resize(1);
    scene.parallelepipeds.resize(1);
    for (Placement* placement :
         {static_cast<Placement*>(&scene.ellipsoids[0]), static_cast<Placement*>(&scene.parallelepipeds[0])}) {
        *placement = {{}, {1, 2, 3}, {{1, 2, 3}, 2}, {1, 1, 1}};
    }
    scene.triangles = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, FaceSides::single_sided}}};
    scene.quads = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 3, FaceSides::single_sided}}};
    scene.normals.assign(7, Vec3f{0, 0, 1});
    scene.texcoords.assign(7, Vec2f{0, 1});
    scene.material_of = {0, 0, 0, 0, 0, 0};
    scene.node_of = {0, 1, 2, 3, 4, 5};
    scene.materials.resize(1);
    scene.lights.resize(1);
    scene.lights[0].intensity = {2, 2, 2};
    scene.textures.texels = {1, 2};
    scene.textures.textures = {{0, 2, 1}};
    scene.textures.materials.resize(1);
    scene.instances.instances.resize(1);
    scene.instances.node_of = {0};
    scene.instances.meshes = {{6, 0, 1, 0, 1, 0}};
    scene.instances.faces = scene.triangles;
    scene.instances.normals.assign(3, Vec3f{0, 0, 1});
    return scene;
}

TEST(SceneHash, ChangesWithEveryField) {
    const std::map<std::string, std::function<void(PreparedScene&)>> changes = {
        {"nothing", [](PreparedScene&) {}},
        {"sphere centre", [](PreparedScene& s) { s.spheres[0].centre.y = 7; }},
        {"sphere radius", [](PreparedScene& s) { s.spheres[0].radius = 7; }},
        {"one more sphere", [](PreparedScene& s) { s.spheres.push_back(s.spheres[0]); }},
        {"box lower", [](PreparedScene& s) { s.boxes[0].lower.x = -7; }},
        {"box upper", [](PreparedScene& s) { s.boxes[0].upper.z = 7; }},
        {"ellipsoid map", [](PreparedScene& s) { s.ellipsoids[0].object_from_world.row[2].z = 7; }},
        {"ellipsoid centre", [](PreparedScene& s) { s.ellipsoids[0].centre.x = 7; }},
        {"ellipsoid bound", [](PreparedScene& s) { s.ellipsoids[0].bounding_sphere.radius = 7; }},
        {"ellipsoid extent", [](PreparedScene& s) { s.ellipsoids[0].half_extent.y = 7; }},
        {"parallelepiped map", [](PreparedScene& s) { s.parallelepipeds[0].object_from_world.row[0].x = 7; }},
        {"place of an instance",
         [](PreparedScene& s) { s.instances.instances[0].render_from_object.translation.x = 7; }},
        {"material of an instanced mesh", [](PreparedScene& s) { s.instances.meshes[0].material = 7; }},
        {"corner of an instanced mesh", [](PreparedScene& s) { s.instances.faces[0].v1.x = 7; }},
        {"normal of an instanced mesh", [](PreparedScene& s) { s.instances.normals[2].x = 7; }},
        {"triangle corner", [](PreparedScene& s) { s.triangles[0].v2.y = 7; }},
        {"triangle normals", [](PreparedScene& s) { s.triangles[0].attributes.normals = 1; }},
        {"triangle texture", [](PreparedScene& s) { s.triangles[0].attributes.texcoords = 1; }},
        {"triangle sides", [](PreparedScene& s) { s.triangles[0].attributes.sides = FaceSides::double_sided; }},
        {"quad corner", [](PreparedScene& s) { s.quads[0].v3.x = -7; }},
        {"quad sides", [](PreparedScene& s) { s.quads[0].attributes.sides = FaceSides::double_sided; }},
        {"normal", [](PreparedScene& s) { s.normals[6].x = 1; }},
        {"texture coordinates", [](PreparedScene& s) { s.texcoords[6].x = 1; }},
        {"material index", [](PreparedScene& s) { s.material_of[3] = 1; }},
        {"ambient", [](PreparedScene& s) { s.materials[0].ambient.x = 0.5F; }},
        {"diffuse", [](PreparedScene& s) { s.materials[0].diffuse.y = 0.5F; }},
        {"specular", [](PreparedScene& s) { s.materials[0].specular.z = 0.5F; }},
        {"shininess", [](PreparedScene& s) { s.materials[0].shininess = 7; }},
        {"texel", [](PreparedScene& s) { s.textures.texels[1] = 7; }},
        {"texture size", [](PreparedScene& s) { s.textures.textures[0].width = 7; }},
        {"wrap mode", [](PreparedScene& s) { s.textures.textures[0].wrap_t = Wrap::clamp_to_edge; }},
        {"filter", [](PreparedScene& s) { s.textures.textures[0].filter = Filter::nearest; }},
        {"colour space", [](PreparedScene& s) { s.textures.textures[0].space = ColourSpace::linear; }},
        {"diffuse texture", [](PreparedScene& s) { s.textures.materials[0].diffuse.texture = 0; }},
        {"texture place", [](PreparedScene& s) { s.textures.materials[0].diffuse.v_row[2] = 7; }},
        {"normal texture", [](PreparedScene& s) { s.textures.materials[0].normal.texture = 0; }},
        {"normal scale", [](PreparedScene& s) { s.textures.materials[0].normal_scale = 7; }},
        {"alpha cutoff", [](PreparedScene& s) { s.textures.materials[0].alpha_cutoff = 7; }},
        {"metallic-roughness texture",
         [](PreparedScene& s) { s.textures.materials[0].metallic_roughness.texture = 0; }},
        {"directions", [](PreparedScene& s) { s.anisotropies.resize(1); }},
        {"slot of directions", [](PreparedScene& s) { s.anisotropies = {{.slot = 1}}; }},
        {"no texture", [](PreparedScene& s) { s.textures = {}; }},
        {"light position", [](PreparedScene& s) { s.lights[0].position.x = 7; }},
        {"light intensity", [](PreparedScene& s) { s.lights[0].intensity.y = 7; }},
        {"background bottom", [](PreparedScene& s) { s.environment.bottom.x = 7; }},
        {"environment texels",
         [](PreparedScene& s) {
             s.environment_texels = {{1, 2, 3}};
         }},
        {"environment rotation",
         [](PreparedScene& s) {
             s.environment_picture = {0.5, 1, 1};
         }},
        {"background top", [](PreparedScene& s) { s.environment.top.x = 7; }},
        {"ambient light", [](PreparedScene& s) { s.environment.ambient.x = 7; }},
        {"camera axes", [](PreparedScene& s) { s.camera.render_from_camera.linear.row[0].y = 7; }},
        {"camera place", [](PreparedScene& s) { s.camera.render_from_camera.translation.y = 7; }},
        {"projection", [](PreparedScene& s) { s.camera.orthographic = true; }},
        {"field of view", [](PreparedScene& s) { s.camera.half_height = 7; }},
    };
    std::map<std::string, std::string> name_of;
    const auto expect_new = [&](const std::string& name, const PreparedScene& scene) {
        const auto [known, is_new] = name_of.emplace(scene_hash(scene), name);
        EXPECT_TRUE(is_new) << name << " has the hash of " << known->second;
    };
    for (const auto& [name, change] : changes) {
        PreparedScene scene = one_of_each();
        change(scene);
        expect_new(name, scene);
    }
    // Optional parts of materials: absent, there, and every number of them
    const auto change_part = [&](const char* name, auto parts) {
        PreparedScene scene = one_of_each();
        auto& part = (scene.*parts).emplace_back();
        expect_new(name, scene);
        using Part = std::decay_t<decltype(part)>;
        Part::visit_numbers(part, [&](const char* number, auto& value, float, float) {
            const auto before = value;
            value = value * 0.5F + std::decay_t<decltype(value)>(0.25F);
            expect_new(std::string(name) + " " + number, scene);
            value = before;
        });
        part.is_there = 0;
        expect_new(std::string("no ") + name, scene);
    };
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) change_part(is, &PreparedScene::names);
#include "tandem/kernel/bsdf/lobes.def"
}

TEST(SceneHash, DoesNotMoveBetweenNeighbouringArrays) {
    PreparedScene a = one_of_each();
    PreparedScene b = one_of_each();
    a.parallelepipeds.clear();
    b.ellipsoids.clear();  // the same bytes, in another array
    EXPECT_NE(scene_hash(a), scene_hash(b));
}

TEST(SceneHash, LeavesOutWhatOnlyServesMessages) {
    PreparedScene scene = one_of_each();
    const std::string before = scene_hash(scene);
    scene.node_of[2] = 9;
    scene.dropped_primitives = 9;
    scene.dropped_lights = 9;
    EXPECT_EQ(scene_hash(scene), before);
}

}  // namespace
}  // namespace tandem

#include "support/effect_scenes.h"

#include <cmath>

#include "tandem/compile/derive.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::test {

namespace {

Material lambertian(std::string name, const Vec3f& diffuse) {
    return {std::move(name), {diffuse * 0.1F, diffuse, {0.3F, 0.3F, 0.3F}, 24}};
}
Material mirror(const Vec3f& reflectance) {
    Material material{"mirror", {{0, 0, 0}, {0.02F, 0.02F, 0.02F}, {0.5F, 0.5F, 0.5F}, 200}};
    material.optics.mirror = reflectance;
    return material;
}
Material glass(std::string name, float ior, const Vec3f& absorption = {0, 0, 0}, std::uint32_t priority = 0) {
    Material material{std::move(name), {{0, 0, 0}, {0, 0, 0}, {0.5F, 0.5F, 0.5F}, 200}};
    material.optics = {.transmission = 1, .ior = ior, .absorption = absorption, .priority = priority};
    return material;
}

/// A camera, a floor, three objects and no light. Materials: 0 floor, 1 to 3 objects.
Scene still_life(const Material& first, const Material& second, const Material& third) {
    Scene scene;
    scene.materials = {lambertian("floor", {0.7F, 0.7F, 0.6F}), first, second, third};
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
Scene diffuse_scene() {
    return still_life(lambertian("red", {0.8F, 0.2F, 0.2F}), lambertian("green", {0.2F, 0.7F, 0.2F}),
                      lambertian("blue", {0.2F, 0.2F, 0.8F}));
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

/// The objects as triangle meshes, with an icosahedron instead of each sphere.
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

/// A ball of water in a ball of glass, a bubble of air in a block, and a solid that reaches into another.
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
    Scene scene = still_life(glass("glass", 1.5F), lambertian("green", {0.2F, 0.7F, 0.2F}),
                             glass("water", 1.33F, {0.2F, 0.05F, 0.02F}));
    Node pool{.name = "pool", .trs = {.translation = {0, 0.9, 3.2}}};
    pool.geometry.push_back({SphereShape{1.5}, 3, {}});
    scene.nodes.push_back(pool);
    return scene;
}

/// An image of 8 x 8 texels, of which every third is masked out.
Image checks(const char* name, bool masked) {
    Image image{name, 8, 8, {}};
    for (std::uint32_t i = 0; i < 64; ++i) {
        const std::uint32_t level = (i * 37 + i / 8 * 91) % 200 + 40;
        const std::uint32_t alpha = masked && i % 3 == 0 ? 0U : 255U;
        image.texels.push_back(level | (255 - level) << 8 | (i * 4) << 16 | alpha << 24);
    }
    return image;
}
/// A normal map with normals tilted in all directions.
Image bumps() {
    Image image{"bumps", 8, 8, {}};
    for (std::uint32_t i = 0; i < 64; ++i) {
        image.texels.push_back((100 + i * 11 % 60) | (90 + i * 23 % 70) << 8 | 235U << 16 | 255U << 24);
    }
    return image;
}

/// Every kind of primitive with a texture: sphere, box, ellipsoid, rotated box, mesh.
Scene textured(bool colours, bool normals, bool masked) {
    Scene scene = diffuse_scene();
    scene.images = {checks("checks", masked), bumps()};
    scene.textures = {{0, Wrap::repeat, Wrap::mirrored_repeat, Filter::linear},
                      {0, Wrap::clamp_to_edge, Wrap::repeat, Filter::nearest},
                      {1, Wrap::repeat, Wrap::repeat, Filter::linear}};
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        if (colours)
            material.diffuse_texture = TextureReference{i % 2 == 0 ? 0U : 1U, {0.1F, 0.2F}, 0.3F, {1.5F, 2.5F}};
        if (normals) material.normal_texture = TextureReference{2, {0, 0}, 0, {2, 2}};
        if (masked && i > 0) material.alpha_mode = AlphaMode::mask;
    }
    Node egg{.name = "egg", .trs = {{0.1, 0.35, -0.6}, {0.2, 0.1, 0.3, 0.9}, {1, 1.4, 0.8}}};
    egg.geometry.push_back({SphereShape{0.3}, 1, {}});
    Node brick{.name = "brick", .trs = {{-0.3, -0.3, 0.6}, {0.1, 0.5, 0.2, 0.8}, {1, 1, 1}}};
    brick.geometry.push_back({BoxShape{{0.4, 0.3, 0.3}}, 2, {}});
    Mesh sheet{.name = "sheet",
               .positions = {{-0.5F, 0, 0}, {0.5F, 0, 0}, {0.5F, 0.7F, 0.1F}, {-0.5F, 0.7F, 0}, {0, 1.1F, 0}},
               .texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0.5F, -0.5F}}},
               .triangles = {3, 2, 4},
               .quads = {0, 1, 2, 3}};
    scene.meshes.push_back(sheet);
    scene.materials.push_back(scene.materials[3]);
    scene.materials.back().sides = FaceSides::double_sided;
    Node sail{.name = "sail", .trs = {.translation = {0.6, -0.2, 0.9}}};
    sail.geometry.push_back({MeshShape{0}, 4, {}});
    scene.nodes.insert(scene.nodes.end(), {egg, brick, sail});
    return scene;
}

Material lamp(const Vec3f& radiance) {
    Material material{"lamp", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1}};
    material.optics.emission = radiance;
    return material;
}
/// An emissive ball, and an emissive sheet of a triangle and a quad, above the scene.
Scene with_lamps(Scene scene) {
    const auto first = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.insert(scene.materials.end(), {lamp({6, 5, 4}), lamp({2, 3, 4})});
    Node ball{.name = "emissive ball", .trs = {.translation = {1.2, 1.6, 1}}};
    ball.geometry.push_back({SphereShape{0.3}, first, {}});
    Mesh sheet{.name = "sheet",  // its front is below
               .positions = {{-0.6F, 0, -0.4F}, {0.6F, 0, -0.4F}, {0.6F, 0, 0.4F}, {-0.6F, 0, 0.4F}, {0, 0, 1.2F}},
               .triangles = {3, 2, 4},
               .quads = {0, 1, 2, 3}};
    Node panel{.name = "panel", .trs = {{-0.8, 1.8, -0.2}, {0, 0, 0, 1}, {1, 1, 1}}};
    panel.geometry.push_back({MeshShape{static_cast<std::uint32_t>(scene.meshes.size())}, first + 1, {}});
    scene.meshes.push_back(sheet);
    scene.nodes.insert(scene.nodes.end(), {ball, panel});
    return scene;
}
/// An emissive ball so small and far that rounding moves the end of a shadow ray by as much as its size: rays often hit
/// its surface before their end.
Scene with_star(Scene scene) {
    const auto number = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(lamp({4e10F, 3e10F, 2e10F}));
    Node star{.name = "star", .trs = {.translation = {30, 90, 40}}};
    star.geometry.push_back({SphereShape{1e-3}, number, {}});
    scene.nodes.push_back(star);
    return scene;
}
/// The same lamps with emissive textures; the sheet uses its second set of texture coordinates, partly outside [0, 1].
Scene with_pictured_lamps() {
    Scene scene = with_lamps(diffuse_scene());
    scene.images = {checks("emission", false)};
    for (std::size_t i = 0; i < 40; ++i) scene.images[0].texels[i] &= 0xFF000000U;  // black
    scene.textures = {{0, Wrap::repeat, Wrap::mirrored_repeat, Filter::linear}};
    const std::size_t ball = scene.materials.size() - 2;
    scene.materials[ball].emissive_texture = TextureReference{};
    scene.materials[ball + 1].emissive_texture = TextureReference{.rotation = 0.4F, .scale = {2, 1.5F}, .texcoord = 1};
    scene.meshes.back().texcoords = {{}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0.5F, -0.5F}}};
    return scene;
}
/// The sheet of textured() with vertex colours, whose alpha masks, and a normal map at a second set of texture
/// coordinates.
Scene with_vertex_colours() {
    Scene scene = textured(true, true, false);
    Mesh& sheet = scene.meshes[0];
    sheet.colours = {{{1, 0.2F, 0.3F}, 1}, {{0.4F, 1, 0.1F}, 0.2F}, {{0.9F, 0.8F, 1}, 1}, {{0.1F, 0.3F, 1}, 0.3F}, {}};
    sheet.texcoords.push_back({{0, 0}, {0.5F, 0}, {0.5F, 1}, {0, 1}, {0.3F, 0.7F}});
    Material& material = scene.materials[4];
    material.normal_texture->texcoord = 1;
    material.alpha_mode = AlphaMode::mask;
    // a solid with the same material has no vertices: its vertex colour is white
    scene.nodes[scene.nodes.size() - 2].geometry[0].material = 4;
    return scene;
}
/// An unlit ball and an unlit sheet among other objects.
Scene with_unlit() {
    Scene scene = textured(true, false, false);
    scene.materials[1].unlit = true;
    scene.materials[4].unlit = true;
    scene.materials[4].sides = FaceSides::single_sided;
    scene.meshes[0].colours = {{{1, 0.2F, 0.3F}, 1}, {{0.4F, 1, 0.1F}, 1}, {}, {{0.1F, 0.3F, 1}, 1}, {}};
    return scene;
}
/// Open meshes with culled backs: a sheet seen from behind, one from the front, and a roof above both.
Scene with_culled_faces() {
    Scene scene = textured(false, false, false);
    scene.materials[4].sides = FaceSides::culled;
    const auto add = [&](const char* name, const Vec3d& at, const Quaternion& turn) {
        Node node{.name = name, .trs = {at, turn, {1, 1, 1}}};
        node.geometry.push_back({MeshShape{0}, 4, {}});
        scene.nodes.push_back(node);
    };
    add("from behind", {-0.4, -0.1, 1.0}, {0, 1, 0, 0.1});
    add("roof", {0.2, 1.2, 0}, {0.7, 0.1, 0, 0.7});
    return scene;
}
Material polished(std::string name, const Vec3f& colour, float metallic, float roughness) {
    Material material = lambertian(std::move(name), colour);
    material.microfacets = Microfacets{metallic, roughness};
    return material;
}
/// A smooth metal, a rough one, and a dielectric with a diffuse base.
Scene polished_scene() {
    return still_life(polished("gold", {0.9F, 0.7F, 0.3F}, 1, 0.15F), polished("worn", {0.6F, 0.6F, 0.7F}, 0.7F, 0.6F),
                      polished("varnish", {0.1F, 0.2F, 0.5F}, 0, 0.4F));
}
/// The camera and all objects inside a polished dielectric ball, which shows its back.
Scene inside_polished_ball() {
    Scene scene = polished_scene();
    Node dome{.name = "dome"};
    dome.geometry.push_back({SphereShape{9}, 3, {}});
    scene.nodes.push_back(dome);
    return scene;
}
/// A polished dielectric sheet, single-sided, that shows its back.
Scene behind_polished_sheet() {
    Scene scene = polished_scene();
    scene.meshes = {{.name = "sheet",
                     .positions = {{-0.5F, 0, 0}, {0.5F, 0, 0}, {0.5F, 0.7F, 0.1F}, {-0.5F, 0.7F, 0}},
                     .quads = {0, 1, 2, 3}}};
    Node sheet{.name = "sheet", .trs = {{-0.2, -0.1, 1.0}, {0, 1, 0, 0.1}, {1, 1, 1}}};
    sheet.geometry.push_back({MeshShape{0}, 3, {}});
    scene.nodes.push_back(sheet);
    return scene;
}
/// Every kind of primitive with textured microfacets, normal maps, and double-sided faces.
Scene worn_scene() {
    Scene scene = textured(true, true, false);
    for (std::size_t i = 1; i < scene.materials.size(); ++i) {
        scene.materials[i].microfacets = Microfacets{0.9F, 0.7F};
        scene.materials[i].metallic_roughness_texture = TextureReference{0, {0.3F, 0.1F}, 0.2F, {2, 1}};
    }
    return scene;
}
/// The same metals, brushed along u or in a direction of their own.
Scene brushed(Scene scene) {
    float rotation = 0;
    for (Material& material : scene.materials) {
        if (!material.microfacets) continue;
        material.microfacets->anisotropy = 0.8F;
        material.microfacets->rotation = rotation;
        rotation += 0.7F;
    }
    return scene;
}
/// Of every kind of primitive. The directions of some come from a picture, at a second set of coordinates where there
/// is one; the tangent then comes from the set of the normals.
Scene brushed_and_worn() {
    Scene scene = brushed(worn_scene());
    scene.meshes[0].texcoords.push_back({{0, 0}, {0.5F, 0}, {0.5F, 1}, {0, 1}, {0.3F, 0.7F}});
    for (const std::size_t i : {2U, 4U}) {
        scene.materials[i].anisotropy_texture = TextureReference{1, {0.1F, 0}, 0.4F, {1, 2}};
    }
    scene.materials[4].anisotropy_texture->texcoord = 1;
    scene.materials[3].normal_texture.reset();
    return scene;
}
/// Adds a sheen to every material that has no mirror and transmits no light. Some have textures, one at a second set of
/// coordinates where there is one.
Scene of_cloth(Scene scene) {
    float roughness = 0.9F;
    for (Material& material : scene.materials) {
        if (material.optics.transmission > 0 || norm1(material.optics.mirror) > 0) continue;
        material.sheen = Sheen{{roughness, 0.8F, 0.5F}, roughness};
        roughness *= 0.6F;
        if (scene.textures.empty()) continue;
        material.sheen_colour_texture = TextureReference{0, {0.3F, 0.1F}, 0.2F, {2, 1}};
        material.sheen_roughness_texture = TextureReference{1};
    }
    return scene;
}
Scene in_daylight(Scene scene, bool illuminates, bool indirect) {
    scene.environment = {{0.2F, 0.15F, 0.1F}, {0.6F, 0.8F, 1}, {0, 0, 0}, illuminates ? 1U : 0U};
    scene.indirect_light = indirect;
    return scene;
}
/// Adds a rotated environment picture of 12 x 6 texels with a bright window.
Scene within_picture(Scene scene, bool illuminates, bool indirect) {
    scene = in_daylight(std::move(scene), illuminates, indirect);
    EnvironmentImage image{{12, 6, {}}, 0.7, 0.8F};
    for (int i = 0; i < 72; ++i) {
        const auto level = static_cast<float>((i * 37 + i / 12 * 91) % 50);
        image.picture.pixels.push_back({0.1F + level * 0.01F, 0.3F, 0.7F - level * 0.01F});
    }
    for (const std::size_t window : {17U, 18U, 30U}) image.picture.pixels[window] = {5, 4, 3};
    scene.environment_image = std::move(image);
    return scene;
}
Scene through(Scene scene, const Lens& lens) {
    std::get<PerspectiveCamera>(*scene.nodes[0].camera).lens = lens;
    return scene;
}

std::vector<EffectScene> make_scenes() {
    const Effect shadows = Effect::shadows;
    const EffectMask glass_only = Effect::refraction;
    std::vector<EffectScene> scenes;
    // Punctual lights and shadows
    const LightSource plain = without_shadows();
    scenes.push_back({"phong", lit(diffuse_scene(), plain), {}});
    scenes.push_back({"no light at all", diffuse_scene(), {}});
    scenes.push_back({"shadows", lit(diffuse_scene(), {}), shadows});
    scenes.push_back({"fall-off",
                      lit(diffuse_scene(), {.intensity = 9, .inverse_square = true, .casts_shadows = false}),
                      Effect::inverse_square});
    scenes.push_back({"spot", lit(diffuse_scene(), {.kind = LightKind::spot, .inner_cone = 0.1, .outer_cone = 0.5}),
                      shadows | Effect::spot_lights});
    scenes.push_back(
        {"sun", lit(diffuse_scene(), {.kind = LightKind::directional}), shadows | Effect::directional_lights});
    scenes.push_back({"shadows of meshes", lit(with_meshes(diffuse_scene()), {}), shadows});
    // Mirrors and dielectrics
    scenes.push_back(
        {"mirrors",
         lit(still_life(mirror({0.9F, 0.8F, 0.7F}), mirror({0.5F, 0.5F, 0.9F}), lambertian("blue", {0.2F, 0.2F, 0.8F})),
             plain),
         Effect::reflection});
    const Material clear = glass("glass", 1.5F);
    scenes.push_back({"glass",
                      lit(still_life(clear, lambertian("green", {0.2F, 0.7F, 0.2F}), glass("diamond", 2.4F)), plain),
                      glass_only});
    scenes.push_back({"tinted glass",
                      lit(still_life(glass("tinted", 1.5F, {2, 0.5F, 0.1F}), glass("ice", 1.31F),
                                     lambertian("blue", {0.2F, 0.2F, 0.8F})),
                          plain),
                      glass_only | Effect::absorption});
    scenes.push_back({"nested glass", lit(nested(), plain), glass_only | Effect::absorption | Effect::nested_media});
    scenes.push_back(
        {"camera in water", lit(camera_in_water(), plain), glass_only | Effect::absorption | Effect::nested_media});
    scenes.push_back(
        {"glass meshes",
         lit(with_meshes(still_life(clear, mirror({0.6F, 0.6F, 0.6F}), glass("tinted", 1.4F, {1, 1, 0}))), {}),
         shadows | glass_only | Effect::absorption | Effect::nested_media | Effect::reflection});
    // Textures, normal maps and alpha masks
    const EffectMask lamps = Effect::shadows | Effect::area_lights | Effect::emission;
    scenes.push_back({"textures", lit(textured(true, false, false), plain), Effect::textures});
    scenes.push_back({"normal maps", lit(textured(false, true, false), plain), Effect::normal_maps});
    scenes.push_back({"cut-outs", lit(textured(true, true, true), {}),
                      shadows | Effect::textures | Effect::normal_maps | Effect::cutouts});
    scenes.push_back({"cut-outs under a star", with_star(textured(true, true, true)),
                      lamps | Effect::textures | Effect::normal_maps | Effect::cutouts});
    // Lenses, area lights and indirect light
    scenes.push_back({"round lens", lit(through(diffuse_scene(), {0.1, 3}), plain), Effect::lens});
    scenes.push_back({"five blades", lit(through(diffuse_scene(), {0.15, 2.4, 5, 0.3}), plain), Effect::lens});
    scenes.push_back({"lamps", with_lamps(diffuse_scene()), lamps});
    scenes.push_back({"daylight", in_daylight(diffuse_scene(), true, false), shadows | Effect::environment_light});
    scenes.push_back({"indirect", in_daylight(lit(with_meshes(diffuse_scene()), {}), false, true),
                      shadows | Effect::indirect | Effect::roulette});
    scenes.push_back({"lamps, indirect", in_daylight(with_lamps(diffuse_scene()), true, true),
                      lamps | Effect::environment_light | Effect::indirect | Effect::roulette});
    scenes.push_back({"pictured lamps", with_pictured_lamps(), lamps | Effect::textures});
    scenes.push_back({"pictured lamps, indirect", in_daylight(with_pictured_lamps(), false, true),
                      lamps | Effect::textures | Effect::indirect | Effect::roulette});
    // Vertex colours, unlit materials and culled faces
    scenes.push_back({"vertex colours", lit(with_vertex_colours(), {}),
                      shadows | Effect::textures | Effect::normal_maps | Effect::cutouts});
    scenes.push_back({"unlit", lit(with_unlit(), plain), Effect::textures | Effect::emission});
    scenes.push_back({"unlit, indirect", in_daylight(lit(with_unlit(), {}), false, true),
                      shadows | Effect::textures | Effect::emission | Effect::indirect | Effect::roulette});
    scenes.push_back({"culled faces", lit(with_culled_faces(), {}), shadows | Effect::cutouts});
    // Microfacets
    const Effect facets = Effect::microfacets;
    scenes.push_back({"microfacets", lit(polished_scene(), plain), facets});
    scenes.push_back({"microfacets, lamps", with_lamps(polished_scene()), lamps | facets});
    scenes.push_back({"microfacets, lamps, indirect", in_daylight(with_lamps(polished_scene()), true, true),
                      lamps | facets | Effect::environment_light | Effect::indirect | Effect::roulette});
    scenes.push_back({"worn metal", in_daylight(lit(worn_scene(), {}), true, false),
                      shadows | facets | Effect::textures | Effect::normal_maps | Effect::environment_light});
    scenes.push_back({"inside a polished ball", in_daylight(lit(inside_polished_ball(), plain), true, false),
                      shadows | facets | Effect::environment_light});
    const EffectMask grooves = facets | Effect::anisotropy;
    scenes.push_back({"brushed metal, lamps", with_lamps(brushed(polished_scene())), lamps | grooves});
    scenes.push_back(
        {"brushed metal without coordinates", lit(with_meshes(brushed(polished_scene())), plain), grooves});
    scenes.push_back({"brushed and worn metal", in_daylight(lit(brushed_and_worn(), {}), true, false),
                      shadows | grooves | Effect::textures | Effect::normal_maps | Effect::environment_light});
    scenes.push_back({"cloth, lamps", with_lamps(of_cloth(diffuse_scene())), lamps | Effect::sheen});
    scenes.push_back(
        {"cloth over metal, lamps, indirect", in_daylight(with_lamps(of_cloth(polished_scene())), true, true),
         lamps | facets | Effect::sheen | Effect::environment_light | Effect::indirect | Effect::roulette});
    scenes.push_back(
        {"worn cloth", in_daylight(lit(of_cloth(worn_scene()), {}), true, false),
         shadows | facets | Effect::sheen | Effect::textures | Effect::normal_maps | Effect::environment_light});
    const EffectMask surroundings = shadows | Effect::environment_light | Effect::environment_picture;
    scenes.push_back(
        {"picture behind", within_picture(lit(diffuse_scene(), plain), false, false), Effect::environment_picture});
    scenes.push_back({"picture", within_picture(diffuse_scene(), true, false), surroundings});
    scenes.push_back({"picture, microfacets", within_picture(polished_scene(), true, false), surroundings | facets});
    scenes.push_back({"picture, behind a polished sheet, indirect", within_picture(behind_polished_sheet(), true, true),
                      surroundings | facets | Effect::indirect | Effect::roulette});
    scenes.push_back({"picture, lamps, indirect", within_picture(with_lamps(polished_scene()), true, true),
                      surroundings | lamps | facets | Effect::indirect | Effect::roulette});
    Scene everything = within_picture(with_lamps(lit(nested(), {.intensity = 9, .inverse_square = true})), true, true);
    const Scene pictures = textured(true, true, true);
    everything.images = pictures.images;
    everything.textures = pictures.textures;
    everything.materials[0] = pictures.materials[1];
    everything.materials[0].microfacets = Microfacets{.metallic = 0.6F, .roughness = 0.5F, .anisotropy = 0.5F};
    everything.materials[0].metallic_roughness_texture = TextureReference{1};
    everything.materials[0].sheen = Sheen{{0.3F, 0.2F, 0.1F}, 0.4F};
    everything = through(everything, {0.03, 3});
    everything.materials[3].optics.mirror = {0.2F, 0.1F, 0.1F};
    everything.materials[2].optics.transmission = 0.7F;
    everything = lit(lit(everything, {.kind = LightKind::spot, .outer_cone = 0.6}, {-1, 3, 1}),
                     {.kind = LightKind::directional, .intensity = 0.2F});
    scenes.push_back({"everything", everything, all_effects - host_effects});
    return scenes;
}

}  // namespace

const std::vector<EffectScene>& effect_scenes() {
    static const std::vector<EffectScene> scenes = make_scenes();
    return scenes;
}

}  // namespace tandem::test

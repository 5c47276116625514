#include "tandem/compile/prepare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "tandem/base/error.h"
#include "tandem/base/memory.h"
#include "tandem/compile/area_lights.h"
#include "tandem/compile/cutout_kinds.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/environments.h"
#include "tandem/compile/media.h"
#include "tandem/compile/node_checks.h"
#include "tandem/compile/place_instances.h"
#include "tandem/compile/place_mesh.h"
#include "tandem/compile/place_solids.h"
#include "tandem/compile/prepare_textures.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/compile/render_origin.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/lengths.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/light_cone.h"

namespace tandem {

namespace {

/// A unit vector, also for lengths whose squares underflow; zero stays zero.
Vec3d unit_axis(const Vec3d& a) {
    const double largest = max_norm(a);
    return largest > 0 ? normalize(a / largest) : a;
}

/// An unlit material: its colour becomes emission, and it reflects no light.
void make_unlit(PhongMaterial& phong, Optics& optics) {
    optics = {.emission = phong.diffuse, .unlit = 1};
    phong = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1};
}

class Preparer {
  public:
    Preparer(const Scene& scene, const PrepareOptions& options)
        : scene_(scene),
          options_(options),
          settings_(without_effects(options.settings, options.effects.off)),
          instances_(scene, instanced_uses(scene, options.instanced_from)) {}

    PreparedScene run() {
        result_.time = options_.time ? *options_.time : time_of_frame(scene_, options_.frame);
        world_from_node_ = world_from_nodes(scene_, result_.time);
        for (const Material& material : scene_.materials) {
            result_.materials.push_back(material.phong);
            result_.optics.push_back(material.optics);
        }
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) add_parts(&Material::name, result_.names);
#include "tandem/kernel/bsdf/lobes.def"
        prepare_textures(scene_, result_);
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            if (scene_.materials[i].unlit) make_unlit(result_.materials[i], result_.optics[i]);
        }
        result_.environment = scene_.environment;
        result_.indirect_light = scene_.indirect_light;
        check_size();
        result_.camera_node = camera_node(scene_, options_.camera);
        const Camera& camera = *scene_.nodes[result_.camera_node].camera;
        set_camera(camera, result_.camera_node);
        if (!options_.time) result_.shutter = shutter_of(camera);
        const Solids solids(scene_, world_from_node_, result_);
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) add_node(i, solids);
        result_.dropped_primitives += solids.dropped();
        move_to_origin(solids);
        result_.copies = find_copies(result_);
        find_area_lights_and_media();
        result_.area_light_shadows = settings_.area_light_shadows;
        for (const MaterialTextures& material : result_.textures.materials) {
            result_.several_slots = result_.several_slots || reads_several_slots(material);
        }
        for (const Anisotropy& anisotropy : result_.anisotropies) {
            result_.several_slots = result_.several_slots || (anisotropy.slot | anisotropy.texture.slot) != 0;
        }
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    for (const TextureUse& use : result_.names) result_.several_slots = result_.several_slots || use.slot != 0;
#include "tandem/kernel/bsdf/lobes.def"
        result_.masked_kinds = kinds_cut_out_by_alpha(result_);
        result_.cutout_kinds |= result_.masked_kinds;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    if (scene_.authored) prepare_environment(*scene_.authored, result_);
#include "tandem/kernel/lights/lights.def"
        if (settings_.roulette && scene_.indirect_light) result_.roulette_from = first_roulette;
        if (settings_.solids_are_disjoint) result_.media_overlap = false;
        result_.effects = (mask_of(derive_effects(scene_, result_)) | options_.effects.on) - host_effects;
        return std::move(result_);
    }

  private:
    /// Throws InputError if the scene has too many primitives, and EnvironmentError if the memory cannot hold them.
    void check_size() const {
        std::size_t count = 0, spheres = 0, boxes = 0;
        for (const Node& node : scene_.nodes) {
            for (const Geometry& geometry : node.geometry) {
                if (is_kept_once(geometry)) continue;
                const std::size_t instances = instance_count(geometry);
                count += primitives_in(geometry.shape) * instances;
                if (std::holds_alternative<SphereShape>(geometry.shape)) spheres += instances;
                if (std::holds_alternative<BoxShape>(geometry.shape)) boxes += instances;
            }
        }
        if (count >= no_primitive_limit) {
            throw InputError(
                fmt::format("the scene has {} primitives, over the limit of {}", count, no_primitive_limit));
        }
        // the smaller primitive of each kind, and its material and node
        const std::size_t bytes = spheres * sizeof(Sphere) + boxes * sizeof(Box) +
                                  (count - spheres - boxes) * sizeof(Triangle) + 2 * count * sizeof(std::uint32_t);
        require_memory(bytes, fmt::format("the scene of {} primitives", count));
    }

    bool is_kept_once(const Geometry& geometry) const {
        const auto* shape = std::get_if<MeshShape>(&geometry.shape);
        return shape != nullptr && instances_.is_kept({shape->mesh, geometry.material});
    }

    /// The optional part `part`, for every material, if any has it.
    template <class Part>
    void add_parts(std::optional<Part> Material::*part, std::vector<Part>& parts) {
        const auto has_it = [part](const Material& material) { return material.*part && !material.unlit; };
        if (std::none_of(scene_.materials.begin(), scene_.materials.end(), has_it)) return;
        constexpr auto absent = std::bit_cast<Part>(std::array<std::byte, sizeof(Part)>{});
        for (const Material& material : scene_.materials) {
            parts.push_back(has_it(material) ? *(material.*part) : absent);
        }
    }

    /// Searches the scene without copies, which are neither lights nor visible to rays.
    void find_area_lights_and_media() {
        const auto find = [this](PreparedScene& scene) {
            find_media(scene);
            if (settings_.area_lights) find_area_lights(scene);
        };
        if (result_.copies.empty()) return find(result_);
        PreparedScene traced = without_copies(result_);
        find(traced);
        result_.camera_media = traced.camera_media;
        result_.media_overlap = traced.media_overlap;
        result_.area_lights = std::move(traced.area_lights);
        result_.area_light_kinds = traced.area_light_kinds;
        const TracedIds ids(result_.copies);
        for (AreaLight& light : result_.area_lights) light.primitive = ids.of_scene(light.primitive);
    }

    /// Russian roulette starts only at this vertex: on shorter paths it saves less than its noise costs.
    static constexpr std::uint32_t first_roulette = 3;
    static constexpr std::size_t no_primitive_limit = std::size_t{1} << 30;

    /// Throws an error about this node if it has one, so that the message names the first faulty node.
    void add_node(std::size_t index, const Solids& solids) {
        const Node& node = scene_.nodes[index];
        const Transform& world_from_node = world_from_node_[index];
        for (const Geometry& geometry : node.geometry) {
            solids.check(geometry);
            if (!std::holds_alternative<MeshShape>(geometry.shape)) continue;
            if (geometry.instances.empty()) add_mesh(geometry, world_from_node, index);
            for (const Trs& node_from_instance : geometry.instances) {
                add_mesh(geometry, world_from_node * to_transform(node_from_instance), index);
            }
        }
        if (node.light) add_light(*node.light, world_from_node, index);
    }

    void add_light(const LightSource& source, const Transform& world_from_node, std::size_t node) {
        check_reach(scene_, node, world_from_node.translation, {0, 0, 0});
        const Vec3d axis = unit_axis(-transpose(world_from_node.linear).row[2]);
        const bool directed = source.kind != LightKind::point;
        if (!is_lit(source)) return;
        if (directed && is_hidden(world_from_node.linear)) {
            ++result_.dropped_lights;
            return;
        }
        if (directed && axis == Vec3d{0, 0, 0}) {
            fail_at_node(scene_, node, "a light whose transform leaves it without a direction");
        }
        PunctualLight light{};
        const bool falls_off = source.inverse_square && source.kind != LightKind::directional;
        light.kind = static_cast<PunctualKind>(source.kind);
        light.intensity = source.colour * source.intensity;
        light.direction = directed ? axis : Vec3d{0, 0, -1};
        if (source.kind == LightKind::spot) {
            const LightCone cone = light_cone(source.inner_cone, source.outer_cone);
            light.cone_height = cone.height;
            light.cone_scale = cone.scale;
        }
        light.inverse_square = falls_off ? 1U : 0U;
        light.casts_shadows = source.casts_shadows ? 1U : 0U;
        lights_.push_back({world_from_node.translation, light});
    }

    std::size_t primitives_in(const Shape& shape) const {
        const auto* reference = std::get_if<MeshShape>(&shape);
        if (reference == nullptr) return 1;
        const Mesh& mesh = scene_.meshes[reference->mesh];
        return mesh.triangles.size() / 3 + mesh.quads.size() / 4;
    }

    void add_mesh(const Geometry& geometry, const Transform& world_from_object, std::size_t node) {
        if (!result_.textures.is_masked_out.empty() && result_.textures.is_masked_out[geometry.material]) {
            result_.dropped_primitives += primitives_in(geometry.shape);
            return;
        }
        const Mesh& mesh = scene_.meshes[std::get<MeshShape>(geometry.shape).mesh];
        if (instances_.take({std::get<MeshShape>(geometry.shape).mesh, geometry.material},
                            {&mesh, world_from_object, geometry.material, node})) {
            return;
        }
        for (const Vec3f& position : mesh.positions) {
            check_reach(scene_, node, transform_point(world_from_object, widen(position)), {0, 0, 0});
        }
        surfaces_.push_back({&mesh, world_from_object, geometry.material, node});
    }

    /// Chooses the origin of render space, moves everything there and rounds it to float.
    void move_to_origin(const Solids& solids) {
        const Vec3d origin = options_.origin ? *options_.origin : precise_origin(solids);
        result_.origin = origin;
        result_.camera.render_from_camera.translation -= origin;
        for (const Light& light : lights_) {
            result_.lights.push_back(light.light);
            result_.lights.back().position = narrow(light.position - origin);
        }
        const std::vector<CornerSlots> slots = corner_slots(scene_);
        const std::vector<PlacedSurface> written_out =
            instances_.take_back(origin, result_, [this](const Aabb& box) { return sees_outside_of(box); });
        surfaces_.insert(surfaces_.end(), written_out.begin(), written_out.end());
        const std::size_t faces = reserve_faces(slots);
        solids.place(origin, faces, result_);
        for (const PlacedSurface& surface : surfaces_) {
            Transform render_from_object = surface.world_from_object;
            render_from_object.translation -= origin;
            const FaceSides sides = sides_of(surface, render_from_object);
            const PlacedMesh placed =
                place_mesh(*surface.mesh, render_from_object, sides, slots[surface.material], result_);
            if (sides == FaceSides::culled && placed.triangles + placed.quads > 0) {
                if (result_.culled_node == PreparedScene::never)
                    result_.culled_node = static_cast<std::uint32_t>(surface.node);
                if (placed.triangles > 0) result_.cutout_kinds |= PrimitiveKinds::triangle;
                if (placed.quads > 0) result_.cutout_kinds |= PrimitiveKinds::quad;
            }
            triangles_.add(surface.material, surface.node, placed.triangles);
            quads_.add(surface.material, surface.node, placed.quads);
        }
        for (const Owners* owners : {&triangles_, &quads_}) append(*owners);
        instances_.place(origin, slots, result_);
    }

    /// Reserves the arrays, because growing ones take twice the memory, and more while they are copied. Returns the
    /// number of faces, with degenerate ones.
    std::size_t reserve_faces(const std::vector<CornerSlots>& slots) {
        std::size_t triangles = 0, quads = 0, normals = 0, texcoords = 0;
        for (const PlacedSurface& surface : surfaces_) {
            const Mesh& mesh = *surface.mesh;
            triangles += mesh.triangles.size() / 3;
            quads += mesh.quads.size() / 4;
            const std::size_t corners = mesh.triangles.size() + mesh.quads.size();
            if (!mesh.normals.empty()) normals += corners;
            texcoords += corners * slots[surface.material].count();
        }
        result_.triangles.reserve(triangles);
        result_.quads.reserve(quads);
        result_.normals.reserve(normals);
        result_.texcoords.reserve(texcoords);
        return triangles + quads;
    }

    /// Turns culling off for faces whose backs cannot be seen: those of a mesh that hides_backs(), with the camera
    /// outside.
    FaceSides sides_of(const PlacedSurface& surface, const Transform& render_from_object) const {
        const FaceSides sides = scene_.materials[surface.material].sides;
        if (sides != FaceSides::culled || !hides_backs(*surface.mesh, surface.material, result_)) return sides;
        return sees_outside_of(bounds_of(*surface.mesh, render_from_object)) ? FaceSides::single_sided : sides;
    }

    /// Whether the camera's rays start outside of the box. Those of an orthographic camera start anywhere on its plane.
    bool sees_outside_of(const Aabb& box) const {
        const Vec3d eye = result_.camera.render_from_camera.translation;
        const Vec3d lower = widen(box.lower) - eye, upper = widen(box.upper) - eye;
        if (!result_.camera.orthographic) {
            const double reach = result_.camera.lens.aperture_radius;
            const auto holds = [&](double from, double to) { return from <= reach && to >= -reach; };
            return !(holds(lower.x, upper.x) && holds(lower.y, upper.y) && holds(lower.z, upper.z));
        }
        const Vec3d forward = -transpose(result_.camera.render_from_camera.linear).row[2];
        const auto least = [](double a, double from, double to) { return std::min(a * from, a * to); };
        return least(forward.x, lower.x, upper.x) + least(forward.y, lower.y, upper.y) +
                   least(forward.z, lower.z, upper.z) >
               0;
    }

    Vec3d precise_origin(const Solids& solids) const {
        RenderOrigin origin(result_.camera.render_from_camera.translation);
        solids.add_to(origin);
        for (const PlacedSurface& surface : surfaces_) origin.add_mesh(*surface.mesh, surface.world_from_object);
        instances_.add_to(origin, result_.camera.render_from_camera.translation);
        for (const Light& light : lights_) {
            if (light.light.kind != PunctualKind::directional) origin.add_point(light.position);
        }
        return origin.get();
    }

    void set_camera(const Camera& camera, std::size_t node) {
        const Transform& world_from_node = world_from_node_[node];
        const std::optional<Matrix3> axes = camera_axes(world_from_node);
        if (!axes) fail_at_node(scene_, node, "a camera under a transform that is not invertible");
        check_reach(scene_, node, world_from_node.translation, {0, 0, 0});
        // in world space until the origin is chosen
        result_.camera.render_from_camera = {transpose(*axes), world_from_node.translation};
        if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
            result_.camera.half_height = accurate_tan(perspective->yfov / 2);
            result_.camera.lens = perspective->lens;
        } else {
            result_.camera.orthographic = true;
            result_.camera.half_height = std::get<OrthographicCamera>(camera).ymag;
        }
    }

    struct Light {
        Vec3d position;  ///< world space, until the render origin is known
        PunctualLight light;
    };

    /// The materials and nodes of the primitives of one kind.
    struct Owners {
        std::vector<std::uint32_t> material;
        std::vector<std::uint32_t> node;
        void add(std::uint32_t m, std::size_t n, std::size_t count) {
            material.insert(material.end(), count, m);
            node.insert(node.end(), count, static_cast<std::uint32_t>(n));
        }
    };
    void append(const Owners& owners) {
        result_.material_of.insert(result_.material_of.end(), owners.material.begin(), owners.material.end());
        result_.node_of.insert(result_.node_of.end(), owners.node.begin(), owners.node.end());
    }

    const Scene& scene_;
    const PrepareOptions& options_;
    const RenderSettings settings_;
    std::vector<Transform> world_from_node_;
    std::vector<PlacedSurface> surfaces_;
    InstanceList instances_;
    std::vector<Light> lights_;
    Owners triangles_, quads_;
    PreparedScene result_;
};

}  // namespace

void check(const Scene& scene) {
    const DefaultFpEnvironment guard;
    const std::vector<std::string> problems = validate(scene);
    if (!problems.empty()) throw InputError(fmt::format("the scene is not valid: {}", fmt::join(problems, "; ")));
}

PreparedScene prepare(const Scene& scene, const PrepareOptions& options) {
    const DefaultFpEnvironment guard;
    check(scene);
    if (options.effects.off.empty()) return Preparer(scene, options).run();
    return Preparer(without_effects(scene, options.effects.off), options).run();
}

std::shared_ptr<const PreparedScene> prepare_shared(const Scene& scene, const PrepareOptions& options) {
    return std::make_shared<const PreparedScene>(prepare(scene, options));
}

}  // namespace tandem

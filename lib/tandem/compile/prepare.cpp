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
#include "tandem/compile/place_instances.h"
#include "tandem/compile/place_mesh.h"
#include "tandem/compile/prepare_textures.h"
#include "tandem/compile/render_origin.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/light_cone.h"

namespace tandem {

namespace {

/// Relative deviation up to which a linear map counts as a rotation times a uniform scale. A unit quaternion from a
/// file gives 1e-16; such a deviation moves a surface far less than the rounding of its centre to float.
constexpr double similarity_tolerance = 1e-12;

/// The uniform scale of `m`, or 0 if the scale is not uniform.
double uniform_scale(const Matrix3& m) {
    const Matrix3 columns = transpose(m);
    const double length2 = dot(columns.row[0], columns.row[0]);
    const double tolerance = similarity_tolerance * length2;
    const bool same = std::abs(dot(columns.row[1], columns.row[1]) - length2) <= tolerance &&
                      std::abs(dot(columns.row[2], columns.row[2]) - length2) <= tolerance;
    const bool right_angled = std::abs(dot(columns.row[0], columns.row[1])) <= tolerance &&
                              std::abs(dot(columns.row[1], columns.row[2])) <= tolerance &&
                              std::abs(dot(columns.row[2], columns.row[0])) <= tolerance;
    return same && right_angled ? std::sqrt(length2) : 0;
}

bool is_diagonal(const Matrix3& m) {
    return m.row[0].y == 0 && m.row[0].z == 0 && m.row[1].x == 0 && m.row[1].z == 0 && m.row[2].x == 0 &&
           m.row[2].y == 0;
}

/// A unit vector, also for lengths whose squares underflow; zero stays zero.
Vec3d unit_axis(const Vec3d& a) {
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    return largest > 0 ? normalize(a / largest) : a;
}

/// Whether a transform shrinks a solid to a line or a point, up to rounding. Animations hide objects in this way.
bool is_hidden(const Matrix3& m) {
    double largest = 0;
    for (const Vec3d& row : m.row) largest = std::max({largest, std::abs(row.x), std::abs(row.y), std::abs(row.z)});
    if (largest == 0) return true;
    const Matrix3 columns = transpose(m);
    const auto area2 = [&](int i, int k) {
        const Vec3d normal = cross(columns.row[i] / largest, columns.row[k] / largest);
        return dot(normal, normal);
    };
    return std::max({area2(0, 1), area2(1, 2), area2(2, 0)}) <= 1e-30;
}

/// Whether a solid whose size is not zero in float becomes smaller than any float under its transform.
bool vanishes_in_float(double size, double transformed) { return narrow(size) > 0 && !(narrow(transformed) > 0); }

/// Whether the map is a scale without mirroring.
bool is_upright(const Matrix3& m) { return is_diagonal(m) && m.row[0].x >= 0 && m.row[1].y >= 0 && m.row[2].z >= 0; }

/// The unit sphere, or the cube [-1, 1]^3, in world space.
struct Placed {
    Transform world_from_unit;
    Matrix3 unit_from_world;
};

Placement place(const Placed& body, const Vec3d& origin, bool is_box) {
    const Matrix3& m = body.world_from_unit.linear;
    Placement placement;
    placement.object_from_world = body.unit_from_world;
    placement.centre = body.world_from_unit.translation - origin;
    const auto extent = [&](const Vec3d& row) {
        // support of the solid along a world axis: l1 norm for the cube, l2 for the ball
        const double support = is_box ? norm1(row) : std::sqrt(dot(row, row));
        return support * (1 + 1e-15);
    };
    placement.half_extent = {extent(m.row[0]), extent(m.row[1]), extent(m.row[2])};
    const Vec3f centre = narrow(placement.centre);
    const Vec3d moved = placement.centre - widen(centre);
    // the farthest point of the solid from its centre, and the rounding of the centre
    double radius = 0;
    if (is_box) {
        const Matrix3 c = transpose(m);
        for (int corner = 0; corner < 4; ++corner) {
            const Vec3d p = c.row[0] + c.row[1] * (corner & 1 ? 1.0 : -1.0) + c.row[2] * (corner & 2 ? 1.0 : -1.0);
            radius = std::max(radius, std::sqrt(dot(p, p)));
        }
    } else {
        // the Frobenius norm bounds the largest singular value
        radius = std::sqrt(dot(m.row[0], m.row[0]) + dot(m.row[1], m.row[1]) + dot(m.row[2], m.row[2]));
    }
    placement.bounding_sphere = {centre, round_up((radius + std::sqrt(dot(moved, moved))) * (1 + 1e-15))};
    return placement;
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
        reserve_solids();
        result_.camera_node = camera_node(scene_, options_.camera);
        const Camera& camera = *scene_.nodes[result_.camera_node].camera;
        set_camera(camera, result_.camera_node);
        if (!options_.time) result_.shutter = shutter_of(camera);
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) add_node(i);
        move_to_origin();
        join_kinds();
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
        result_.cutout_kinds |= kinds_cut_out_by_alpha(view(result_));
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    if (scene_.authored) prepare_environment(*scene_.authored, result_);
#include "tandem/kernel/lights/lights.def"
        if (settings_.roulette && scene_.indirect_light) result_.roulette_from = first_roulette;
        if (settings_.solids_are_disjoint) result_.media_overlap = false;
        result_.effects = (mask_of(derive_effects(scene_, result_)) | options_.effects.on) - host_effects;
        return std::move(result_);
    }

  private:
    /// Reserves memory for spheres and boxes, which may become either of two kinds. Untouched memory costs nothing.
    /// Throws InputError if the scene has too many primitives, and EnvironmentError if the memory cannot hold them.
    void reserve_solids() {
        std::size_t count = 0, spheres = 0, boxes = 0;
        for (const Node& node : scene_.nodes) {
            for (const Geometry& geometry : node.geometry) {
                const std::size_t instances = std::max<std::size_t>(1, geometry.instances.size());
                if (is_kept_once(geometry)) continue;
                count += primitives_in(geometry.shape) * instances;
                if (std::holds_alternative<SphereShape>(geometry.shape)) spheres += instances;
                if (std::holds_alternative<BoxShape>(geometry.shape)) boxes += instances;
            }
        }
        if (count >= no_primitive_limit) {
            throw InputError(
                fmt::format("the scene has {} primitives, over the limit of {}", count, no_primitive_limit));
        }
        // of each kind the smaller primitive, in double and in float; then material and node
        const std::size_t bytes = spheres * (sizeof(Ball) + sizeof(Sphere)) + boxes * (sizeof(Block) + sizeof(Box)) +
                                  (count - spheres - boxes) * sizeof(Triangle) + 2 * count * sizeof(std::uint32_t);
        require_memory(bytes, fmt::format("the scene of {} primitives", count));
        balls_.reserve(spheres);
        placed_balls_.reserve(spheres);
        spheres_.reserve(spheres);
        ellipsoids_.reserve(spheres);
        blocks_.reserve(boxes);
        placed_boxes_.reserve(boxes);
        boxes_.reserve(boxes);
        parallelepipeds_.reserve(boxes);
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

    /// Without copies, which are neither lights nor visible to rays.
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

    void add_node(std::size_t index) {
        const Node& node = scene_.nodes[index];
        const Transform& world_from_node = world_from_node_[index];
        for (const Geometry& geometry : node.geometry) {
            if (geometry.instances.empty()) add_primitive(geometry, world_from_node, index);
            for (const Trs& node_from_instance : geometry.instances) {
                add_primitive(geometry, world_from_node * to_transform(node_from_instance), index);
            }
        }
        if (node.light) add_light(*node.light, world_from_node, index);
    }

    void add_light(const LightSource& source, const Transform& world_from_node, std::size_t node) {
        check_reach(world_from_node.translation, {0, 0, 0}, node);
        const Vec3d axis = unit_axis(-transpose(world_from_node.linear).row[2]);
        const bool directed = source.kind != LightKind::point;
        if (!is_lit(source)) return;
        if (directed && is_hidden(world_from_node.linear)) {
            ++result_.dropped_lights;
            return;
        }
        if (directed && axis == Vec3d{0, 0, 0}) {
            fail(node, "a light with a direction under a transform that removes it");
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

    void add_primitive(const Geometry& geometry, const Transform& world_from_object, std::size_t node) {
        if (!result_.textures.is_masked_out.empty() && result_.textures.is_masked_out[geometry.material]) {
            result_.dropped_primitives += primitives_in(geometry.shape);
            return;
        }
        if (!std::holds_alternative<MeshShape>(geometry.shape) && is_hidden(world_from_object.linear)) {
            ++result_.dropped_primitives;
            return;
        }
        if (const auto* sphere = std::get_if<SphereShape>(&geometry.shape)) {
            add_sphere(*sphere, geometry.material, world_from_object, node);
        } else if (const auto* box = std::get_if<BoxShape>(&geometry.shape)) {
            add_box(*box, geometry.material, world_from_object, node);
        } else {
            add_mesh(std::get<MeshShape>(geometry.shape), geometry.material, world_from_object, node);
        }
    }

    std::size_t primitives_in(const Shape& shape) const {
        const auto* reference = std::get_if<MeshShape>(&shape);
        if (reference == nullptr) return 1;
        const Mesh& mesh = scene_.meshes[reference->mesh];
        return mesh.triangles.size() / 3 + mesh.quads.size() / 4;
    }

    void add_mesh(const MeshShape& shape, std::uint32_t material, const Transform& world_from_object,
                  std::size_t node) {
        const Mesh& mesh = scene_.meshes[shape.mesh];
        if (instances_.take({shape.mesh, material}, {&mesh, world_from_object, material, node})) return;
        for (const Vec3f& position : mesh.positions) {
            check_reach(transform_point(world_from_object, widen(position)), {0, 0, 0}, node);
        }
        surfaces_.push_back({&mesh, world_from_object, material, node});
    }

    void add_sphere(const SphereShape& shape, std::uint32_t material, const Transform& world_from_object,
                    std::size_t node) {
        const double scale = uniform_scale(world_from_object.linear);
        if (scale > 0 && keeps_its_picture(world_from_object, material)) {
            const double radius = scale * shape.radius;
            if (vanishes_in_float(shape.radius, radius)) {
                ++result_.dropped_primitives;
                return;
            }
            if (!(narrow(radius) > 0)) fail(node, "a sphere whose radius vanishes in float under the node's scale");
            check_reach(world_from_object.translation, {radius, radius, radius}, node);
            balls_.push_back({world_from_object.translation, radius});
            spheres_.add(material, node);
            return;
        }
        const double r = shape.radius;
        add_placement(world_from_object, {r, r, r}, false, material, node);
    }

    void add_box(const BoxShape& shape, std::uint32_t material, const Transform& world_from_object, std::size_t node) {
        const Vec3d half = shape.size * 0.5;
        const Matrix3& m = world_from_object.linear;
        if (is_diagonal(m) && keeps_its_picture(world_from_object, material)) {
            const Vec3d extent = {std::abs(m.row[0].x) * half.x, std::abs(m.row[1].y) * half.y,
                                  std::abs(m.row[2].z) * half.z};
            if (vanishes_in_float(norm1(half), norm1(extent))) {
                ++result_.dropped_primitives;
                return;
            }
            check_reach(world_from_object.translation, extent, node);
            blocks_.push_back({world_from_object.translation, extent});
            boxes_.add(material, node);
            return;
        }
        add_placement(world_from_object, half, true, material, node);
    }

    /// Spheres and boxes have the axes of the world; a picture that is turned or mirrored needs its own, and so do the
    /// grooves of a brushed surface.
    bool keeps_its_picture(const Transform& world_from_object, std::uint32_t material) const {
        const bool is_brushed = !result_.anisotropies.empty() && result_.microfacets[material].anisotropy > 0;
        bool has_picture = has_texture(result_.textures, material);
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    has_picture = has_picture || (!result_.names.empty() && result_.names[material].texture != no_texture);
#include "tandem/kernel/bsdf/lobes.def"
        return !(is_brushed || has_picture) || is_upright(world_from_object.linear);
    }

    /// `size`: scale from the unit solid to the shape.
    void add_placement(const Transform& world_from_object, const Vec3d& size, bool is_box, std::uint32_t material,
                       std::size_t node) {
        Transform world_from_unit = world_from_object;
        for (Vec3d& row : world_from_unit.linear.row) row = row * size;
        const double volume = std::abs(determinant(world_from_unit.linear));
        const Matrix3& m = world_from_unit.linear;
        if (vanishes_in_float(norm1(size), norm1(m.row[0]) + norm1(m.row[1]) + norm1(m.row[2]))) {
            ++result_.dropped_primitives;
            return;
        }
        const double lengths = std::sqrt(dot(m.row[0], m.row[0]) * dot(m.row[1], m.row[1]) * dot(m.row[2], m.row[2]));
        // below this the inverse has no digits left; a NaN fails as well
        if (!(volume > 1e-12 * lengths) || !std::isnormal(volume)) {
            if (!is_box) fail(node, "a sphere that its transform flattens");
            fail(node, is_diagonal(m) ? "a mirrored box that is flat and has a texture or is brushed; give it thickness"
                                      : "a rotated or sheared box that is flat; give it thickness");
        }
        check_reach(world_from_unit.translation, {norm1(m.row[0]), norm1(m.row[1]), norm1(m.row[2])}, node);
        (is_box ? placed_boxes_ : placed_balls_).push_back({world_from_unit, inverse(m)});
        (is_box ? parallelepipeds_ : ellipsoids_).add(material, node);
    }

    /// World space.
    void check_reach(const Vec3d& centre, const Vec3d& half_extent, std::size_t node) const {
        for (int i = 0; i < 3; ++i) {
            if (!(std::abs(centre[i]) + half_extent[i] <= double{coordinate_limit})) {
                fail(node, "coordinates farther than 1e18 from the origin");
            }
        }
    }

    [[noreturn]] void fail(std::size_t node, const std::string& what) const {
        const std::string& name = scene_.nodes[node].name;
        throw InputError(fmt::format("node {}{} has {}", node, name.empty() ? "" : " '" + name + "'", what));
    }

    /// Chooses the origin of render space, moves everything there and rounds it to float.
    void move_to_origin() {
        const Vec3d origin = options_.origin ? *options_.origin : precise_origin();
        result_.origin = origin;
        result_.camera.render_from_camera.translation -= origin;
        for (const Light& light : lights_) {
            result_.lights.push_back(light.light);
            result_.lights.back().position = narrow(light.position - origin);
        }
        result_.spheres.reserve(balls_.size());
        for (const Ball& ball : balls_) result_.spheres.push_back({narrow(ball.centre - origin), narrow(ball.radius)});
        result_.boxes.reserve(blocks_.size());
        for (const Block& block : blocks_) {
            const Vec3d centre = block.centre - origin;
            result_.boxes.push_back({narrow(centre - block.extent), narrow(centre + block.extent)});
        }
        result_.ellipsoids.reserve(placed_balls_.size());
        for (const Placed& body : placed_balls_) result_.ellipsoids.push_back({place(body, origin, false)});
        result_.parallelepipeds.reserve(placed_boxes_.size());
        for (const Placed& body : placed_boxes_) result_.parallelepipeds.push_back({place(body, origin, true)});
        const std::vector<CornerSlots> slots = corner_slots(scene_);
        const std::vector<PlacedSurface> written_out =
            instances_.take_back(origin, [this](const Aabb& box) { return sees_outside_of(box); });
        surfaces_.insert(surfaces_.end(), written_out.begin(), written_out.end());
        reserve_faces(slots);
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
        instances_.place(origin, slots, result_);
    }

    /// Reserves the arrays, because growing ones take twice the memory, and more while they are copied.
    void reserve_faces(const std::vector<CornerSlots>& slots) {
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
    }

    /// Turns culling off for faces whose backs cannot be seen: those of a closed mesh with the camera outside.
    FaceSides sides_of(const PlacedSurface& surface, const Transform& render_from_object) const {
        const FaceSides sides = scene_.materials[surface.material].sides;
        if (sides != FaceSides::culled || !surface.mesh->is_closed) return sides;
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

    Vec3d precise_origin() const {
        RenderOrigin origin(result_.camera.render_from_camera.translation);
        for (const Ball& ball : balls_) origin.add_sphere(ball.centre, ball.radius);
        for (const Block& block : blocks_) origin.add_box(block.centre - block.extent, block.centre + block.extent);
        for (const Placed& body : placed_balls_) origin.add_placed(body.world_from_unit, body.unit_from_world, false);
        for (const Placed& body : placed_boxes_) origin.add_placed(body.world_from_unit, body.unit_from_world, true);
        for (const PlacedSurface& surface : surfaces_) origin.add_mesh(*surface.mesh, surface.world_from_object);
        instances_.add_to(origin, result_.camera.render_from_camera.translation);
        for (const Light& light : lights_) {
            if (light.light.kind != PunctualKind::directional) origin.add_point(light.position);
        }
        return origin.get();
    }

    void join_kinds() {
        const auto join = [this](const Owners& owners) {
            result_.material_of.insert(result_.material_of.end(), owners.material.begin(), owners.material.end());
            result_.node_of.insert(result_.node_of.end(), owners.node.begin(), owners.node.end());
        };
#define TANDEM_PRIMITIVE(Type, name, names) join(names##_);
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    }

    void set_camera(const Camera& camera, std::size_t node) {
        const Transform& world_from_node = world_from_node_[node];
        const std::optional<Matrix3> axes = camera_axes(world_from_node);
        if (!axes) fail(node, "a camera under a transform that is not invertible");
        check_reach(world_from_node.translation, {0, 0, 0}, node);
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

    // World space, double; rounded to float once the render origin is known.
    struct Ball {
        Vec3d centre;
        double radius;
    };
    struct Block {
        Vec3d centre;
        Vec3d extent;  ///< half of the edges
    };
    struct Light {
        Vec3d position;
        PunctualLight light;
    };

    /// The materials and nodes of the primitives of one kind.
    struct Owners {
        std::vector<std::uint32_t> material;
        std::vector<std::uint32_t> node;
        void add(std::uint32_t m, std::size_t n, std::size_t count = 1) {
            material.insert(material.end(), count, m);
            node.insert(node.end(), count, static_cast<std::uint32_t>(n));
        }
        void reserve(std::size_t count) {
            material.reserve(count);
            node.reserve(count);
        }
    };

    const Scene& scene_;
    const PrepareOptions& options_;
    const RenderSettings settings_;
    std::vector<Transform> world_from_node_;
    std::vector<Ball> balls_;
    std::vector<Block> blocks_;
    std::vector<Placed> placed_balls_, placed_boxes_;
    std::vector<PlacedSurface> surfaces_;
    InstanceList instances_;
    std::vector<Light> lights_;
#define TANDEM_PRIMITIVE(Type, name, names) Owners names##_;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
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

}  // namespace tandem

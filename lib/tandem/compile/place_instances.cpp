#include "tandem/compile/place_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/math/lengths.h"
#include "tandem/scene/normal_matrix.h"

namespace tandem {

namespace {

constexpr std::size_t least_faces_of_mesh = 64;
constexpr std::uint64_t least_instances = 8;
/// Instances that cannot be kept are written out. A small file must not take much memory in this way.
constexpr std::uint64_t most_refused_faces = 16'000'000;
/// Farther away, products in float might overflow in the frame of the mesh.
constexpr double farthest = 1e9;

bool can_be_kept_once(const Mesh& mesh, const Material& material) {
    return mesh.triangles.size() / 3 >= least_faces_of_mesh && !material.unlit && !material.emissive_texture &&
           norm1(material.optics.emission) == 0 && material.optics.transmission == 0;
}

double frobenius_norm(const Matrix3& m) {
    return std::sqrt(dot(m.row[0], m.row[0]) + dot(m.row[1], m.row[1]) + dot(m.row[2], m.row[2]));
}

/// Half of the extent of a transformed box along each axis.
Vec3d half_extent(const Matrix3& m, const Vec3d& half) {
    const auto along = [&](const Vec3d& row) {
        return std::abs(row.x) * half.x + std::abs(row.y) * half.y + std::abs(row.z) * half.z;
    };
    return {along(m.row[0]), along(m.row[1]), along(m.row[2])};
}

/// The faces of a mesh with so many instances, with their corners in object space; the values at the corners in
/// `scene`.
std::vector<Triangle> faces_of(const Mesh& mesh, std::size_t instances, bool mirrors, FaceSides sides,
                               const CornerSlots& slots, PreparedScene& scene) {
    // place_mesh() reverses the corners under a mirroring; it is undone below, so no coordinate changes
    Transform as_it_is;
    if (mirrors) as_it_is.linear.row[0].x = -1;
    PreparedScene placed;
    (void)place_mesh(mesh, as_it_is, sides, slots, placed);
    const auto first_texcoord = static_cast<std::uint32_t>(scene.texcoords.size());
    scene.texcoords.insert(scene.texcoords.end(), placed.texcoords.begin(), placed.texcoords.end());
    scene.dropped_primitives += placed.dropped_primitives * instances;
    for (Triangle& face : placed.triangles) {
        if (mirrors) {
            for (Vec3f* corner : {&face.v0, &face.v1, &face.v2}) corner->x = -corner->x;
        }
        if (face.attributes.texcoords != no_attributes) face.attributes.texcoords += first_texcoord;
    }
    // Normals as they are in the mesh: placing them twice would round them twice
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size() && !mesh.normals.empty(); i += 3) {
        const std::uint32_t* corner = &mesh.triangles[i];
        if (is_degenerate(mesh.positions[corner[0]], mesh.positions[corner[1]], mesh.positions[corner[2]])) continue;
        placed.triangles[kept++].attributes.normals = static_cast<std::uint32_t>(scene.instances.normals.size());
        for (const int k : {0, mirrors ? 2 : 1, mirrors ? 1 : 2}) {
            scene.instances.normals.push_back(mesh.normals[corner[k]]);
        }
    }
    return std::move(placed.triangles);
}

}  // namespace

std::set<MeshUse> instanced_uses(const Scene& scene, std::uint64_t least_faces) {
    std::map<MeshUse, std::uint64_t> count;
    for (const Node& node : scene.nodes) {
        for (const Geometry& geometry : node.geometry) {
            const auto* shape = std::get_if<MeshShape>(&geometry.shape);
            if (shape == nullptr) continue;
            if (!scene.meshes[shape->mesh].quads.empty()) return {};
            count[{shape->mesh, geometry.material}] += std::max<std::size_t>(1, geometry.instances.size());
        }
    }
    for (const Material& material : scene.materials) {
        if (material.optics.transmission > 0) return {};
    }
    std::set<MeshUse> uses;
    std::uint64_t faces = 0;
    for (const auto& [use, instances] : count) {
        const Mesh& mesh = scene.meshes[use.mesh];
        if (instances < least_instances || !can_be_kept_once(mesh, scene.materials[use.material])) continue;
        uses.insert(use);
        faces += instances * (mesh.triangles.size() / 3);
    }
    return faces < least_faces ? std::set<MeshUse>{} : uses;
}

const InstanceList::MeshFacts& InstanceList::facts(std::uint32_t mesh) const {
    const auto [place, is_new] = facts_.try_emplace(mesh);
    if (!is_new) return place->second;
    const Mesh& of = scene_.meshes[mesh];
    Aabb box;
    for (std::size_t i = 0; i < of.triangles.size(); i += 3) {
        const Vec3f& a = of.positions[of.triangles[i]];
        const Vec3f& b = of.positions[of.triangles[i + 1]];
        const Vec3f& c = of.positions[of.triangles[i + 2]];
        if (!is_degenerate(a, b, c)) box = merge(box, box_around(a, b, c));
    }
    place->second = {(widen(box.lower) + widen(box.upper)) * 0.5, (widen(box.upper) - widen(box.lower)) * 0.5,
                     is_empty(box)};
    return place->second;
}

bool InstanceList::take(const MeshUse& use, const PlacedSurface& surface) {
    if (!is_kept(use)) return false;
    if (can_take(use, surface)) return true;
    refused_faces_ += surface.mesh->triangles.size() / 3;
    if (refused_faces_ > most_refused_faces) {
        throw InputError(fmt::format(
            "the instances of mesh {} are too large, too small, too flat or too far away to be kept once, and their "
            "faces are too many to be written out; make the transforms moderate (coordinates up to 1e9)",
            use.mesh));
    }
    return false;
}

bool InstanceList::can_take(const MeshUse& use, const PlacedSurface& surface) {
    const Matrix3& m = surface.world_from_object.linear;
    const double size = frobenius_norm(m), volume = determinant(m);
    // a NaN fails as well; below this the inverse has too few digits
    if (!(std::abs(volume) > 1e-9 * size * size * size)) return false;
    const Matrix3 inverse_of = inverse(m);
    double norm = 0;
    for (const Vec3d& row : inverse_of.row) norm = std::max(norm, norm1(row));
    const MeshFacts& of_mesh = facts(use.mesh);
    if (of_mesh.is_empty) return false;
    const Vec3d centre = transform_point(surface.world_from_object, of_mesh.centre);
    const double reach = max_norm(centre) + max_norm(half_extent(m, of_mesh.half));
    if (!(norm > 2 * least_row_norm && norm < most_row_norm / 2 && reach < farthest)) return false;
    instances_[{use, volume < 0}].push_back(surface);
    return true;
}

void InstanceList::add_to(RenderOrigin& origin, const Vec3d& camera) const {
    struct Far {
        double distance;
        const PlacedSurface* surface;
    };
    std::vector<Far> all;
    for (const auto& [key, surfaces] : instances_) {
        const MeshFacts& of_mesh = facts(key.use.mesh);
        for (const PlacedSurface& surface : surfaces) {
            const Vec3d centre = transform_point(surface.world_from_object, of_mesh.centre);
            const Vec3d half = half_extent(surface.world_from_object.linear, of_mesh.half);
            origin.add_far(centre - half, centre + half);
            const Vec3d from = camera - centre;
            const auto beyond = [](double a, double extent) { return std::max(std::abs(a) - extent, 0.0); };
            all.push_back({length({beyond(from.x, half.x), beyond(from.y, half.y), beyond(from.z, half.z)}), &surface});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Far& a, const Far& b) { return a.distance < b.distance; });
    for (const Far& far : all) {
        if (!(far.distance < origin.distance())) return;
        origin.add_mesh(*far.surface->mesh, far.surface->world_from_object);
    }
}

std::vector<PlacedSurface> InstanceList::take_back(const Vec3d& origin, const PreparedScene& prepared,
                                                   const std::function<bool(const Aabb&)>& sees_outside_of) {
    std::vector<PlacedSurface> back;
    for (auto& [key, surfaces] : instances_) {
        if (scene_.materials[key.use.material].sides != FaceSides::culled) continue;
        if (!hides_backs(scene_.meshes[key.use.mesh], key.use.material, prepared)) continue;
        const MeshFacts& of_mesh = facts(key.use.mesh);
        const auto is_seen_from_outside = [&](const PlacedSurface& surface) {
            const Vec3d centre = transform_point(surface.world_from_object, of_mesh.centre) - origin;
            const Vec3d half = half_extent(surface.world_from_object.linear, of_mesh.half) * (1 + 0x1p-20);
            return sees_outside_of(enclose(centre, half + Vec3d(0x1p-20 * (max_norm(centre) + max_norm(half)))));
        };
        const auto end = std::stable_partition(surfaces.begin(), surfaces.end(), is_seen_from_outside);
        back.insert(back.end(), end, surfaces.end());
        surfaces.erase(end, surfaces.end());
    }
    return back;
}

void InstanceList::place(const Vec3d& origin, const std::vector<CornerSlots>& slots, PreparedScene& scene) const {
    PreparedInstances& all = scene.instances;
    std::uint64_t next_id = 0;
#define TANDEM_PRIMITIVE(Type, name, names) next_id += scene.names.size();
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    for (const auto& [key, surfaces] : instances_) {
        if (surfaces.empty()) continue;
        const Mesh& mesh = scene_.meshes[key.use.mesh];
        FaceSides sides = scene_.materials[key.use.material].sides;
        // take_back() has returned those whose backs may be seen
        if (sides == FaceSides::culled && hides_backs(mesh, key.use.material, scene)) sides = FaceSides::single_sided;
        const std::vector<Triangle> faces =
            faces_of(mesh, surfaces.size(), key.mirrors, sides, slots[key.use.material], scene);
        if (faces.empty()) continue;
        if (sides == FaceSides::culled) {
            scene.cutout_kinds |= PrimitiveKinds::triangle;
            if (scene.culled_node == PreparedScene::never) {
                scene.culled_node = static_cast<std::uint32_t>(surfaces.front().node);
            }
        }
        constexpr std::uint64_t most_ids = 0xFFFF'0000U;
        if (next_id + faces.size() * surfaces.size() > most_ids) {
            throw InputError(fmt::format("the instances of meshes have more than {} faces; split the scene", most_ids));
        }
        all.meshes.push_back({static_cast<std::uint32_t>(next_id), static_cast<std::uint32_t>(all.instances.size()),
                              static_cast<std::uint32_t>(surfaces.size()), static_cast<std::uint32_t>(all.faces.size()),
                              static_cast<std::uint32_t>(faces.size()), key.use.material});
        all.faces.insert(all.faces.end(), faces.begin(), faces.end());
        for (const PlacedSurface& surface : surfaces) {
            MeshInstance instance{};
            instance.render_from_object = surface.world_from_object;
            instance.render_from_object.translation -= origin;
            instance.normal_matrix = normal_matrix(surface.world_from_object.linear);
            instance.first_id = static_cast<std::uint32_t>(next_id);
            all.instances.push_back(instance);
            all.node_of.push_back(static_cast<std::uint32_t>(surface.node));
            next_id += faces.size();
        }
    }
}

}  // namespace tandem

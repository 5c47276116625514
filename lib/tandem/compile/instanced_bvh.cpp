#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <unordered_set>

#include "tandem/base/parallel.h"
#include "tandem/compile/build_bvh.h"
#include "tandem/compile/mesh_extent.h"
#include "tandem/compile/prepared_instances.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {

namespace {

Aabb box_of(const PreparedInstances& all, const InstancedMesh& mesh) {
    Aabb box;
    for (std::uint32_t f = 0; f < mesh.face_count; ++f) box = merge(box, bounds(all.faces[mesh.first_face + f]));
    return box;
}

struct Middle {
    Vec3d centre, half;
};
Middle middle_of(const Aabb& box) {
    return {(widen(box.lower) + widen(box.upper)) * 0.5, (widen(box.upper) - widen(box.lower)) * 0.5};
}

/// The half extent of an instance's box in render space, around the placed centre of the mesh.
Vec3d half_of(const MeshInstance& instance, const Middle& of_mesh) {
    const Matrix3& m = instance.render_from_object.linear;
    const auto extent = [&](const Vec3d& row) {
        return std::abs(row.x) * of_mesh.half.x + std::abs(row.y) * of_mesh.half.y + std::abs(row.z) * of_mesh.half.z;
    };
    return {extent(m.row[0]), extent(m.row[1]), extent(m.row[2])};
}

/// The box from middle + lower to middle + upper in render space, with all corners that place_corner() rounds: placing
/// is monotonous up to the rounding of a few doubles.
Aabb box_around(const Vec3d& middle, const Vec3d& lower, const Vec3d& upper) {
    const double size = norm1(middle) + norm1(lower) + norm1(upper);
    const Vec3d spare(0x1p-40 * size);
    return pad({narrow(middle + lower - spare), narrow(middle + upper + spare)},
               static_cast<float>(4 * 0x1p-24 * size + 1e-30));
}
Aabb loose_box(const MeshInstance& instance, const Middle& of_mesh) {
    const Vec3d half = half_of(instance, of_mesh);
    return box_around(transform_point(instance.render_from_object, of_mesh.centre), -half, half);
}
Aabb tight_box(const MeshInstance& instance, const Middle& of_mesh, const MeshExtent& extent) {
    const MeshExtent::Range range = extent.under(instance.render_from_object.linear);
    return box_around(transform_point(instance.render_from_object, of_mesh.centre), range.lower, range.upper);
}

std::span<const Triangle> faces_of(const PreparedInstances& all, const InstancedMesh& mesh) {
    return {all.faces.data() + mesh.first_face, mesh.face_count};
}

/// The data of an instance that the traversal reads. `scene_reach`: at least that of the frame of the instances.
EntryInstance entry_of(const PreparedInstances& all, std::uint32_t number, const Middle& of_mesh, std::int32_t root,
                       double scene_reach) {
    const MeshInstance& instance = all.instances[number];
    const Matrix3 inverse_of = inverse(instance.render_from_object.linear);
    const Vec3d half = half_of(instance, of_mesh);
    EntryInstance entry{};
    for (int i = 0; i < 3; ++i) entry.object_from_render[i] = narrow(inverse_of.row[i]);
    entry.centre = narrow(transform_point(instance.render_from_object, of_mesh.centre));
    entry.radius = instance_radius(std::sqrt(dot(half, half)), scene_reach);
    entry.root = root;
    entry.number = number;
    return entry;
}

double row_norm(const EntryInstance& entry) {
    double norm = 0;
    for (const Vec3f& row : entry.object_from_render) norm = std::max(norm, widen(norm1(row)) * (1 + 1e-6));
    return norm;
}

double reach_of(const Vec3d& half) { return std::max({half.x, half.y, half.z}); }

/// A hierarchy over boxes. `ids`: the number of the box by entry.
Bvh over_boxes(const std::vector<Box>& boxes, const Padding& padding) {
    SceneView scene{};
    scene.boxes = boxes.data();
    scene.box_count = static_cast<std::uint32_t>(boxes.size());
    return build_bvh(scene, padding);
}

/// The boxes of a mesh's faces relative to the centre of the mesh.
std::vector<Box> face_boxes(const PreparedInstances& all, const InstancedMesh& mesh, const Vec3d& centre) {
    std::vector<Box> boxes;
    boxes.reserve(mesh.face_count);
    for (std::uint32_t f = 0; f < mesh.face_count; ++f) {
        const Triangle& face = all.faces[mesh.first_face + f];
        const auto relative = [&](const Vec3f& corner) { return narrow(widen(corner) - centre); };
        const Aabb box = box_around(relative(face.v0), relative(face.v1), relative(face.v2));
        boxes.push_back({box.lower, box.upper});
    }
    return boxes;
}

float margin_of(const PreparedInstances& all, const InstancedMesh& mesh, const Middle& middle, float scene_reach) {
    float margin = 0;
    for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
        const EntryInstance entry = entry_of(all, i, middle, 0, widen(scene_reach));
        margin = std::max(margin,
                          instanced_margin(row_norm(entry), widen(scene_reach), entry.radius, reach_of(middle.half)));
    }
    return margin;
}

/// The numbers of instances that are not copies of an earlier one of the same mesh, and of all with an alpha mask.
std::vector<std::uint32_t> distinct_instances(const PreparedScene& scene) {
    const PreparedInstances& all = scene.instances;
    const SceneView scene_view = view(scene);
    std::vector<std::uint32_t> distinct;
    for (const InstancedMesh& mesh : all.meshes) {
        const bool keeps_copies = has_alpha_mask(scene_view, mesh.material);
        std::unordered_set<std::string> seen;
        for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
            std::string bytes(sizeof(Transform), '\0');
            std::memcpy(bytes.data(), &all.instances[i].render_from_object, sizeof(Transform));
            if (seen.insert(std::move(bytes)).second || keeps_copies) distinct.push_back(i);
        }
    }
    return distinct;
}

}  // namespace

InstancedBvh build_instanced_bvh(const PreparedScene& scene) {
    const PreparedInstances& all = scene.instances;
    const std::vector<std::uint32_t> distinct = distinct_instances(scene);
    std::vector<Middle> middles;
    middles.reserve(all.meshes.size());
    for (const InstancedMesh& mesh : all.meshes) middles.push_back(middle_of(box_of(all, mesh)));
    std::vector<std::size_t> mesh_of;  // by number in `distinct`
    mesh_of.reserve(distinct.size());
    Aabb loose_bounds;
    for (const std::uint32_t i : distinct) {
        std::size_t m = mesh_of.empty() ? 0 : mesh_of.back();
        while (i >= all.meshes[m].first_instance + all.meshes[m].instance_count) ++m;
        mesh_of.push_back(m);
        loose_bounds = merge(loose_bounds, loose_box(all.instances[i], middles[m]));
    }
    // the reach of the tight boxes, which need the hierarchies of the meshes, is not larger
    const float scene_reach = reach(make_structure_frame(loose_bounds).bounds);
    std::vector<Bvh> lower;
    std::vector<MeshExtent> extents;
    lower.reserve(all.meshes.size());
    extents.reserve(all.meshes.size());
    for (std::size_t m = 0; m < all.meshes.size(); ++m) {
        const InstancedMesh& mesh = all.meshes[m];
        lower.push_back(
            over_boxes(face_boxes(all, mesh, middles[m].centre), {margin_of(all, mesh, middles[m], scene_reach)}));
        extents.emplace_back(lower.back(), faces_of(all, mesh), middles[m].centre);
    }
    std::vector<Box> boxes(distinct.size());
    constexpr std::size_t at_once = 1024;
    for_each_chunk(distinct.size(), at_once, [&](const Chunk& chunk) {
        for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
            const Aabb box = tight_box(all.instances[distinct[k]], middles[mesh_of[k]], extents[mesh_of[k]]);
            boxes[k] = {box.lower, box.upper};
        }
    });
    Aabb bounds;
    for (const Box& box : boxes) bounds = merge(bounds, Aabb{box.lower, box.upper});

    InstancedBvh result;
    result.frame = make_structure_frame(bounds, BoxErrors::of_distance);
    Bvh upper = over_boxes(boxes, result.frame.padding);
    result.nodes = std::move(upper.nodes);
    const auto upper_entries = static_cast<std::int32_t>(upper.entry_ids.size());
    std::vector<std::int32_t> roots;
    for (std::size_t m = 0; m < all.meshes.size(); ++m) {
        const auto root = static_cast<std::int32_t>(result.nodes.size());
        const auto first_entry = upper_entries + static_cast<std::int32_t>(result.entry_faces.size());
        for (BvhNode node : lower[m].nodes) {
            node.first_inner += root;
            node.leaf_base -= first_entry;
            result.nodes.push_back(node);
        }
        for (const std::uint32_t id : lower[m].entry_ids) {
            const Triangle& face = all.faces[all.meshes[m].first_face + id];
            result.entry_faces.push_back({face.v0, face.v1, face.v2, id, face.attributes.sides});
        }
        roots.push_back(root);
    }
    result.entry_instances.reserve(upper.entry_ids.size());
    for (const std::uint32_t k : upper.entry_ids) {
        const std::size_t m = mesh_of[k];
        result.entry_instances.push_back(entry_of(all, distinct[k], middles[m], roots[m], widen(scene_reach)));
    }
    return result;
}

namespace {

/// One of the hierarchies by itself: `nodes` from `root` on, whose entries start at `first_entry`.
Bvh alone(const InstancedBvh& all, std::size_t root, std::size_t end, std::size_t first_entry, std::size_t entries) {
    Bvh bvh;
    for (std::size_t i = root; i < end; ++i) {
        BvhNode node = all.nodes[i];
        node.first_inner -= static_cast<std::int32_t>(root);
        node.leaf_base += static_cast<std::int32_t>(first_entry);
        bvh.nodes.push_back(node);
    }
    bvh.entry_spheres.resize(entries);
    bvh.entry_ids.resize(entries);
    return bvh;
}

std::string defect_of(const Bvh& bvh, const std::vector<Box>& boxes, const Padding& padding) {
    SceneView scene{};
    scene.boxes = boxes.data();
    scene.box_count = static_cast<std::uint32_t>(boxes.size());
    return find_bvh_defect(bvh, scene, padding);
}

bool contains(const Box& box, const Vec3f& p) {
    return box.lower.x <= p.x && p.x <= box.upper.x && box.lower.y <= p.y && p.y <= box.upper.y && box.lower.z <= p.z &&
           p.z <= box.upper.z;
}

}  // namespace

std::string find_instanced_bvh_defect(const InstancedBvh& bvh, const PreparedScene& scene) {
    const PreparedInstances& all = scene.instances;
    const std::vector<std::uint32_t> distinct = distinct_instances(scene);
    std::vector<std::size_t> place_of(all.instances.size(), distinct.size());
    for (std::size_t k = 0; k < distinct.size(); ++k) place_of[distinct[k]] = k;
    std::vector<std::int32_t> root_of(all.instances.size(), 0);
    for (const EntryInstance& entry : bvh.entry_instances) root_of[entry.number] = entry.root;
    std::vector<Box> boxes(distinct.size());
    std::size_t first_entry = bvh.entry_instances.size();
    for (std::size_t m = 0; m < all.meshes.size(); ++m) {
        const InstancedMesh& mesh = all.meshes[m];
        const Middle middle = middle_of(box_of(all, mesh));
        // the first of equal instances is in the hierarchy
        const auto root = static_cast<std::size_t>(root_of[mesh.first_instance]);
        const bool is_last = m + 1 == all.meshes.size();
        const auto end =
            is_last ? bvh.nodes.size() : static_cast<std::size_t>(root_of[all.meshes[m + 1].first_instance]);
        const std::size_t entries = mesh.face_count + std::size_t{spare_entries};
        Bvh lower = alone(bvh, root, end, first_entry, entries);
        for (std::size_t e = 0; e < entries; ++e) {
            lower.entry_ids[e] = bvh.entry_faces[first_entry - bvh.entry_instances.size() + e].number;
        }
        const MeshExtent extent(lower, faces_of(all, mesh), middle.centre);
        for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
            if (place_of[i] == distinct.size()) continue;
            const MeshInstance& instance = all.instances[i];
            const Aabb box = tight_box(instance, middle, extent);
            boxes[place_of[i]] = {box.lower, box.upper};
            for (std::uint32_t f = mesh.first_face; f < mesh.first_face + mesh.face_count; ++f) {
                const Triangle face = placed({instance, all.faces[f], mesh.material});
                for (const Vec3f& corner : {face.v0, face.v1, face.v2}) {
                    if (!contains(boxes[place_of[i]], corner)) {
                        return fmt::format("face {} of instance {} sticks out of its box", f - mesh.first_face, i);
                    }
                }
            }
        }
        const float margin = margin_of(all, mesh, middle, reach(bvh.frame.bounds));
        const std::string defect = defect_of(lower, face_boxes(all, mesh, middle.centre), {margin});
        if (!defect.empty()) return fmt::format("mesh {}: {}", m, defect);
        first_entry += entries;
    }
    const auto end = static_cast<std::size_t>(root_of[all.meshes[0].first_instance]);
    Bvh upper = alone(bvh, 0, end, 0, bvh.entry_instances.size());
    for (std::size_t e = 0; e < upper.entry_ids.size(); ++e) {
        upper.entry_ids[e] = static_cast<std::uint32_t>(place_of[bvh.entry_instances[e].number]);
    }
    const std::string defect = defect_of(upper, boxes, bvh.frame.padding);
    return defect.empty() ? defect : "the instances: " + defect;
}

}  // namespace tandem

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <unordered_set>

#include "tandem/compile/build_bvh.h"
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

/// The box of an instance in render space, with all its rounded corners. A corner of a face is inside of the box of the
/// mesh, and placing is monotonous up to the rounding of a few doubles.
Aabb box_of(const MeshInstance& instance, const Middle& of_mesh) {
    const Transform& place = instance.render_from_object;
    const Vec3d middle = transform_point(place, of_mesh.centre);
    const auto extent = [&](const Vec3d& row) {
        return std::abs(row.x) * of_mesh.half.x + std::abs(row.y) * of_mesh.half.y + std::abs(row.z) * of_mesh.half.z;
    };
    const Matrix3& m = place.linear;
    const Vec3d half = {extent(m.row[0]), extent(m.row[1]), extent(m.row[2])};
    const double spare = 0x1p-40 * (norm1(middle) + norm1(half));
    const Vec3d all = half + Vec3d(spare);
    return pad({narrow(middle - all), narrow(middle + all)},
               static_cast<float>(4 * 0x1p-24 * (norm1(middle) + norm1(all)) + 1e-30));
}

double row_norm(const MeshInstance& instance) {
    double norm = 0;
    for (const Vec3f& row : instance.object_from_render) norm = std::max(norm, widen(norm1(row)) * (1 + 1e-6));
    return norm;
}

double reach_of(const Vec3d& half) { return std::max({half.x, half.y, half.z}); }

/// A hierarchy over boxes. `ids`: the number of the box by entry.
Bvh over_boxes(const std::vector<Box>& boxes, float margin) {
    SceneView scene{};
    scene.boxes = boxes.data();
    scene.box_count = static_cast<std::uint32_t>(boxes.size());
    return build_bvh(scene, margin);
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
    double norm = 0;
    for (std::uint32_t i = 0; i < mesh.instance_count; ++i) {
        norm = std::max(norm, row_norm(all.instances[mesh.first_instance + i]));
    }
    return instanced_margin(norm, widen(scene_reach), reach_of(middle.half));
}

/// The numbers of instances that are no copies of an earlier one of the same mesh.
std::vector<std::uint32_t> distinct_instances(const PreparedInstances& all) {
    std::vector<std::uint32_t> distinct;
    for (const InstancedMesh& mesh : all.meshes) {
        std::unordered_set<std::string> seen;
        for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
            std::string bytes(sizeof(Transform), '\0');
            std::memcpy(bytes.data(), &all.instances[i].render_from_object, sizeof(Transform));
            if (seen.insert(std::move(bytes)).second) distinct.push_back(i);
        }
    }
    return distinct;
}

}  // namespace

InstancedBvh build_instanced_bvh(PreparedInstances& all) {
    InstancedBvh result;
    const std::vector<std::uint32_t> distinct = distinct_instances(all);
    std::vector<Middle> middles;
    middles.reserve(all.meshes.size());
    for (const InstancedMesh& mesh : all.meshes) middles.push_back(middle_of(box_of(all, mesh)));
    std::vector<Box> boxes;
    boxes.reserve(distinct.size());
    Aabb bounds;
    std::size_t of_mesh = 0;
    for (const std::uint32_t i : distinct) {
        while (i >= all.meshes[of_mesh].first_instance + all.meshes[of_mesh].instance_count) ++of_mesh;
        const Aabb box = box_of(all.instances[i], middles[of_mesh]);
        boxes.push_back({box.lower, box.upper});
        bounds = merge(bounds, box);
    }
    result.frame = make_structure_frame(bounds);
    const float scene_reach = reach(result.frame.bounds);
    Bvh upper = over_boxes(boxes, result.frame.margin);
    result.nodes = std::move(upper.nodes);
    result.entry_instances.reserve(upper.entry_ids.size());
    for (const std::uint32_t id : upper.entry_ids) result.entry_instances.push_back(distinct[id]);
    const auto upper_entries = static_cast<std::int32_t>(upper.entry_ids.size());
    for (std::size_t m = 0; m < all.meshes.size(); ++m) {
        const InstancedMesh& mesh = all.meshes[m];
        const Bvh lower =
            over_boxes(face_boxes(all, mesh, middles[m].centre), margin_of(all, mesh, middles[m], scene_reach));
        const auto root = static_cast<std::int32_t>(result.nodes.size());
        const auto first_entry = upper_entries + static_cast<std::int32_t>(result.entry_faces.size());
        for (BvhNode node : lower.nodes) {
            node.first_inner += root;
            node.leaf_base -= first_entry;
            result.nodes.push_back(node);
        }
        for (const std::uint32_t id : lower.entry_ids) {
            const Triangle& face = all.faces[mesh.first_face + id];
            result.entry_faces.push_back({face.v0, face.v1, face.v2, id, face.attributes.sides});
        }
        for (std::uint32_t i = 0; i < mesh.instance_count; ++i) {
            MeshInstance& instance = all.instances[mesh.first_instance + i];
            instance.root = root;
            instance.centre = narrow(transform_point(instance.render_from_object, middles[m].centre));
        }
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

std::string defect_of(Bvh bvh, const std::vector<Box>& boxes, float margin) {
    SceneView scene{};
    scene.boxes = boxes.data();
    scene.box_count = static_cast<std::uint32_t>(boxes.size());
    return find_bvh_defect(bvh, scene, margin);
}

bool contains(const Box& box, const Vec3f& p) {
    return box.lower.x <= p.x && p.x <= box.upper.x && box.lower.y <= p.y && p.y <= box.upper.y && box.lower.z <= p.z &&
           p.z <= box.upper.z;
}

}  // namespace

std::string find_instanced_bvh_defect(const InstancedBvh& bvh, const PreparedInstances& all) {
    const std::vector<std::uint32_t> distinct = distinct_instances(all);
    std::vector<std::size_t> place_of(all.instances.size(), distinct.size());
    for (std::size_t k = 0; k < distinct.size(); ++k) place_of[distinct[k]] = k;
    std::vector<Box> boxes(distinct.size());
    std::size_t first_entry = bvh.entry_instances.size();
    for (std::size_t m = 0; m < all.meshes.size(); ++m) {
        const InstancedMesh& mesh = all.meshes[m];
        const Middle middle = middle_of(box_of(all, mesh));
        for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
            if (place_of[i] == distinct.size()) continue;
            const MeshInstance& instance = all.instances[i];
            const Aabb box = box_of(instance, middle);
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
        const auto root = static_cast<std::size_t>(all.instances[mesh.first_instance].root);
        const bool is_last = m + 1 == all.meshes.size();
        const auto end =
            is_last ? bvh.nodes.size() : static_cast<std::size_t>(all.instances[all.meshes[m + 1].first_instance].root);
        const std::size_t entries = mesh.face_count + std::size_t{spare_entries};
        Bvh lower = alone(bvh, root, end, first_entry, entries);
        for (std::size_t e = 0; e < entries; ++e) {
            lower.entry_ids[e] = bvh.entry_faces[first_entry - bvh.entry_instances.size() + e].number;
        }
        const float margin = margin_of(all, mesh, middle, reach(bvh.frame.bounds));
        const std::string defect = defect_of(std::move(lower), face_boxes(all, mesh, middle.centre), margin);
        if (!defect.empty()) return fmt::format("mesh {}: {}", m, defect);
        first_entry += entries;
    }
    const auto end = static_cast<std::size_t>(all.instances[all.meshes[0].first_instance].root);
    Bvh upper = alone(bvh, 0, end, 0, bvh.entry_instances.size());
    for (std::size_t e = 0; e < upper.entry_ids.size(); ++e) {
        upper.entry_ids[e] = static_cast<std::uint32_t>(place_of[bvh.entry_instances[e]]);
    }
    const std::string defect = defect_of(std::move(upper), boxes, bvh.frame.margin);
    return defect.empty() ? defect : "the instances: " + defect;
}

}  // namespace tandem

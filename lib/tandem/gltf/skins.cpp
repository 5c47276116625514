#include "tandem/gltf/skins.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/accessor.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/mesh_topology.h"
#include "tandem/scene/normal_matrix.h"

namespace tandem::gltf {

namespace {

/// A set of four joints and their weights for each vertex; attributes JOINTS_n and WEIGHTS_n.
struct Influences {
    std::vector<float> joints, weights;
};

Transform operator*(const Transform& transform, double weight) {
    Transform result = transform;
    for (Vec3d& row : result.linear.row) row *= weight;
    result.translation *= weight;
    return result;
}

void add(Transform& sum, const Transform& term) {
    for (int i = 0; i < 3; ++i) sum.linear.row[i] += term.linear.row[i];
    sum.translation += term.translation;
}

class Poser {
  public:
    Poser(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of,
          const GeometryReader& geometry, Scene& scene, ImportReport& report, FlawLog& flaws)
        : source_(source),
          json_(source.document.json),
          node_of_(node_of),
          geometry_(geometry),
          scene_(scene),
          report_(report),
          flaws_(flaws),
          budget_(source) {}

    void run() {
        const Json* nodes = find(json_, "nodes");
        for (std::size_t i = 0; nodes != nullptr && i < nodes->size(); ++i) {
            const Json* skin = find((*nodes)[i], "skin");
            if (skin == nullptr || !node_of_[i]) continue;
            const std::string path = fmt::format("nodes[{}].skin", i);
            if (find((*nodes)[i], "mesh") == nullptr) {
                report_.add(Treatment::ignored, "skin", path, "the node has no mesh");
                continue;
            }
            pose_node(*node_of_[i], skin->get<std::size_t>(), path);
        }
    }

  private:
    void pose_node(std::uint32_t index, std::size_t skin, const std::string& path) {
        std::vector<Geometry> stays, follows;
        for (Geometry& geometry : scene_.nodes[index].geometry) {
            const bool posed = pose(geometry, skin, path);
            (posed ? follows : stays).push_back(std::move(geometry));
        }
        scene_.nodes[index].geometry = std::move(stays);
        if (follows.empty()) return;
        report_.add(Treatment::approximated, "skin", path,
                    "posed by its joints at rest; animation does not deform the mesh yet");
        Node root{.name = scene_.nodes[index].name};
        root.geometry = std::move(follows);
        scene_.nodes.push_back(std::move(root));
    }

    /// Gives the geometry a mesh posed by the joints; false if it stays as it is.
    bool pose(Geometry& geometry, std::size_t skin, const std::string& path) {
        auto* shape = std::get_if<MeshShape>(&geometry.shape);
        if (shape == nullptr) return false;
        const auto [known, is_new] = posed_.try_emplace({shape->mesh, skin}, std::nullopt);
        if (is_new) {
            try {
                known->second = pose_mesh(shape->mesh, skin);
                if (!known->second) {
                    report_.add(Treatment::ignored, "skin", path, "the mesh has no JOINTS_0 and WEIGHTS_0");
                }
            } catch (const Flaw& flaw) {
                flaws_.leave_out("skin", flaw);
            }
        }
        if (!known->second) return false;
        shape->mesh = *known->second;
        geometry.instances.clear();
        return true;
    }

    /// Index of the posed mesh in the scene; empty if the primitive has no joints.
    std::optional<std::uint32_t> pose_mesh(std::uint32_t index, std::size_t skin) {
        const GeometryReader::Origin& origin = geometry_.origin_of(index);
        const auto [mesh_number, number] = origin.primitive;
        const Json& primitive = json_["meshes"][mesh_number]["primitives"][number];
        const std::string path = fmt::format("meshes[{}].primitives[{}]", mesh_number, number);
        const std::size_t vertices = scene_.meshes[index].positions.size();
        const std::vector<Influences> influences =
            read_influences(primitive, path, vertices, origin.elements ? &*origin.elements : nullptr);
        if (influences.empty()) return std::nullopt;
        const std::vector<Transform> joints = world_from_mesh(skin);
        Mesh posed = scene_.meshes[index];
        for (std::size_t i = 0; i < vertices; ++i) {
            const Transform transform = blend(influences, joints, i, path);
            posed.positions[i] = narrow(transform_point(transform, widen(posed.positions[i])));
            if (posed.normals.empty()) continue;
            posed.normals[i] = narrow(normalize(normal_matrix(transform.linear) * widen(posed.normals[i])));
        }
        posed.is_closed = posed.is_closed && is_closed(posed);
        scene_.meshes.push_back(std::move(posed));
        return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
    }

    std::vector<Influences> read_influences(const Json& primitive, const std::string& path, std::size_t vertices,
                                            const std::vector<std::uint32_t>* elements) {
        std::vector<Influences> sets;
        const Json& attributes = primitive["attributes"];
        for (std::size_t set = 0;; ++set) {
            const Json* joints = find(attributes, fmt::format("JOINTS_{}", set).c_str());
            const Json* weights = find(attributes, fmt::format("WEIGHTS_{}", set).c_str());
            if (joints == nullptr || weights == nullptr) return sets;
            const auto read = [&](const Json& accessor, Components components, const char* what) {
                const std::string where = fmt::format("{}.attributes.{}_{}", path, what, set);
                budget_.spend(source_.document, where, 4 * vertices);
                const std::size_t count = element_count(source_, accessor.get<std::size_t>());
                const std::size_t positions = element_count(source_, attributes["POSITION"].get<std::size_t>());
                if (count != positions) {
                    source_.document.fail(
                        where, fmt::format("has {} elements, but POSITION has {}; make them equal", count, positions));
                }
                AccessorNeed need = {"VEC4", components, "a skinned mesh", where};
                need.elements = elements;
                return read_accessor(source_, accessor.get<std::size_t>(), need);
            };
            sets.push_back(
                {read(*joints, Components::quantised, "JOINTS"), read(*weights, Components::normalised, "WEIGHTS")});
        }
    }

    /// The transforms of the skin's joints.
    std::vector<Transform> world_from_mesh(std::size_t skin) {
        if (world_from_node_.empty()) world_from_node_ = world_from_nodes(scene_, 0);
        const Json& described = json_["skins"][skin];
        const std::string path = fmt::format("skins[{}]", skin);
        const Json& joints = described["joints"];
        const std::vector<Transform> inverse_bind = inverse_bind_matrices(described, joints.size(), path);
        std::vector<Transform> result;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const auto joint = joints[i].get<std::size_t>();
            if (!node_of_[joint]) {
                source_.document.fail(fmt::format("{}.joints[{}]", path, i),
                                      "is a node outside of the scene; add the joints to the scene");
            }
            result.push_back(world_from_node_[*node_of_[joint]] * inverse_bind[i]);
        }
        return result;
    }

    std::vector<Transform> inverse_bind_matrices(const Json& skin, std::size_t count, const std::string& path) {
        std::vector<Transform> result(count);
        const Json* accessor = find(skin, "inverseBindMatrices");
        if (accessor == nullptr) return result;
        const std::string where = path + ".inverseBindMatrices";
        budget_.spend(source_.document, where, 16 * count);
        const std::vector<float> m = read_accessor(source_, accessor->get<std::size_t>(),
                                                   {"MAT4", Components::floats, "the joints of a skin", where});
        if (m.size() < 16 * count) {
            source_.document.fail(
                where, fmt::format("has {} matrices for {} joints; it needs one per joint", m.size() / 16, count));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto at = [&](std::size_t column, std::size_t row) { return double{m[16 * i + 4 * column + row]}; };
            for (std::size_t row = 0; row < 3; ++row) {
                result[i].linear.row[row] = {at(0, row), at(1, row), at(2, row)};
            }
            result[i].translation = {at(3, 0), at(3, 1), at(3, 2)};
        }
        return result;
    }

    /// Linear blend skinning. Weights are normalised by their sum; a vertex without weights follows its first joint.
    Transform blend(const std::vector<Influences>& influences, const std::vector<Transform>& joints, std::size_t vertex,
                    const std::string& path) const {
        double total = 0;
        for (const Influences& set : influences) {
            for (std::size_t k = 0; k < 4; ++k) total += double{set.weights[4 * vertex + k]};
        }
        Transform sum{{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {0, 0, 0}};
        for (const Influences& set : influences) {
            for (std::size_t k = 0; k < 4; ++k) {
                const double weight = double{set.weights[4 * vertex + k]};
                if (weight == 0 && total > 0) continue;
                const float joint = set.joints[4 * vertex + k];
                if (!(joint >= 0 && joint < static_cast<float>(joints.size()))) {
                    source_.document.fail(path + ".attributes", fmt::format("vertex {} follows joint {}, but the skin "
                                                                            "has {}",
                                                                            vertex, joint, joints.size()));
                }
                if (!(total > 0)) return joints[static_cast<std::size_t>(joint)];
                add(sum, joints[static_cast<std::size_t>(joint)] * (weight / total));
            }
        }
        return sum;
    }

    const Source& source_;
    const Json& json_;
    const std::vector<std::optional<std::uint32_t>>& node_of_;
    const GeometryReader& geometry_;
    Scene& scene_;
    ImportReport& report_;
    FlawLog& flaws_;
    Budget budget_;
    std::vector<Transform> world_from_node_;                                               ///< at rest
    std::map<std::pair<std::uint32_t, std::size_t>, std::optional<std::uint32_t>> posed_;  ///< by mesh and skin
};

}  // namespace

void pose_skins(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of,
                const GeometryReader& geometry, Scene& scene, ImportReport& report, FlawLog& flaws) {
    Poser(source, node_of, geometry, scene, report, flaws).run();
}

}  // namespace tandem::gltf

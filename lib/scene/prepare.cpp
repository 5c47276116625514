#include "tandem/scene/prepare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tandem/error/error.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/place_mesh.h"

namespace tandem {

namespace {

/// Relative deviation up to which a linear map counts as a rotation times one scale. A unit quaternion read from a
/// file gives 1e-16; the deviation moves a surface by far less than the rounding of its centre to float.
constexpr double similarity_tolerance = 1e-12;

/// The factor by which `m` scales all lengths, or 0 if it does not scale all alike.
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

/// A unit body under world_from_object.
Placement place(const Transform& world_from_object, bool is_box) {
    const Matrix3& m = world_from_object.linear;
    Placement placement;
    placement.object_from_world = inverse(m);
    placement.centre = world_from_object.translation;
    const auto extent = [&](const Vec3d& row) {
        // support of the body along a world axis: l1 norm for the cube, l2 for the ball
        const double support = is_box ? norm1(row) : std::sqrt(dot(row, row));
        return support * (1 + 1e-15);
    };
    placement.half_extent = {extent(m.row[0]), extent(m.row[1]), extent(m.row[2])};
    const Vec3f centre = narrow(placement.centre);
    const Vec3d moved = placement.centre - widen(centre);
    // the body's farthest point from its centre, and what rounding the centre moved it
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

class Preparer {
  public:
    Preparer(const Scene& scene, const PrepareOptions& options) : scene_(scene), options_(options) {}

    PreparedScene run() {
        world_from_node_ = world_transforms();
        for (const Material& material : scene_.materials) result_.materials.push_back(material.phong);
        result_.environment = scene_.environment;
        std::size_t count = 0;
        for (const Node& node : scene_.nodes) {
            for (const Geometry& geometry : node.geometry) {
                count += primitives_in(geometry.shape) * std::max<std::size_t>(1, geometry.instances.size());
            }
        }
        if (count >= no_primitive_limit) {
            throw InputError(
                fmt::format("the scene has {} primitives, over the limit of {}", count, no_primitive_limit));
        }
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) add_node(i);
        join_kinds();
        choose_camera();
        return std::move(result_);
    }

  private:
    static constexpr std::size_t no_primitive_limit = std::size_t{1} << 30;

    std::vector<Transform> world_transforms() const {
        const std::vector<Transform> local = parents_from_nodes(scene_, time_of_frame(scene_, options_.frame));
        std::vector<Transform> world(local.size());
        std::vector<bool> known(local.size(), false);
        std::vector<std::size_t> chain;
        for (std::size_t i = 0; i < local.size(); ++i) {
            for (std::size_t at = i; !known[at];) {  // climb to a known ancestor, then come back down
                chain.push_back(at);
                if (scene_.nodes[at].parent == Node::no_parent) break;
                at = static_cast<std::size_t>(scene_.nodes[at].parent);
            }
            for (; !chain.empty(); chain.pop_back()) {
                const std::size_t at = chain.back();
                const std::int32_t parent = scene_.nodes[at].parent;
                world[at] = parent == Node::no_parent ? local[at] : world[static_cast<std::size_t>(parent)] * local[at];
                known[at] = true;
            }
        }
        return world;
    }

    void add_node(std::size_t index) {
        const Node& node = scene_.nodes[index];
        const Transform& world_from_node = world_from_node_[index];
        for (const Geometry& geometry : node.geometry) {
            if (geometry.instances.empty()) add_primitive(geometry, world_from_node, index);
            for (const Trs& node_from_instance : geometry.instances) {
                add_primitive(geometry, world_from_node * to_transform(node_from_instance), index);
            }
        }
        if (node.light) {
            const PointLight light = {narrow(world_from_node.translation), node.light->colour * node.light->intensity};
            check_reach(Aabb{light.position, light.position}, index);
            result_.lights.push_back(light);
        }
    }

    void add_primitive(const Geometry& geometry, const Transform& world_from_object, std::size_t node) {
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
        const bool double_sided = scene_.materials[material].double_sided;
        const PlacedMesh placed = place_mesh(scene_.meshes[shape.mesh], world_from_object, double_sided, result_);
        if (!is_empty(placed.bounds)) check_reach(placed.bounds, node);
        triangles_.add(material, node, placed.triangles);
        quads_.add(material, node, placed.quads);
    }

    void add_sphere(const SphereShape& shape, std::uint32_t material, const Transform& world_from_object,
                    std::size_t node) {
        const double scale = uniform_scale(world_from_object.linear);
        if (scale > 0) {
            const Sphere sphere = {narrow(world_from_object.translation), narrow(scale * shape.radius)};
            if (!(sphere.radius > 0)) fail(node, "a sphere whose radius vanishes in float under the node's scale");
            check_reach(bounds(sphere), node);
            result_.spheres.push_back(sphere);
            spheres_.add(material, node);
            return;
        }
        const double r = shape.radius;
        add_placement(world_from_object, {r, r, r}, false, material, node);
    }

    void add_box(const BoxShape& shape, std::uint32_t material, const Transform& world_from_object, std::size_t node) {
        const Vec3d half = shape.size * 0.5;
        const Matrix3& m = world_from_object.linear;
        if (is_diagonal(m)) {
            const Vec3d extent = {std::abs(m.row[0].x) * half.x, std::abs(m.row[1].y) * half.y,
                                  std::abs(m.row[2].z) * half.z};
            const Vec3d& c = world_from_object.translation;
            const Box box = {narrow(c - extent), narrow(c + extent)};
            check_reach(bounds(box), node);
            result_.boxes.push_back(box);
            boxes_.add(material, node);
            return;
        }
        add_placement(world_from_object, half, true, material, node);
    }

    /// `size`: scale from the unit body to the shape.
    void add_placement(const Transform& world_from_object, const Vec3d& size, bool is_box, std::uint32_t material,
                       std::size_t node) {
        Transform world_from_unit = world_from_object;
        for (Vec3d& row : world_from_unit.linear.row) row = row * size;
        const double volume = std::abs(determinant(world_from_unit.linear));
        const Matrix3& m = world_from_unit.linear;
        const double lengths = std::sqrt(dot(m.row[0], m.row[0]) * dot(m.row[1], m.row[1]) * dot(m.row[2], m.row[2]));
        // below this the inverse has no digits left; a NaN fails as well
        if (!(volume > 1e-12 * lengths) || !std::isnormal(volume)) {
            fail(node, is_box ? "a rotated or sheared box that is flat; give it thickness"
                              : "a sphere that its transform flattens");
        }
        const Placement placement = place(world_from_unit, is_box);
        check_reach(bounds(placement), node);
        if (is_box) {
            result_.parallelepipeds.push_back({placement});
        } else {
            result_.ellipsoids.push_back({placement});
        }
        (is_box ? parallelepipeds_ : ellipsoids_).add(material, node);
    }

    void check_reach(const Aabb& box, std::size_t node) const {
        if (!(reach(box) <= coordinate_limit)) fail(node, "something farther than 1e18 from the origin");
    }

    [[noreturn]] void fail(std::size_t node, const std::string& what) const {
        const std::string& name = scene_.nodes[node].name;
        throw InputError(fmt::format("node {}{} has {}", node, name.empty() ? "" : " '" + name + "'", what));
    }

    void join_kinds() {
        const auto join = [this](const Origin& origin) {
            result_.material_of.insert(result_.material_of.end(), origin.material.begin(), origin.material.end());
            result_.node_of.insert(result_.node_of.end(), origin.node.begin(), origin.node.end());
        };
#define TANDEM_PRIMITIVE(Type, name, names) join(names##_);
#include "tandem/scene/primitives.def"
#undef TANDEM_PRIMITIVE
    }

    void choose_camera() {
        std::string cameras;
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& node = scene_.nodes[i];
            if (!node.camera) continue;
            cameras += (cameras.empty() ? "'" : ", '") + node.name + "'";
            if (!options_.camera.empty() && node.name != options_.camera) continue;
            set_camera(*node.camera, i);
            return;
        }
        if (options_.camera.empty()) throw InputError("the scene has no camera; add a node with one");
        throw InputError(fmt::format("the scene has no camera '{}'; it has {}", options_.camera,
                                     cameras.empty() ? "none" : cameras));
    }

    /// A camera looks along its node; scale does not change what it sees (glTF 2.0, 3.10).
    void set_camera(const Camera& camera, std::size_t node) {
        const Transform& world_from_node = world_from_node_[node];
        const Matrix3 axes = transpose(world_from_node.linear);
        const double handedness = determinant(world_from_node.linear);
        if (handedness == 0 || !std::isfinite(handedness))
            fail(node, "a camera under a transform that is not invertible");
        const Vec3d backward = normalize(axes.row[2]);
        const Vec3d right = normalize(cross(axes.row[1], backward)) * (handedness < 0 ? -1.0 : 1.0);
        const Vec3d up = normalize(cross(backward, right)) * (handedness < 0 ? -1.0 : 1.0);
        const Vec3f eye = narrow(world_from_node.translation);
        check_reach(Aabb{eye, eye}, node);
        result_.world_from_camera = {transpose({{right, up, backward}}), world_from_node.translation};
        if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
            result_.half_height = std::tan(perspective->yfov / 2);
        } else {
            result_.orthographic = true;
            result_.half_height = std::get<OrthographicCamera>(camera).ymag;
        }
    }

    /// Material and node of the primitives of one kind.
    struct Origin {
        std::vector<std::uint32_t> material;
        std::vector<std::uint32_t> node;
        void add(std::uint32_t m, std::size_t n, std::size_t count = 1) {
            material.insert(material.end(), count, m);
            node.insert(node.end(), count, static_cast<std::uint32_t>(n));
        }
    };

    const Scene& scene_;
    const PrepareOptions& options_;
    std::vector<Transform> world_from_node_;
#define TANDEM_PRIMITIVE(Type, name, names) Origin names##_;
#include "tandem/scene/primitives.def"
#undef TANDEM_PRIMITIVE
    PreparedScene result_;
};

}  // namespace

PreparedScene prepare(const Scene& scene, const PrepareOptions& options) {
    const std::vector<std::string> problems = validate(scene);
    if (!problems.empty()) throw InputError(fmt::format("the scene is not valid: {}", fmt::join(problems, "; ")));
    return Preparer(scene, options).run();
}

}  // namespace tandem

#include "tandem/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tandem/base/parallel.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/ray.h"
#include "tandem/scene/light_cone.h"
#include "tandem/scene/texture_problems.h"

namespace tandem {

namespace {

std::string node_label(const Scene& scene, std::size_t index) {
    const std::string& name = scene.nodes[index].name;
    return name.empty() ? fmt::format("node {}", index) : fmt::format("node '{}'", name);
}

bool is_number(double a) { return std::abs(a) <= coordinate_limit; }  // which a NaN is not
bool is_number(const Vec3d& a) { return is_number(a.x) && is_number(a.y) && is_number(a.z); }
bool is_number(const Quaternion& q) { return is_number(q.x) && is_number(q.y) && is_number(q.z) && is_number(q.w); }
/// Whether all three numbers are in [0, 1].
bool is_share(const Vec3f& a) {
    const auto good = [](float x) { return x >= 0 && x <= 1; };
    return good(a.x) && good(a.y) && good(a.z);
}
bool is_zero(const Quaternion& q) { return q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0; }

bool is_good(const Trs& trs) {
    return is_number(trs.translation) && is_number(trs.scale) && is_number(trs.rotation) && !is_zero(trs.rotation);
}

/// Collects the problems, one sentence each.
class Problems {
  public:
    explicit Problems(const Scene& scene) : scene_(scene) {}

    void require(bool condition, const std::string& where, const char* what) {
        if (!condition) found_.push_back(where + " " + what);
    }

    void check_trs(const Trs& trs, const std::string& where) {
        if (is_good(trs)) return;
        require(is_number(trs.translation), where, "has a translation that is not finite or beyond 1e18");
        require(is_number(trs.scale), where, "has a scale that is not finite or beyond 1e18");
        require(is_number(trs.rotation), where, "has a rotation that is not finite");
        require(!is_zero(trs.rotation), where,
                "has the rotation (0, 0, 0, 0), which is not a rotation; use (0, 0, 0, 1)");
    }

    void check_node(std::size_t index) {
        const Node& node = scene_.nodes[index];
        const std::string where = node_label(scene_, index);
        check_trs(node.trs, where);
        if (node.matrix) {
            bool finite = is_number(node.matrix->translation);
            for (const Vec3d& row : node.matrix->linear.row) finite = finite && is_number(row);
            require(finite, where, "has a matrix that is not finite");
        }
        for (const Geometry& geometry : node.geometry) check_geometry(geometry, where);
        if (node.camera) check_camera(*node.camera, where);
        if (node.light) {
            const Vec3f c = node.light->colour;
            const float i = node.light->intensity;
            require(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && c.x >= 0 && c.y >= 0 && c.z >= 0,
                    where, "has a light whose colour is not three finite numbers >= 0");
            require(std::isfinite(i) && i >= 0, where, "has a light whose intensity is not a finite number >= 0");
            const auto overflows = [i](float colour) { return std::isfinite(colour) && std::isinf(colour * i); };
            require(!std::isfinite(i) || !(overflows(c.x) || overflows(c.y) || overflows(c.z)), where,
                    "has a light whose colour times intensity is beyond 3.4e38");
            require(node.light->kind != LightKind::spot ||
                        (node.light->inner_cone >= 0 && node.light->inner_cone < node.light->outer_cone &&
                         node.light->outer_cone <= 1.5707963267948967),
                    where, "has a spot light whose angles are not 0 <= inner < outer <= pi / 2");
            require(node.light->kind != LightKind::spot ||
                        std::isfinite(light_cone(node.light->inner_cone, node.light->outer_cone).scale),
                    where,
                    "has a spot light whose cone is narrower than 1e-150 rad, or whose two angles are too close to "
                    "each other");
        }
    }

    /// Finds cycles of parents, in time linear in the number of nodes.
    void check_hierarchy() {
        const std::vector<Node>& nodes = scene_.nodes;
        const auto has_parent = [&](std::size_t i) {
            return nodes[i].parent >= 0 && static_cast<std::size_t>(nodes[i].parent) < nodes.size();
        };
        // a walk upwards that reaches itself is a cycle; one that reaches an earlier walk can stop
        std::vector<std::size_t> walk_of(nodes.size(), nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            require(nodes[i].parent == Node::no_parent || has_parent(i), node_label(scene_, i),
                    "has a parent that does not exist");
            std::size_t at = i;
            while (walk_of[at] == nodes.size()) {
                walk_of[at] = i;
                if (!has_parent(at)) break;
                at = static_cast<std::size_t>(nodes[at].parent);
                require(walk_of[at] != i, node_label(scene_, at), "is its own ancestor");
            }
        }
    }

    void check_material(std::size_t index) {
        const Material& material = scene_.materials[index];
        const std::string where =
            material.name.empty() ? fmt::format("material {}", index) : fmt::format("material '{}'", material.name);
        require(is_share(material.phong.ambient), where, "has an ambient reflectance outside [0, 1]");
        require(is_share(material.phong.diffuse), where, "has a diffuse reflectance outside [0, 1]");
        require(is_share(material.phong.specular), where, "has a specular reflectance outside [0, 1]");
        require(material.phong.shininess >= 0 && material.phong.shininess <= 1e8F, where,
                "has a shininess outside [0, 1e8]");
        const Optics& optics = material.optics;
        require(is_share(optics.mirror), where, "has a mirror reflectance outside [0, 1]");
        require(optics.transmission >= 0 && optics.transmission <= 1, where, "has a transmission outside [0, 1]");
        require(optics.ior >= 1e-3F && optics.ior <= 1e3F, where, "has a refractive index outside [0.001, 1000]");
        const auto positive = [](float a) { return a >= 0 && std::isfinite(a); };
        require(positive(optics.absorption.x) && positive(optics.absorption.y) && positive(optics.absorption.z), where,
                "has an absorption that is not three finite numbers >= 0");
        require(positive(optics.emission.x) && positive(optics.emission.y) && positive(optics.emission.z), where,
                "has an emission that is not three finite numbers >= 0");
        require(optics.priority <= 127, where, "has a dielectric priority above 127");
        const bool scatters_alone = optics.transmission == 0 && optics.mirror == Vec3f{0, 0, 0};
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is)                                \
    if (material.name) {                                                                  \
        check_numbers(*material.name, where, is);                                         \
        require(!Type::is_opaque || scatters_alone, where,                                \
                "has " is " and is also a dielectric or a mirror; use one or the other"); \
    }
#include "tandem/kernel/bsdf/lobes.def"
    }

    /// `is`: the part, in words.
    template <class Part>
    void check_numbers(const Part& part, const std::string& where, const char* is) {
        const auto is_between = [](float least, const Vec3f& value, float most) {
            return value.x >= least && value.y >= least && value.z >= least && value.x <= most && value.y <= most &&
                   value.z <= most;
        };
        Part::visit_numbers(part, [&](const char* number, const auto& value, float least, float most) {
            bool good = false;
            if constexpr (std::is_same_v<decltype(value), const float&>) {
                good = value >= least && value <= most;
            } else {
                good = is_between(least, value, most);
            }
            if (good) return;
            found_.push_back(fmt::format("{} has {} whose {} is outside [{:g}, {:g}]", where, is, number, least, most));
        });
    }

    void check_mesh(std::size_t index) {
        const Mesh& mesh = scene_.meshes[index];
        const std::string where =
            mesh.name.empty() ? fmt::format("mesh {}", index) : fmt::format("mesh '{}'", mesh.name);
        const std::size_t vertices = mesh.positions.size();
        const auto all_numbers = [](const std::vector<Vec3f>& vectors) {
            return std::all_of(vectors.begin(), vectors.end(), [](const Vec3f& v) { return is_number(widen(v)); });
        };
        require(all_numbers(mesh.positions), where, "has a position that is not finite or beyond 1e18");
        require(mesh.normals.empty() || mesh.normals.size() == vertices, where,
                "does not have one normal per position");
        require(all_numbers(mesh.normals), where, "has a normal that is not finite or beyond 1e18");
        for (const std::vector<Vec2f>& set : mesh.texcoords) {
            require(set.empty() || set.size() == vertices, where, "does not have one texture coordinate per position");
            require(std::all_of(set.begin(), set.end(),
                                [](const Vec2f& v) { return std::isfinite(v.x) && std::isfinite(v.y); }),
                    where, "has a texture coordinate that is not finite");
        }
        require(mesh.colours.empty() || mesh.colours.size() == vertices, where,
                "does not have one colour per position");
        require(std::all_of(mesh.colours.begin(), mesh.colours.end(),
                            [](const VertexColour& c) { return is_share(c.rgb) && c.alpha >= 0 && c.alpha <= 1; }),
                where, "has a vertex colour outside [0, 1]");
        require(mesh.triangles.size() % 3 == 0, where, "has triangle indices whose number is not a multiple of 3");
        require(mesh.quads.size() % 4 == 0, where, "has quad indices whose number is not a multiple of 4");
        for (const auto* indices : {&mesh.triangles, &mesh.quads}) {
            const auto bad =
                std::find_if(indices->begin(), indices->end(), [&](std::uint32_t i) { return i >= vertices; });
            if (bad == indices->end()) continue;
            found_.push_back(fmt::format("{} has a face with vertex {}, but {} positions", where, *bad, vertices));
        }
    }

    void check_channel(std::size_t index) {
        const AnimationChannel& channel = scene_.animation[index];
        std::string where = fmt::format("animation channel {}", index);
        if (channel.node >= scene_.nodes.size()) {
            require(false, where, "drives a node that does not exist");
            return;
        }
        where += " of " + node_label(scene_, channel.node);
        require(!scene_.nodes[channel.node].matrix, where,
                "drives a node that has a matrix; give it translation, rotation and scale instead");
        require(!channel.times.empty(), where, "has no keys");
        bool increasing = true;
        for (std::size_t k = 0; k < channel.times.size(); ++k) {
            increasing = increasing && std::isfinite(channel.times[k]) && channel.times[k] >= 0 &&
                         (k == 0 || channel.times[k - 1] < channel.times[k]);
        }
        require(increasing, where, "has key times that are not finite, or negative, or not strictly increasing");
        const std::size_t width = channel.path == AnimatedPath::rotation ? 4 : 3;
        const std::size_t groups = channel.interpolation == Interpolation::cubic ? 3 : 1;
        require(channel.values.size() == width * groups * channel.times.size(), where,
                "does not have the number of values that its keys need");
        require(std::all_of(channel.values.begin(), channel.values.end(), [](float v) { return is_number(double{v}); }),
                where, "has values that are not finite");
        if (channel.path == AnimatedPath::rotation) check_rotation_keys(channel, width * groups, where);
    }

    void check_environment() {
        const auto good = [](const Vec3f& a) {
            const auto value = [](float x) { return std::isfinite(x) && x >= 0; };
            return value(a.x) && value(a.y) && value(a.z);
        };
        require(good(scene_.environment.bottom) && good(scene_.environment.top) && good(scene_.environment.ambient),
                "the environment", "has a colour that is not three finite numbers >= 0");
        const auto requires_of = [this](bool condition, const std::string& where, const std::string& problem) {
            require(condition, where, problem.c_str());
        };
        int environments = 0;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    if (scene_.authored) {                                            \
        check(*scene_.authored, requires_of);                         \
        ++environments;                                               \
    }
#include "tandem/kernel/lights/lights.def"
        require(environments <= 1, "the scene", "has several environments; keep one");
        require(std::isfinite(scene_.frames_per_second) && scene_.frames_per_second > 0, "the scene",
                "has a frame rate that is not positive");
    }

    std::vector<std::string> take() { return std::move(found_); }

  private:
    /// `stride`: numbers per key. The middle one of the three groups of a cubic key is the value.
    void check_rotation_keys(const AnimationChannel& channel, std::size_t stride, const std::string& where) {
        const std::size_t first = channel.interpolation == Interpolation::cubic ? 4 : 0;
        bool none_vanishes = true;
        for (std::size_t at = first; at + 4 <= channel.values.size(); at += stride) {
            const float* q = &channel.values[at];
            none_vanishes = none_vanishes && (q[0] != 0 || q[1] != 0 || q[2] != 0 || q[3] != 0);
        }
        require(none_vanishes, where,
                "has a key with the rotation (0, 0, 0, 0), which is not a rotation; use (0, 0, 0, 1)");
    }

    void check_geometry(const Geometry& geometry, const std::string& where) {
        require(geometry.material < scene_.materials.size(), where, "uses a material that does not exist");
        if (const auto* sphere = std::get_if<SphereShape>(&geometry.shape)) {
            require(is_number(sphere->radius) && sphere->radius > 0, where,
                    "has a sphere whose radius is not above 0 and up to 1e18");
        } else if (const auto* box = std::get_if<BoxShape>(&geometry.shape)) {
            const Vec3d& size = box->size;
            require(is_number(size) && size.x >= 0 && size.y >= 0 && size.z >= 0, where,
                    "has a box whose size is not three numbers from 0 to 1e18");
        } else {
            require(std::get<MeshShape>(geometry.shape).mesh < scene_.meshes.size(), where,
                    "shows a mesh that does not exist");
        }
        check_instances(geometry.instances, where);
    }

    /// Makes no names for valid instances, of which there may be millions.
    void check_instances(const std::vector<Trs>& instances, const std::string& where) {
        std::vector<std::vector<std::size_t>> bad(chunk_count(instances.size(), instances_at_once));
        for_each_chunk(instances.size(), instances_at_once, [&](const Chunk& chunk) {
            for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
                if (!is_good(instances[i])) bad[chunk.number].push_back(i);
            }
        });
        for (const std::vector<std::size_t>& numbers : bad) {
            for (const std::size_t i : numbers) {
                check_trs(instances[i], fmt::format("{}, instance {},", where, i));
            }
        }
    }

    void check_camera(const Camera& camera, const std::string& where) {
        const Shutter& shutter = shutter_of(camera);
        require(is_number(shutter.open) && is_number(shutter.close), where,
                "has a shutter that opens or closes at a time that is not finite or beyond 1e18");
        require(!(shutter.close < shutter.open), where, "has a shutter that closes before it opens");
        require(shutter.instants >= 1 && shutter.instants <= 1024, where,
                "has a shutter whose number of instants is not from 1 to 1024");
        if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
            require(perspective->yfov > 0 && perspective->yfov < 3.14159, where,
                    "has a camera whose vertical field of view is not between 0 and pi");
            const Lens& lens = perspective->lens;
            require(is_number(lens.aperture_radius) && lens.aperture_radius >= 0, where,
                    "has a lens whose aperture radius is not from 0 to 1e18");
            require(is_number(lens.focus_distance) && lens.focus_distance > 0, where,
                    "has a lens whose focus distance is not above 0 and up to 1e18");
            require(lens.blades == 0 || (lens.blades >= 3 && lens.blades <= 32), where,
                    "has a lens whose number of blades is neither 0 nor from 3 to 32");
            require(is_number(lens.rotation), where, "has a lens whose rotation is not a number");
        } else {
            const double ymag = std::get<OrthographicCamera>(camera).ymag;
            require(is_number(ymag) && ymag > 0, where,
                    "has an orthographic camera whose ymag is not above 0 and up to 1e18");
        }
    }

    static constexpr std::size_t instances_at_once = 1U << 16;

    const Scene& scene_;
    std::vector<std::string> found_;
};

}  // namespace

bool has_environment(const Scene& scene) {
    bool has = false;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) has = has || scene.authored.has_value();
#include "tandem/kernel/lights/lights.def"
    return has;
}

namespace {

/// Leaves the scene without light from all directions. Not inlined: g++ 14 would warn that the environment assigned
/// afterwards replaces one that is not initialised.
[[gnu::noinline]] void remove_environment(Scene& scene) {
    scene.environment.ambient = {0, 0, 0};
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) scene.authored.reset();
#include "tandem/kernel/lights/lights.def"
}

}  // namespace

#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    void light_by(Scene& scene, Authored environment) {               \
        remove_environment(scene);                                    \
        scene.authored = std::move(environment);                      \
        scene.environment.illuminates = 1;                            \
    }
#include "tandem/kernel/lights/lights.def"

void set_shutter_instants(Scene& scene, int instants) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera).instants = instants;
    }
}

double time_of_frame(const Scene& scene, std::int32_t frame) {
    const DefaultFpEnvironment guard;
    return double{static_cast<float>(frame / scene.frames_per_second)};
}

std::int32_t frame_count(const Scene& scene) {
    const DefaultFpEnvironment guard;
    float end = 0;
    for (const AnimationChannel& channel : scene.animation) {
        if (!channel.times.empty()) end = std::max(end, channel.times.back());
    }
    // a very late key must not overflow the frame number
    const double frames = std::round(double{end} * scene.frames_per_second);
    return static_cast<std::int32_t>(std::clamp(frames, 1.0, double{std::numeric_limits<std::int32_t>::max()}));
}

std::vector<std::string> validate(const Scene& scene) {
    const DefaultFpEnvironment guard;
    Problems problems(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) problems.check_node(i);
    problems.check_hierarchy();
    for (std::size_t i = 0; i < scene.materials.size(); ++i) problems.check_material(i);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) problems.check_mesh(i);
    for (std::size_t i = 0; i < scene.animation.size(); ++i) problems.check_channel(i);
    problems.check_environment();
    problems.require(is_exposure(scene.display.exposure_stops), "the display",
                     "has an exposure outside [-100, 100] stops");
    std::vector<std::string> found = problems.take();
    for (std::string& problem : find_texture_problems(scene)) found.push_back(std::move(problem));
    return found;
}

}  // namespace tandem

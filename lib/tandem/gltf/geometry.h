/// Reads meshes: triangles, spheres and boxes from two extensions, and their instances.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tandem/gltf/budget.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// An extension of nodes that repeats their mesh.
inline constexpr const char* instancing_name = "EXT_mesh_gpu_instancing";

/// Reads the geometry of nodes. Primitives without a material share one default material at the end.
class GeometryReader {
  public:
    GeometryReader(const Source& source, Scene& scene, ImportReport& report, FlawLog& flaws)
        : source_(source), scene_(scene), report_(report), flaws_(flaws), budget_(source) {}

    /// The geometry attached to node `index` of the file, without the primitives that have a flaw.
    [[nodiscard]] std::vector<Geometry> read(std::size_t index);

    /// A primitive of the file: of a mesh, by its number there.
    struct Primitive {
        std::size_t mesh, index;
        friend bool operator<(const Primitive& a, const Primitive& b) {
            return std::tie(a.mesh, a.index) < std::tie(b.mesh, b.index);
        }
    };
    /// The origin of a mesh of the scene in the file.
    struct Origin {
        Primitive primitive;
        std::optional<std::vector<std::uint32_t>> elements;  ///< as in PrimitiveMesh
    };
    [[nodiscard]] const Origin& origin_of(std::uint32_t mesh) const { return primitives_[mesh]; }

    /// Notes the shapes of KHR_implicit_shapes that no primitive uses.
    void note_unused_shapes();

  private:
    std::optional<Geometry> read_primitive(std::size_t mesh, std::size_t index);
    /// The geometry of primitive `index` of a mesh of the file.
    std::optional<Shape> read_shape(std::size_t mesh, std::size_t index, const std::string& path);
    std::optional<Shape> read_mesh(std::size_t mesh, std::size_t index, const std::string& path);
    /// A textured mesh needs texture coordinates.
    void complete_texcoords(Mesh& mesh, const Material& material, const std::string& path);
    /// Notes what becomes of the backs of single-sided faces.
    void note_sides(const Geometry& geometry, const std::string& path);
    std::optional<Shape> read_implicit_geometry(const Json& geometry, const std::string& path);
    std::optional<Shape> read_implicit_shape(const Json& reference, const std::string& path);
    std::vector<Trs> read_instances(const Json& instancing, const std::string& path);
    std::uint32_t material_of(const Json& primitive, const std::string& path);

    const Source& source_;
    Scene& scene_;
    ImportReport& report_;
    FlawLog& flaws_;
    Budget budget_;
    bool is_skinned_ = false;  ///< the node that is read
    std::optional<std::uint32_t> default_material_;
    std::map<Primitive, std::uint32_t> mesh_of_;
    std::vector<Origin> primitives_;  ///< by mesh of the scene
    std::set<Primitive> left_out_;
};

}  // namespace tandem::gltf

/// Meshes: spheres and boxes from two extensions, and their instances.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/gltf/model.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Counts what a few words of JSON can multiply (one mesh at many nodes, one accessor in many channels), so that a
/// small file cannot fill the memory.
class Budget {
  public:
    /// Ten million, or as many as the file has bytes of data.
    explicit Budget(const Source& source);

    /// Throws InputError once more than the budget has been spent.
    void spend(const Document& document, const std::string& json_path, std::size_t amount);

  private:
    std::size_t left_;
};

/// Reads the geometry of nodes. Materials that primitives do not name become one default material at the end.
class GeometryReader {
  public:
    GeometryReader(const Source& source, Scene& scene, ImportReport& report)
        : source_(source), scene_(scene), report_(report), budget_(source) {}

    /// What hangs on node `index` of the file.
    [[nodiscard]] std::vector<Geometry> read(std::size_t index);

    /// Notes the shapes of KHR_implicit_shapes that no primitive of the file uses.
    void note_unused_shapes();

  private:
    using Shape = std::variant<SphereShape, BoxShape>;

    std::optional<Shape> read_shape(const Json& primitive, const std::string& path);
    std::optional<Shape> read_implicit_geometry(const Json& geometry, const std::string& path);
    std::optional<Shape> read_implicit_shape(const Json& reference, const std::string& path);
    std::vector<Trs> read_instances(const Json& instancing, const std::string& path);
    std::uint32_t material_of(const Json& primitive, const std::string& path);

    const Source& source_;
    Scene& scene_;
    ImportReport& report_;
    Budget budget_;
    std::optional<std::uint32_t> default_material_;
};

}  // namespace tandem::gltf

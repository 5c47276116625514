#include "tandem/gltf/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "tandem/gltf/accessor.h"

namespace tandem::gltf {

namespace {

enum Mode : std::uint64_t { triangle_list = 4, triangle_strip = 5, triangle_fan = 6 };

const char* mode_name(std::uint64_t mode) {
    static constexpr const char* names[] = {"points",        "lines",          "line loop",   "line strip",
                                            "triangle mesh", "triangle strip", "triangle fan"};
    return mode < std::size(names) ? names[mode] : "mesh of unknown mode";
}

std::uint64_t mode_of(const Json& primitive) { return primitive.value("mode", std::uint64_t{triangle_list}); }

class TriangleReader {
  public:
    TriangleReader(const Source& source, const Json& primitive, const std::string& path, Budget& budget)
        : source_(source), primitive_(primitive), path_(path), budget_(budget) {
        const Json* used = find(source.document.json, "extensionsUsed");
        is_quantised_ = used != nullptr && std::find(used->begin(), used->end(), mesh_quantization) != used->end();
    }

    Mesh run() {
        Mesh mesh;
        mesh.positions = vectors<Vec3f>("POSITION", "VEC3", Components::floats, Components::quantised);
        vertices_ = mesh.positions.size();
        mesh.normals = vectors<Vec3f>("NORMAL", "VEC3", Components::floats, Components::normalised);
        mesh.texcoords = vectors<Vec2f>("TEXCOORD_0", "VEC2", Components::normalised, Components::quantised);
        mesh.triangles = triangles(corners());
        return mesh;
    }

  private:
    /// The elements of an attribute, empty if there is none; `quantised`: what KHR_mesh_quantization allows.
    template <class Vector>
    std::vector<Vector> vectors(const char* name, const char* type, Components plain, Components quantised) {
        const Json* index = find(primitive_["attributes"], name);
        if (index == nullptr) return {};
        const std::string where = fmt::format("{}.attributes.{}", path_, name);
        const auto accessor = index->get<std::size_t>();
        budget_.spend(source_.document, where, source_.model.accessors[accessor].count);
        const std::vector<float> values = read_accessor(
            source_, accessor, {type, is_quantised_ ? quantised : plain, fmt::format("the attribute {}", name), where});
        constexpr std::size_t width = Vector::length();
        const std::size_t count = values.size() / width;
        if (vertices_ != 0 && count != vertices_) {
            source_.document.fail(
                where, fmt::format("has {} elements, but POSITION has {}; make them equal", count, vertices_));
        }
        std::vector<Vector> result(count);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < width; ++c) {
                result[i][static_cast<typename Vector::length_type>(c)] = values[i * width + c];
            }
        }
        return result;
    }

    /// The vertices in the order in which the mode counts them.
    std::vector<std::uint32_t> corners() {
        const Json* index = find(primitive_, "indices");
        if (index == nullptr) {
            std::vector<std::uint32_t> all(vertices_);
            std::iota(all.begin(), all.end(), 0U);
            return all;
        }
        const std::string where = path_ + ".indices";
        const auto accessor = index->get<std::size_t>();
        budget_.spend(source_.document, where, source_.model.accessors[accessor].count);
        std::vector<std::uint32_t> indices = read_indices(source_, accessor, where);
        const auto bad =
            std::find_if(indices.begin(), indices.end(), [this](std::uint32_t i) { return i >= vertices_; });
        if (bad != indices.end()) {
            source_.document.fail(where, fmt::format("entry {} is {}, but POSITION has {} vertices",
                                                     bad - indices.begin(), *bad, vertices_));
        }
        return indices;
    }

    /// glTF 2.0, 3.7.2.1.
    std::vector<std::uint32_t> triangles(std::vector<std::uint32_t> corners) const {
        const std::uint64_t mode = mode_of(primitive_);
        const bool is_whole = mode == triangle_list ? corners.size() % 3 == 0 : corners.size() >= 3;
        if (!is_whole) {
            source_.document.fail(path_, fmt::format("has {} corners; a {} needs {}", corners.size(), mode_name(mode),
                                                     mode == triangle_list ? "a multiple of 3" : "3 or more"));
        }
        if (mode == triangle_list) return corners;
        std::vector<std::uint32_t> result;
        result.reserve(3 * (corners.size() - 2));
        for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
            if (mode == triangle_fan) {
                result.insert(result.end(), {corners[i + 1], corners[i + 2], corners[0]});
            } else {  // every other triangle of a strip runs backward
                result.insert(result.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
            }
        }
        return result;
    }

    const Source& source_;
    const Json& primitive_;
    const std::string& path_;
    Budget& budget_;
    bool is_quantised_ = false;
    std::size_t vertices_ = 0;
};

}  // namespace

bool has_triangles(const Json& primitive, const std::string& path, ImportReport& report) {
    const std::uint64_t mode = mode_of(primitive);
    if (mode < triangle_list || mode > triangle_fan) {
        report.add(Treatment::ignored, mode_name(mode), path, "Tandem renders surfaces only");
        return false;
    }
    const Json* attributes = find(primitive, "attributes");
    if (attributes == nullptr || !attributes->contains("POSITION")) {
        report.add(Treatment::ignored, mode_name(mode), path, "it has no positions");
        return false;
    }
    report.add(Treatment::rendered, mode_name(mode), path, "its triangles, without gaps between them");
    for (const auto& [name, index] : attributes->items()) {
        if (name == "POSITION" || name == "NORMAL" || name == "TEXCOORD_0") continue;
        const bool is_skin = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
        report.add(Treatment::ignored, fmt::format("attribute {}", name), fmt::format("{}.attributes.{}", path, name),
                   is_skin                        ? "Tandem does not render skins yet"
                   : name.starts_with("TEXCOORD") ? "textures lie at TEXCOORD_0"
                                                  : "Tandem reads positions and normals of vertices");
    }
    return true;
}

Mesh read_triangles(const Source& source, const Json& primitive, const std::string& path, Budget& budget) {
    return TriangleReader(source, primitive, path, budget).run();
}

}  // namespace tandem::gltf

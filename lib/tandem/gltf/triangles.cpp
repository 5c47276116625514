#include "tandem/gltf/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/accessor.h"
#include "tandem/gltf/faces.h"
#include "tandem/gltf/mend.h"

namespace tandem::gltf {

namespace {

class TriangleReader {
  public:
    TriangleReader(const Source& source, const Json& primitive, const std::string& path, Budget& budget, FlawLog& flaws,
                   ImportReport& report)
        : source_(source), primitive_(primitive), path_(path), budget_(budget), flaws_(flaws), report_(report) {
        const Json* used = find(source.document.json, "extensionsUsed");
        is_quantised_ = used != nullptr && std::find(used->begin(), used->end(), mesh_quantization) != used->end();
    }

    PrimitiveMesh run(const std::vector<std::uint32_t>& sets) {
        Mesh mesh;
        const auto position = primitive_["attributes"]["POSITION"].get<std::size_t>();
        mesh.triangles = triangles_of(source_.document, corners(element_count(source_, position)),
                                      static_cast<Mode>(mode_of(primitive_)), path_, flaws_);
        choose_vertices(mesh.triangles, element_count(source_, position));
        mesh.positions = vectors<Vec3f>("POSITION", "VEC3", Components::floats, Components::quantised);
        vertices_ = mesh.positions.size();
        mesh.normals = optional_vectors<Vec3f>("NORMAL", "VEC3", Components::floats, Components::normalised);
        if (!sets.empty()) mesh.texcoords.resize(sets.back() + 1);
        for (const std::uint32_t set : sets) {
            mesh.texcoords[set] = optional_vectors<Vec2f>(fmt::format("TEXCOORD_{}", set).c_str(), "VEC2",
                                                          Components::normalised, Components::quantised);
        }
        mesh.colours = colours();
        mend(source_.document, mesh, path_, flaws_);
        return {std::move(mesh), std::move(used_)};
    }

  private:
    /// Several primitives may share vertex arrays, so only the vertices that this one uses are read. A skin needs all.
    void choose_vertices(std::vector<std::uint32_t>& triangles, std::size_t vertices) {
        leave_out_missing_vertices(source_.document, triangles, vertices, path_, flaws_);
        if (triangles.size() < vertices && !primitive_["attributes"].contains("JOINTS_0")) {
            used_ = renumber_vertices(triangles);
        }
        vertices_ = used_ ? used_->size() : vertices;
        all_vertices_ = vertices;
    }

    /// Empty for an attribute with a flaw: the mesh is rendered without it.
    template <class Vector>
    std::vector<Vector> optional_vectors(const char* name, const char* type, Components plain, Components quantised) {
        try {
            return vectors<Vector>(name, type, plain, quantised);
        } catch (const Flaw& flaw) {
            flaws_.leave_out(fmt::format("attribute {}", name), flaw);
            return {};
        }
    }

    /// Whether mend() repairs numbers that are not finite.
    static bool is_mended(std::string_view name) {
        return name == "POSITION" || name == "NORMAL" || name.starts_with("TEXCOORD_");
    }

    /// The elements of an attribute; empty if there is none. `quantised`: the types that KHR_mesh_quantization allows,
    /// and that are accepted, with a note, in files that do not use it.
    template <class Vector>
    std::vector<Vector> vectors(const char* name, const char* type, Components plain, Components quantised) {
        const Json* index = find(primitive_["attributes"], name);
        if (index == nullptr) return {};
        const std::string where = fmt::format("{}.attributes.{}", path_, name);
        const auto accessor = index->get<std::size_t>();
        const std::size_t all = element_count(source_, accessor);
        if (all != all_vertices_) {
            source_.document.fail(
                where, fmt::format("has {} elements, but POSITION has {}; make them equal", all, all_vertices_));
        }
        budget_.spend(source_.document, where, vertices_);
        AccessorNeed need = {type, quantised, fmt::format("the attribute {}", name), where};
        need.is_finite = !is_mended(name);
        need.elements = used_ ? &*used_ : nullptr;
        const std::vector<float> values = read_accessor(source_, accessor, need);
        if (!is_quantised_ && !has_components(source_, accessor, plain)) {
            flaws_.tolerate(fmt::format("attribute {}", name), where,
                            fmt::format("has integers, which only files that use {} may have; Tandem accepts them "
                                        "same",
                                        mesh_quantization));
        }
        constexpr int width = std::is_same_v<Vector, Vec2f> ? 2 : 3;
        std::vector<Vector> result(vertices_);
        std::size_t next = 0;
        for (Vector& vector : result) {
            for (int c = 0; c < width; ++c) vector[c] = values[next++];
        }
        return result;
    }

    /// COLOR_0 as RGB or RGBA; empty if all are white.
    std::vector<VertexColour> colours() {
        const Json* index = find(primitive_["attributes"], "COLOR_0");
        if (index == nullptr) return {};
        const std::string where = path_ + ".attributes.COLOR_0";
        const auto accessor = index->get<std::size_t>();
        const auto type = source_.document.json["accessors"][accessor].value("type", std::string());
        const std::size_t width = type == "VEC4" ? 4 : 3;
        if (element_count(source_, accessor) != all_vertices_) {
            report_.add(Treatment::ignored, "vertex colours", where, "there is not one per position");
            return {};
        }
        budget_.spend(source_.document, where, vertices_);
        AccessorNeed need = {width == 4 ? "VEC4" : "VEC3", Components::normalised, "vertex colours", where};
        need.elements = used_ ? &*used_ : nullptr;
        std::vector<float> values;
        try {
            values = read_accessor(source_, accessor, need);
        } catch (const Flaw& flaw) {
            flaws_.leave_out("vertex colours", flaw);
            return {};
        }
        bool in_range = true;
        for (float& value : values) {
            in_range = in_range && value >= 0 && value <= 1;
            value = std::clamp(value, 0.0F, 1.0F);
        }
        report_.add(in_range ? Treatment::rendered : Treatment::approximated, "vertex colours", where,
                    in_range ? "linear; multiply the base colour"
                             : "linear; multiply the base colour; some are outside "
                               "[0, 1] and are clamped");
        if (std::all_of(values.begin(), values.end(), [](float value) { return value == 1; })) return {};
        std::vector<VertexColour> result(vertices_);
        for (std::size_t i = 0; i < vertices_; ++i) {
            const float* at = &values[i * width];
            result[i] = {{at[0], at[1], at[2]}, width == 4 ? at[3] : 1};
        }
        return result;
    }

    Corners corners(std::size_t vertices) {
        const Json* index = find(primitive_, "indices");
        if (index == nullptr) {
            budget_.spend(source_.document, path_ + ".attributes.POSITION", vertices);
            std::vector<std::uint32_t> all(vertices);
            std::iota(all.begin(), all.end(), 0U);
            return {std::move(all), std::nullopt};
        }
        const std::string where = path_ + ".indices";
        const auto accessor = index->get<std::size_t>();
        budget_.spend(source_.document, where, element_count(source_, accessor));
        return {read_indices(source_, accessor, where), largest_index(source_, accessor)};
    }

    const Source& source_;
    const Json& primitive_;
    const std::string& path_;
    Budget& budget_;
    FlawLog& flaws_;
    ImportReport& report_;
    bool is_quantised_ = false;
    std::optional<std::vector<std::uint32_t>> used_;  ///< the vertices to read; empty: all of them
    std::size_t vertices_ = 0, all_vertices_ = 0;     ///< of the mesh, and of POSITION
};

}  // namespace

namespace {

/// Why an attribute is ignored; null if it is not, or if another reader notes it.
const char* why_ignored_attribute(const std::string& name, const std::vector<std::uint32_t>& sets, bool is_skinned) {
    for (const char* known : {"POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"}) {
        if (name == known) return nullptr;
    }
    if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) {
        return is_skinned ? nullptr : "no node with a skin uses the mesh here";
    }
    const auto is_used = [&](std::uint32_t set) { return name == fmt::format("TEXCOORD_{}", set); };
    if (std::any_of(sets.begin(), sets.end(), is_used)) return nullptr;
    if (name.starts_with("TEXCOORD_")) return "no texture that Tandem renders uses it";
    if (name.starts_with("COLOR_")) return "glTF gives a meaning to COLOR_0 only";
    if (name == "TANGENT") return "the tangents of normal maps and of anisotropy come from the texture coordinates";
    return "Tandem does not know it";
}

}  // namespace

bool has_triangles(const Json& primitive, const std::vector<std::uint32_t>& sets, bool is_skinned,
                   const std::string& path, ImportReport& report) {
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
        const char* reason = why_ignored_attribute(name, sets, is_skinned);
        if (reason == nullptr) continue;
        report.add(Treatment::ignored, fmt::format("attribute {}", name), fmt::format("{}.attributes.{}", path, name),
                   reason);
    }
    return true;
}

PrimitiveMesh read_triangles(const Source& source, const Json& primitive, const std::vector<std::uint32_t>& sets,
                             const std::string& path, Budget& budget, FlawLog& flaws, ImportReport& report) {
    return TriangleReader(source, primitive, path, budget, flaws, report).run(sets);
}

}  // namespace tandem::gltf

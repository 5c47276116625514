#include "tandem/gltf/features.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "tandem/gltf/extensions.h"
#include "tandem/gltf/triangles.h"

namespace tandem::gltf {

namespace {

struct Feature {
    const char* name;
    const char* reason;
};

constexpr const char* film_decides = "the size of the film determines the aspect ratio";
constexpr const char* no_clipping = "a ray tracer has no clipping planes";
constexpr const char* no_morphing = "Tandem does not render morph targets yet";

/// By path in the file, with [] for any index.
const std::map<std::string, Feature>& ignored_features() {
    static const std::map<std::string, Feature> features = {
        {"nodes[].weights", {"morph weights", no_morphing}},
        {"meshes[].weights", {"morph weights", no_morphing}},
        {"meshes[].primitives[].targets", {"morph targets", no_morphing}},
        {"cameras[].perspective.aspectRatio", {"camera aspectRatio", film_decides}},
        {"cameras[].perspective.znear", {"camera znear", no_clipping}},
        {"cameras[].perspective.zfar", {"camera zfar", no_clipping}},
        {"cameras[].orthographic.xmag", {"camera xmag", film_decides}},
        {"cameras[].orthographic.znear", {"camera znear", no_clipping}},
        {"cameras[].orthographic.zfar", {"camera zfar", no_clipping}},
        {"materials[].occlusionTexture", {"occlusion texture", "Tandem does not render occlusion textures"}},
        {"extensions.KHR_lights_punctual.lights[].range",
         {"light range", "light falls off with the square of the distance"}},
        {"materials[].extensions.KHR_materials_transmission.transmissionTexture",
         {"transmission texture", "Tandem does not render transmission textures"}},
        {"materials[].extensions.KHR_materials_volume.thicknessTexture",
         {"thickness texture", "the thickness is that of the shape"}},
        {"meshes[].primitives[].extensions.EXT_implicit_geometry.sphere.slice",
         {"implicit geometry slice", "Tandem renders whole spheres"}},
        {"meshes[].primitives[].extensions.EXT_implicit_geometry.box.slice",
         {"implicit geometry slice", "Tandem renders whole boxes"}},
    };
    return features;
}

class Walker {
  public:
    Walker(const Document& document, ImportReport& report) : document_(document), report_(report) {}

    void run() {
        for (const ImportNote& note : report_.notes()) {  // flawed parts were removed from the document
            if (note.treatment == Treatment::ignored) met_.insert(note.feature);
        }
        walk(document_.json, "", "");
        const Json* used = find(document_.json, "extensionsUsed");
        for (std::size_t i = 0; used != nullptr && i < used->size(); ++i) {
            const auto name = (*used)[i].get<std::string>();
            if (met_.contains(name)) continue;
            if (const auto inside = inside_ignored_.find(name); inside != inside_ignored_.end()) {
                report_.add(Treatment::ignored, name, inside->second.path,
                            fmt::format("it is inside {}, which is ignored", inside->second.outer));
                continue;
            }
            if (name == mesh_quantization) {
                report_.add(Treatment::rendered, name, fmt::format("extensionsUsed[{}]", i),
                            "positions, normals and texture coordinates may be integers");
                continue;
            }
            report_.add(Treatment::ignored, name, fmt::format("extensionsUsed[{}]", i),
                        "the file lists it but does not use it");
        }
    }

  private:
    /// `place`: the path with [] for every index. read_document() bounds the depth.
    void walk(const Json& value, const std::string& path, const std::string& place) {
        if (const auto found = ignored_features().find(place); found != ignored_features().end()) {
            report_.add(Treatment::ignored, found->second.name, path, found->second.reason);
        }
        if (value.is_array()) {
            if (!value.empty() && !value[0].is_structured() && !ignored_features().contains(place + "[]")) return;
            for (std::size_t i = 0; i < value.size(); ++i) walk(value[i], fmt::format("{}[{}]", path, i), place + "[]");
        } else if (value.is_object()) {
            for (const auto& [name, member] : value.items()) walk_member(name, member, path, place);
        }
    }

    void walk_member(const std::string& name, const Json& member, const std::string& path, const std::string& place) {
        if (name == "extras") return;
        const std::string dot = path.empty() ? "" : ".";
        if (name == "extensions") {
            if (!member.is_object()) return;
            for (const auto& [extension, content] : member.items()) {
                met_.insert(extension);
                const std::string where = fmt::format("{}{}extensions.{}", path, dot, extension);
                if (is_rendered_extension(extension)) {
                    walk(content, where, fmt::format("{}{}extensions.{}", place, dot, extension));
                } else {
                    report_.add(Treatment::ignored, extension, where, why_ignored(extension));
                    find_inside(content, extension, where);
                }
            }
            return;
        }
        walk(member, path + dot + name, place + dot + name);
    }

    /// Remembers the extensions that are used inside an ignored one.
    void find_inside(const Json& value, const std::string& outer, const std::string& path) {
        for (const auto& [name, member] : value.items()) {
            if (!member.is_structured()) continue;
            const std::string where =
                value.is_array() ? fmt::format("{}[{}]", path, name) : fmt::format("{}.{}", path, name);
            if (value.is_object() && name == "extensions" && member.is_object()) {
                for (const auto& [extension, content] : member.items()) {
                    inside_ignored_.try_emplace(extension, Inside{outer, fmt::format("{}.{}", where, extension)});
                }
            }
            find_inside(member, outer, where);
        }
    }

    struct Inside {
        std::string outer;  ///< the ignored extension
        std::string path;
    };

    const Document& document_;
    ImportReport& report_;
    std::set<std::string> met_;                     ///< extensions that objects use
    std::map<std::string, Inside> inside_ignored_;  ///< extensions of objects within ignored extensions
};

}  // namespace

void note_ignored_features(const Document& document, ImportReport& report) { Walker(document, report).run(); }

}  // namespace tandem::gltf

#include "tandem/gltf/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/gltf/extensions.h"

namespace tandem::gltf {

namespace {

const Json& array_of(const Document& document, const char* name) {
    static const Json none = Json::array();
    const Json* found = find(document.json, name);
    return found == nullptr ? none : *found;
}

std::uint64_t whole(const Json& object, const char* name, std::uint64_t absent = 0) {
    return object.value(name, absent);
}

/// 0 for anything but a number.
int major_version(const Json& version) {
    if (version.is_number()) return version == 1 ? 1 : 0;
    if (!version.is_string()) return 0;
    const auto& text = version.get_ref<const std::string&>();
    const auto is_major = [&](const char* number) {
        return text == number || text.starts_with(number + std::string("."));
    };
    return is_major("1") ? 1 : is_major("2") ? 2 : 0;
}

void check_version(const Document& document) {
    const Json* asset = find(document.json, "asset");
    const Json* version = asset == nullptr ? nullptr : find(*asset, "version");
    // drafts of glTF 1.0 had no version; in 1.0 the arrays are objects
    const Json* meshes = find(document.json, "meshes");
    const bool has_objects = version == nullptr && meshes != nullptr && meshes->is_object();
    if (has_objects || (version != nullptr && major_version(*version) == 1)) {
        throw InputError(fmt::format("{}: {}", document.file.string(), is_gltf_1));
    }
    if (version == nullptr || !version->is_string()) return;  // check_schema() says so
    if (major_version(*version) != 2) {
        document.refuse("asset.version", fmt::format("is '{}'; Tandem reads glTF 2.0, so convert the file",
                                                     version->get<std::string>()));
    }
    const Json* least = find(*asset, "minVersion");
    if (least != nullptr && least->is_string() && *least != "2.0" && *least != "2") {
        document.refuse("asset.minVersion",
                        fmt::format("requires version {}; Tandem reads glTF 2.0", least->get<std::string>()));
    }
}

void check_required_extensions(const Document& document) {
    const Json& required = array_of(document, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (!required.is_array() || !required[i].is_string()) return;  // check_schema() says so
        const auto name = required[i].get<std::string>();
        if (is_rendered_extension(name)) continue;
        document.refuse(
            fmt::format("extensionsRequired[{}]", i),
            fmt::format("the file requires {}, which Tandem does not render; export the file without it, or make "
                        "the extension optional",
                        name));
    }
}

/// Checks and repairs the parents of nodes.
class Hierarchy {
  public:
    Hierarchy(Document& document, FlawLog& flaws)
        : document_(document), flaws_(flaws), parent_of_(document.length("nodes"), none) {}

    void run() {
        for (std::size_t i = 0; i < parent_of_.size(); ++i) take_children(i);
        // with one parent each, a walk upwards that does not end is a cycle; every node is visited once
        std::vector<std::size_t> walk_of(parent_of_.size(), none);
        for (std::size_t i = 0; i < parent_of_.size(); ++i) {
            std::size_t at = i;
            while (at != none && walk_of[at] == none) {
                walk_of[at] = i;
                at = parent_of_[at];
            }
            if (at != none && walk_of[at] == i) cut(at);
        }
    }

  private:
    static constexpr std::size_t none = SIZE_MAX;

    Json& node(std::size_t index) { return document_.json["nodes"][index]; }

    void take_children(std::size_t index) {
        const Json* children = find(node(index), "children");
        if (children == nullptr) return;
        Json good = Json::array();
        for (std::size_t k = 0; k < children->size(); ++k) {
            const auto child = (*children)[k].get<std::size_t>();
            if (parent_of_[child] == none) {
                parent_of_[child] = index;
                good.push_back(child);
                continue;
            }
            flaws_.leave_out("second parent",
                             Flaw(document_.file, fmt::format("nodes[{}].children[{}]", index, k),
                                  fmt::format("node {} is already a child of node {}; a node has one parent", child,
                                              parent_of_[child])));
        }
        if (good.size() != children->size()) node(index)["children"] = std::move(good);
    }

    /// Turns a node of a cycle into a root.
    void cut(std::size_t index) {
        const std::size_t parent = parent_of_[index];
        Json& children = node(parent)["children"];
        children.erase(std::find(children.begin(), children.end(), Json(index)));
        parent_of_[index] = none;
        flaws_.leave_out("cycle of nodes",
                         Flaw(document_.file, fmt::format("nodes[{}]", index),
                              fmt::format("is its own ancestor; remove it from the children of node {}", parent)));
    }

    Document& document_;
    FlawLog& flaws_;
    std::vector<std::size_t> parent_of_;
};

/// `count` elements of `bytes` bytes from `offset` must lie in the view.
void check_extent(const Document& document, const std::string& path, std::uint64_t view_index, std::uint64_t offset,
                  std::uint64_t count, std::uint64_t bytes) {
    const Json& view = array_of(document, "bufferViews")[view_index];
    const std::uint64_t stride = whole(view, "byteStride", bytes);
    const std::uint64_t length = whole(view, "byteLength");
    if (stride < bytes) {
        document.fail(path, fmt::format("has elements of {} bytes, but bufferView {} has a stride of {}", bytes,
                                        view_index, stride));
    }
    // no product that could overflow: counts are below 2^53
    const bool fits = offset <= length && bytes <= length - offset && count - 1 <= (length - offset - bytes) / stride;
    if (fits) return;
    const auto needed = static_cast<double>(offset) + static_cast<double>(count - 1) * static_cast<double>(stride) +
                        static_cast<double>(bytes);
    document.fail(path, fmt::format("needs {:.0f} bytes for its {} elements, but bufferView {} has {}", needed, count,
                                    view_index, length));
}

}  // namespace

std::size_t component_bytes(std::uint64_t component_type) {
    switch (component_type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        default:
            return 4;
    }
}

std::size_t component_count(const std::string& type) {
    if (type == "SCALAR") return 1;
    const auto size = static_cast<std::size_t>(type.back() - '0');
    return type.starts_with("MAT") ? size * size : size;
}

void check_edition(const Document& document) {
    check_version(document);
    check_required_extensions(document);
}

void check_buffer_view(const Document& document, FlawLog& flaws, Json& view, const std::string& path) {
    const std::uint64_t buffer = whole(view, "buffer");
    const std::uint64_t bytes = whole(array_of(document, "buffers")[buffer], "byteLength");
    const std::uint64_t offset = whole(view, "byteOffset");
    const std::uint64_t length = whole(view, "byteLength");
    if (offset > bytes || length > bytes - offset) {
        const std::string what = fmt::format("reaches from byte {} to byte {}, but buffer {} has {} bytes", offset,
                                             offset + length, buffer, bytes);
        if (offset >= bytes) document.fail(path, what);
        flaws.replace("buffer view", path, what + "; Tandem reads those that exist");
        view["byteLength"] = bytes - offset;
    }
    const auto stride = view.find("byteStride");
    if (stride == view.end()) return;
    const auto step = stride->get<std::uint64_t>();
    if (step >= 4 && step <= 252 && step % 4 == 0) return;
    flaws.tolerate("byteStride", path + ".byteStride",
                   fmt::format("is {}; glTF allows multiples of 4 from 4 to 252, but Tandem accepts it", step));
    if (step == 0) view.erase(stride);  // as if there were none
}

void check_accessor(const Document& document, FlawLog&, Json& accessor, const std::string& path) {
    const std::uint64_t count = whole(accessor, "count");
    const std::string type = accessor["type"];
    const std::uint64_t component = component_bytes(whole(accessor, "componentType"));
    const std::uint64_t bytes = component_count(type) * component;
    const bool has_padding = type.starts_with("MAT") && component < 4;  // nothing reads such matrices
    if (accessor.contains("bufferView") && !has_padding) {
        check_extent(document, path, whole(accessor, "bufferView"), whole(accessor, "byteOffset"), count, bytes);
    }
    const Json* sparse = find(accessor, "sparse");
    if (sparse == nullptr) return;
    const std::uint64_t replaced = whole(*sparse, "count");
    if (replaced > count) {
        document.fail(path + ".sparse.count",
                      fmt::format("is {}, more than the accessor's {} elements", replaced, count));
    }
    const Json& indices = (*sparse)["indices"];
    check_extent(document, path + ".sparse.indices", whole(indices, "bufferView"), whole(indices, "byteOffset"),
                 replaced, component_bytes(whole(indices, "componentType")));
    const Json& values = (*sparse)["values"];
    check_extent(document, path + ".sparse.values", whole(values, "bufferView"), whole(values, "byteOffset"), replaced,
                 bytes);
}

void check_camera(const Document& document, FlawLog&, Json& camera, const std::string& path) {
    const auto type = camera["type"].get<std::string>();
    if (!camera.contains(type)) document.fail(path, fmt::format("lacks the object '{}' of its type", type));
}

void check_image(const Document&, FlawLog& flaws, Json& image, const std::string& path) {
    if (!image.contains("bufferView") || image.erase("uri") == 0) return;
    flaws.replace("image", path + ".uri", "is given in addition to a bufferView; Tandem uses the bufferView");
}

void check_node(const Document&, FlawLog& flaws, Json& node, const std::string& path) {
    if (!node.contains("matrix")) return;
    for (const char* other : {"translation", "rotation", "scale"}) {
        if (node.erase(other) == 0) continue;
        flaws.replace(other, fmt::format("{}.{}", path, other),
                      "is given in addition to a matrix; Tandem uses the matrix");
    }
    Json& m = node["matrix"];
    if (m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1) return;
    flaws.replace("matrix", path + ".matrix",
                  "has a last row other than 0, 0, 0, 1; Tandem uses that row, since node transforms are affine");
    m[3] = m[7] = m[11] = 0;
    m[15] = 1;
}

void check_animation(const Document& document, FlawLog& flaws, Json& animation, const std::string& path) {
    Json& channels = animation["channels"];
    const Json& samplers = animation["samplers"];
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (channels[c].is_string()) continue;
        const std::uint64_t sampler = whole(channels[c], "sampler");
        if (sampler < samplers.size() && !samplers[sampler].is_string()) continue;
        const Flaw flaw(document.file, fmt::format("{}.channels[{}].sampler", path, c),
                        sampler < samplers.size()
                            ? fmt::format("names sampler {}, which is left out", sampler)
                            : fmt::format("is {}, but the animation has {} samplers", sampler, samplers.size()));
        channels[c] = flaw.root();
        flaws.leave_out("channel", flaw);
    }
}

void check_hierarchy(Document& document, FlawLog& flaws) { Hierarchy(document, flaws).run(); }

}  // namespace tandem::gltf

#include "tandem/gltf/structure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <optional>

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

void check_version(const Document& document) {
    const Json& asset = document.json["asset"];
    const auto version = asset["version"].get<std::string>();
    if (!version.starts_with("2.")) {
        document.fail("asset.version", fmt::format("is '{}'; Tandem reads glTF 2.0, so convert the file", version));
    }
    const auto least = asset.value("minVersion", std::string("2.0"));
    if (least != "2.0") {
        document.fail("asset.minVersion", fmt::format("asks for version {}; Tandem reads glTF 2.0", least));
    }
}

void check_required_extensions(const Document& document) {
    const Json& required = array_of(document, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        const auto name = required[i].get<std::string>();
        if (is_rendered_extension(name)) continue;
        document.fail(fmt::format("extensionsRequired[{}]", i),
                      fmt::format("the file requires {}, which Tandem does not render; export it without, or make the "
                                  "extension optional",
                                  name));
    }
}

/// Every node has at most one parent, and no node is its own ancestor; the nodes of a scene are roots.
void check_hierarchy(const Document& document) {
    const Json& nodes = array_of(document, "nodes");
    constexpr std::size_t none = SIZE_MAX;
    std::vector<std::size_t> parent_of(nodes.size(), none);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Json* children = find(nodes[i], "children");
        for (std::size_t k = 0; children != nullptr && k < children->size(); ++k) {
            const auto child = (*children)[k].get<std::size_t>();
            if (parent_of[child] != none) {
                document.fail(fmt::format("nodes[{}].children[{}]", i, k),
                              fmt::format("node {} is already a child of node {}; a node has one parent", child,
                                          parent_of[child]));
            }
            parent_of[child] = i;
        }
    }
    // with one parent each, a walk upwards that does not end is a cycle; every node is walked over once
    std::vector<std::size_t> walk_of(nodes.size(), none);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        std::size_t at = i;
        while (at != none && walk_of[at] == none) {
            walk_of[at] = i;
            at = parent_of[at];
        }
        if (at != none && walk_of[at] == i) {
            document.fail(fmt::format("nodes[{}]", at), "is its own ancestor; remove it from the children below it");
        }
    }
    const Json& scenes = array_of(document, "scenes");
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        const Json* roots = find(scenes[s], "nodes");
        for (std::size_t k = 0; roots != nullptr && k < roots->size(); ++k) {
            const auto root = (*roots)[k].get<std::size_t>();
            if (parent_of[root] == none) continue;
            document.fail(
                fmt::format("scenes[{}].nodes[{}]", s, k),
                fmt::format("node {} is a child of node {}; a scene lists root nodes only", root, parent_of[root]));
        }
    }
}

void check_nodes(const Document& document) {
    const Json& nodes = array_of(document, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].contains("matrix")) continue;
        for (const char* path : {"translation", "rotation", "scale"}) {
            if (nodes[i].contains(path)) {
                document.fail(fmt::format("nodes[{}].{}", i, path),
                              "stands beside a matrix; keep the matrix or translation, rotation and scale");
            }
        }
    }
}

void check_cameras(const Document& document) {
    const Json& cameras = array_of(document, "cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const auto type = cameras[i]["type"].get<std::string>();
        if (!cameras[i].contains(type)) {
            document.fail(fmt::format("cameras[{}]", i), fmt::format("lacks the object '{}' of its type", type));
        }
    }
}

void check_animations(const Document& document) {
    const Json& animations = array_of(document, "animations");
    for (std::size_t a = 0; a < animations.size(); ++a) {
        const Json& channels = animations[a]["channels"];
        const std::size_t samplers = animations[a]["samplers"].size();
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const std::uint64_t sampler = whole(channels[c], "sampler");
            if (sampler < samplers) continue;
            document.fail(fmt::format("animations[{}].channels[{}].sampler", a, c),
                          fmt::format("is {}, but the animation has {} samplers", sampler, samplers));
        }
    }
}

void check_buffer_views(const Document& document) {
    const Json& buffers = array_of(document, "buffers");
    const Json& views = array_of(document, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const std::string path = fmt::format("bufferViews[{}]", i);
        const std::uint64_t buffer = whole(views[i], "buffer");
        const std::uint64_t bytes = whole(buffers[buffer], "byteLength");
        const std::uint64_t offset = whole(views[i], "byteOffset");
        const std::uint64_t length = whole(views[i], "byteLength");
        if (offset > bytes || length > bytes - offset) {
            document.fail(path, fmt::format("reaches from byte {} to byte {}, but buffer {} has {} bytes", offset,
                                            offset + length, buffer, bytes));
        }
        if (whole(views[i], "byteStride") % 4 != 0) {
            document.fail(path + ".byteStride", fmt::format("is {}; it must be a multiple of 4",
                                                            views[i]["byteStride"].get<std::uint64_t>()));
        }
    }
}

/// `count` elements of `bytes` bytes from `offset` must lie in the view. Fewer than 2^53 elements with strides of at
/// most 252 bytes do not overflow 64 bits.
void check_extent(const Document& document, const std::string& path, std::uint64_t view_index, std::uint64_t offset,
                  std::uint64_t count, std::uint64_t bytes) {
    const Json& view = array_of(document, "bufferViews")[view_index];
    const std::uint64_t stride = whole(view, "byteStride", bytes);
    const std::uint64_t length = whole(view, "byteLength");
    if (stride < bytes) {
        document.fail(
            path, fmt::format("has elements of {} bytes, but bufferView {} steps by {}", bytes, view_index, stride));
    }
    const std::uint64_t needed = offset + (count - 1) * stride + bytes;
    if (needed > length) {
        document.fail(path, fmt::format("needs {} bytes for its {} elements, but bufferView {} has {}", needed, count,
                                        view_index, length));
    }
}

void check_accessors(const Document& document) {
    const Json& accessors = array_of(document, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const Json& accessor = accessors[i];
        const std::string path = fmt::format("accessors[{}]", i);
        const std::uint64_t count = whole(accessor, "count");
        const std::string type = accessor["type"];
        const std::uint64_t component = component_bytes(whole(accessor, "componentType"));
        const std::uint64_t bytes = component_count(type) * component;
        // columns of small matrices are padded; of these Tandem reads MAT4 of floats, which are not
        if (accessor.contains("bufferView") && (!type.starts_with("MAT") || type == "MAT4")) {
            check_extent(document, path, whole(accessor, "bufferView"), whole(accessor, "byteOffset"), count, bytes);
        }
        const Json* sparse = find(accessor, "sparse");
        if (sparse == nullptr) continue;
        const std::uint64_t replaced = whole(*sparse, "count");
        if (replaced > count) {
            document.fail(path + ".sparse.count",
                          fmt::format("is {}, more than the accessor's {} elements", replaced, count));
        }
        const Json& indices = (*sparse)["indices"];
        check_extent(document, path + ".sparse.indices", whole(indices, "bufferView"), whole(indices, "byteOffset"),
                     replaced, component_bytes(whole(indices, "componentType")));
        const Json& values = (*sparse)["values"];
        check_extent(document, path + ".sparse.values", whole(values, "bufferView"), whole(values, "byteOffset"),
                     replaced, bytes);
    }
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

void check_structure(const Document& document) {
    check_version(document);
    check_required_extensions(document);
    check_hierarchy(document);
    check_nodes(document);
    check_cameras(document);
    check_animations(document);
    check_buffer_views(document);
    check_accessors(document);
}

}  // namespace tandem::gltf

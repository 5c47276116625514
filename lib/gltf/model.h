/// The core of a glTF file as tinygltf reads it. The only include of tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// A checked document and the typed core of it. Extensions, animation channels and mesh primitives are read from
/// the JSON: tinygltf leaves out primitives without attributes and channels without a node.
struct Source {
    const Document& document;
    tinygltf::Model model;
};

/// Hands the checked document to tinygltf: nodes, cameras, materials, accessors, buffer views, buffers and animation
/// samplers. It gets nothing else to see, opens no file by itself, and decodes no image. Needs check_schema() and
/// check_structure(). Throws InputError.
[[nodiscard]] Source load_model(const Document& document, const std::vector<BufferSource>& buffers);

}  // namespace tandem::gltf

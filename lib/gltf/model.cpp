#include "tandem/gltf/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "tandem/error/error.h"
#include "tandem/file/whole_file.h"
#include "tandem/gltf/printable.h"

namespace tandem::gltf {

namespace {

constexpr std::string_view name_of_buffer = "buffer-";

/// What tinygltf asks of the file system: only the buffers that were located before, under names of ours.
struct BufferFiles {
    const Document& document;
    const std::vector<BufferSource>& sources;
    std::string failure;  ///< a sentence of ours, better than what tinygltf makes of it

    /// "anything/buffer-3" -> the third source; null for all other names.
    const BufferSource* at(const std::string& name) const {
        const std::size_t start = name.rfind(name_of_buffer);
        if (start == std::string::npos) return nullptr;
        std::size_t index = 0;
        const char* end = name.data() + name.size();
        const auto [rest, error] = std::from_chars(name.data() + start + name_of_buffer.size(), end, index);
        if (error != std::errc() || rest != end || index >= sources.size()) return nullptr;
        return &sources[index];
    }
};

bool file_exists(const std::string& name, void* user) { return static_cast<BufferFiles*>(user)->at(name) != nullptr; }

std::string expand_file_path(const std::string& name, void*) { return name; }

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& name, void* user) {
    auto& files = *static_cast<BufferFiles*>(user);
    const BufferSource* source = files.at(name);
    if (source == nullptr) return false;
    const auto take = [&](const std::vector<std::byte>& bytes) {
        const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
        out->assign(begin, begin + std::min(bytes.size(), source->bytes));
    };
    if (source->place == BufferSource::Place::chunk) {
        take(files.document.chunk);
        return true;
    }
    try {
        take(read_file(source->file.string()));
    } catch (const InputError& failure) {
        files.failure = fmt::format("{}: {}", files.document.file.string(), failure.what());
        if (error != nullptr) *error = files.failure;
        return false;
    }
    return true;
}

bool write_whole_file(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

[[maybe_unused]] bool file_size(std::size_t* bytes, std::string*, const std::string& name, void* user) {
    const BufferSource* source = static_cast<BufferFiles*>(user)->at(name);
    if (source == nullptr) return false;
    *bytes = source->bytes;
    return true;
}

/// tinygltf 2.9 asks for sizes, and has a limit of its own; older ones do not.
template <class Reader, class Callbacks>
void set_file_sizes(Reader& reader, Callbacks& callbacks) {
    if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = file_size;
    if constexpr (requires { reader.SetMaxExternalFileSize(SIZE_MAX); }) reader.SetMaxExternalFileSize(SIZE_MAX);
}

/// Takes away what tinygltf need not see.
void remove_extensions(Json& value) {
    if (value.is_object()) {
        value.erase("extensions");
        value.erase("extras");
    }
    if (!value.is_structured() || (value.is_array() && !value.empty() && !value[0].is_structured())) return;
    for (Json& member : value) remove_extensions(member);
}

/// The part of the document that tinygltf is to read.
Json core_of(const Document& document, const std::vector<BufferSource>& buffers) {
    Json core = {{"asset", {{"version", "2.0"}}}};
    for (const char* name : {"accessors", "animations", "bufferViews", "buffers", "cameras", "materials", "nodes"}) {
        if (const Json* found = find(document.json, name)) core[name] = *found;
    }
    remove_extensions(core);
    if (core.contains("animations")) {  // a channel without a node is an error to tinygltf, though not to glTF
        for (Json& animation : core["animations"]) animation["channels"] = Json::array();
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        if (buffers[i].place == BufferSource::Place::data_uri) continue;
        core["buffers"][i]["uri"] = fmt::format("{}{}", name_of_buffer, i);
    }
    return core;
}

}  // namespace

Source load_model(const Document& document, const std::vector<BufferSource>& buffers) {
    const std::string text = core_of(document, buffers).dump();
    BufferFiles files{document, buffers, {}};
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = file_exists;
    callbacks.ExpandFilePath = expand_file_path;
    callbacks.ReadWholeFile = read_whole_file;
    callbacks.WriteWholeFile = write_whole_file;
    callbacks.user_data = &files;

    Source source{document, {}};
    tinygltf::TinyGLTF reader;
    set_file_sizes(reader, callbacks);
    reader.SetFsCallbacks(callbacks);
    std::string error;
    std::string warning;
    const bool good = reader.LoadASCIIFromString(&source.model, &error, &warning, text.data(),
                                                 static_cast<unsigned int>(text.size()), "");
    if (!files.failure.empty()) throw InputError(files.failure);
    if (!good || !error.empty()) {
        while (!error.empty() && error.back() == '\n') error.pop_back();
        throw InputError(fmt::format("{}: tinygltf cannot read it: {}", document.file.string(), printable(error)));
    }
    return source;
}

}  // namespace tandem::gltf

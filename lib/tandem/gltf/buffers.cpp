#include "tandem/gltf/buffers.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "tandem/base/lfs_pointer.h"
#include "tandem/gltf/uris.h"

namespace tandem::gltf {

namespace {

struct Place {
    enum class Kind { chunk, data_uri, file };

    Kind kind = Kind::chunk;
    std::size_t bytes = 0;         ///< available
    std::string_view digits;       ///< of a data URI
    std::filesystem::path file{};  ///< to read
};

Place locate(const Document& document, const Json& buffer, const std::string& path) {
    const std::string uri_path = path + ".uri";
    const Json* uri = find(buffer, "uri");
    if (uri == nullptr) {
        if (!document.chunk) {
            document.fail(uri_path, "is absent, and the file has no binary chunk; name a file or embed the data");
        }
        if (&buffer != &document.json["buffers"][0]) {
            document.fail(uri_path, "is absent; only the first buffer may be in the binary chunk of a .glb");
        }
        return {Place::Kind::chunk, document.chunk->size(), {}};
    }
    const auto& text = uri->get_ref<const std::string&>();
    if (text.starts_with("data:")) {
        const std::string_view digits = base64_digits(document, uri_path, text);
        return {Place::Kind::data_uri, digits.size() * 3 / 4, digits};
    }
    LocatedFile file = locate_beside(document, uri_path, text);
    if (file.is_lfs_pointer) document.fail(uri_path, fmt::format("names '{}', which {}", file.name, lfs_advice));
    return {Place::Kind::file, file.bytes, {}, std::move(file.path)};
}

}  // namespace

void check_buffer(const Document& document, FlawLog& flaws, Json& buffer, const std::string& path) {
    const Place place = locate(document, buffer, path);
    const auto length = buffer["byteLength"].get<std::size_t>();
    if (place.bytes >= length) return;
    const char* where = place.kind == Place::Kind::chunk      ? "the binary chunk"
                        : place.kind == Place::Kind::data_uri ? "its data URI"
                                                              : "the file";
    const std::string what = fmt::format("is {}, but {} has {} bytes; it may be truncated", length, where, place.bytes);
    const Flaw flaw(document.file, path + ".byteLength", what);
    if (place.bytes == 0) throw flaw;
    flaws.shorten("buffer", flaw);
    buffer["byteLength"] = place.bytes;
}

std::size_t data_bytes(const Source& source) {
    std::size_t bytes = source.document.chunk ? source.document.chunk->size() : 0;
    for (const Bytes& stored : source.storage) bytes += stored.size();
    return bytes;
}

Source load_buffers(Document document) {
    Source source{std::move(document), {}, {}};
    std::map<std::filesystem::path, std::size_t> storage_of;
    const Json* buffers = find(source.document.json, "buffers");
    for (std::size_t i = 0; buffers != nullptr && i < buffers->size(); ++i) {
        const Json& buffer = (*buffers)[i];
        source.buffers.emplace_back();
        if (buffer.is_string()) continue;  // left out
        const std::string path = fmt::format("buffers[{}]", i);
        const Place place = locate(source.document, buffer, path);
        std::span<const std::byte> bytes;
        if (place.kind == Place::Kind::chunk) {
            bytes = *source.document.chunk;
        } else if (place.kind == Place::Kind::data_uri) {
            bytes = source.storage.emplace_back(decode_base64(place.digits));
        } else {
            const auto [known, is_new] = storage_of.try_emplace(place.file, source.storage.size());
            if (is_new) source.storage.push_back(read_beside(source.document, path + ".uri", place.file));
            bytes = source.storage[known->second];
        }
        const auto length = buffer["byteLength"].get<std::size_t>();
        if (bytes.size() < length)
            source.document.fail(path + ".uri", "names a file that changed while it was read; run the program again");
        source.buffers.back() = bytes.first(length);
    }
    return source;
}

}  // namespace tandem::gltf

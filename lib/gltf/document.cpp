#include "tandem/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "tandem/error/error.h"
#include "tandem/file/whole_file.h"
#include "tandem/gltf/printable.h"

namespace tandem::gltf {

namespace {

constexpr int deepest_nesting = 64;
/// The tree of a JSON text takes up to some twenty times its bytes.
constexpr std::size_t longest_json = std::size_t{512} << 20;

constexpr std::uint32_t glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN"

using ByteView = std::span<const std::byte>;

/// Little endian, as x86-64 is.
std::uint32_t word_at(ByteView bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof(word));
    return word;
}

/// Takes the chunks of a .glb apart (glTF 2.0, 4.4).
class GlbReader {
  public:
    GlbReader(Document& document, ByteView bytes) : document_(document), bytes_(bytes) {}

    /// The JSON text; the binary chunk goes into the document.
    ByteView run() {
        if (bytes_.size() < 20) fail("is too short for a .glb file; it may be truncated");
        if (const auto version = word_at(bytes_, 4); version != 2) {
            fail(fmt::format("is a .glb file of version {}; Tandem reads version 2", version));
        }
        if (const auto length = word_at(bytes_, 8); length != bytes_.size()) {
            fail(fmt::format("says in its header that it has {} bytes, but has {}; it may be truncated", length,
                             bytes_.size()));
        }
        std::size_t at = 12;
        const ByteView json = take_chunk(at, json_chunk, "first");
        if (at < bytes_.size() && bytes_.size() - at >= 8 && word_at(bytes_, at + 4) == bin_chunk) {
            const ByteView chunk = take_chunk(at, bin_chunk, "second");
            document_.chunk.assign(chunk.begin(), chunk.end());
            document_.has_chunk = true;
        }
        while (at < bytes_.size()) take_chunk(at, 0, "further");  // unknown chunks are to be skipped
        return json;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", document_.file.string(), what));
    }

    /// `type`: what it must be; 0 for any.
    ByteView take_chunk(std::size_t& at, std::uint32_t type, const char* which) const {
        if (bytes_.size() - at < 8) fail(fmt::format("ends within the header of its {} chunk", which));
        const std::size_t length = word_at(bytes_, at);
        if (type != 0 && word_at(bytes_, at + 4) != type) {
            fail(fmt::format("is a .glb file whose {} chunk is not the JSON; write that chunk first", which));
        }
        at += 8;
        if (length > bytes_.size() - at) {
            fail(fmt::format("says that its {} chunk has {} bytes, but only {} follow; it may be truncated", which,
                             length, bytes_.size() - at));
        }
        const ByteView chunk = bytes_.subspan(at, length);
        at += length;
        return chunk;
    }

    Document& document_;
    ByteView bytes_;
};

/// nlohmann's message without its bracketed identifier.
std::string plain_message(const std::exception& error) {
    const std::string message = error.what();
    const std::size_t end = message.find("] ");
    return end == std::string::npos ? message : message.substr(end + 2);
}

/// The depth of the deepest bracket outside of strings. Before the parse, since its callback, which knows the depth
/// too, makes the time grow with the square of the length of an array.
int nesting_of(std::string_view text) {
    int depth = 0;
    int deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') {
            ++i;  // what an escape names is part of the string
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string && (c == '[' || c == '{')) {
            deepest = std::max(deepest, ++depth);
            if (deepest > deepest_nesting) return deepest;
        } else if (!in_string && (c == ']' || c == '}')) {
            --depth;
        }
    }
    return deepest;
}

Json parse(const Document& document, ByteView bytes) {
    const auto fail = [&](const std::string& what) {
        throw InputError(fmt::format("{}: {}", document.file.string(), printable(what)));
    };
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.empty()) fail("is empty; a glTF file holds a JSON object");
    if (text.size() > longest_json) {
        fail("has more than 512 MiB of JSON; put the data into buffers of their own");
    }
    if (nesting_of(text) > deepest_nesting) fail(fmt::format("nests its JSON deeper than {} levels", deepest_nesting));
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        fail("is not well-formed JSON: " + plain_message(error));
    }
    if (!json.is_object()) fail("does not hold a JSON object; a glTF file starts with '{'");
    return json;
}

}  // namespace

void Document::fail(std::string_view json_path, std::string_view what) const {
    throw InputError(fmt::format("{}: {}", file.string(), printable(fmt::format("{}: {}", json_path, what))));
}

std::size_t Document::length(const std::string& array) const {
    const Json::json_pointer pointer("/" + array);
    if (!json.contains(pointer)) return 0;
    const Json& found = json[pointer];
    return found.is_array() ? found.size() : 0;
}

Document read_document(const std::filesystem::path& file) {
    Document document;
    document.file = file;
    const Bytes bytes = read_file(file.string());
    const bool is_glb = bytes.size() >= 4 && word_at(bytes, 0) == glb_magic;
    const ByteView text = is_glb ? GlbReader(document, bytes).run() : ByteView(bytes);
    document.json = parse(document, text);
    return document;
}

const Json* find(const Json& object, const char* member) {
    const auto found = object.find(member);
    return found == object.end() ? nullptr : &*found;
}

const Json* find_extension(const Json& object, const char* extension) {
    const Json* extensions = find(object, "extensions");
    return extensions == nullptr ? nullptr : find(*extensions, extension);
}

}  // namespace tandem::gltf

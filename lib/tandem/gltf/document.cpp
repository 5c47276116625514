#include "tandem/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "tandem/base/error.h"
#include "tandem/base/lfs_pointer.h"
#include "tandem/base/whole_file.h"
#include "tandem/gltf/printable.h"

namespace tandem::gltf {

namespace {

constexpr int deepest_nesting = 64;
/// Limit of the JSON text: its tree takes up to about twenty times as much memory.
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

/// Splits a .glb into its chunks (glTF 2.0, 4.4).
class GlbReader {
  public:
    GlbReader(Document& document, ByteView bytes, FlawLog& flaws) : document_(document), bytes_(bytes), flaws_(flaws) {}

    /// Returns the JSON text; the binary chunk goes into the document.
    ByteView run() {
        check_header();
        std::size_t at = header_bytes;
        const ByteView json = take_chunk(at, "first", json_chunk);
        if (bytes_.size() - at >= chunk_header_bytes && word_at(bytes_, at + 4) == bin_chunk) {
            document_.chunk = take_chunk(at, "second");
        }
        while (bytes_.size() - at >= chunk_header_bytes) take_chunk(at, "further");  // unknown ones must be skipped
        if (at < bytes_.size()) note_rest("the last chunk", bytes_.size() - at);
        return json;
    }

  private:
    static constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", document_.file.string(), what));
    }

    void check_header() {
        const auto require_bytes = [this](std::size_t count) {
            if (bytes_.size() >= count) return;
            fail(fmt::format("is too short for a .glb file: it has {} of at least {} bytes; it may be truncated",
                             bytes_.size(), count));
        };
        require_bytes(8);
        const auto version = word_at(bytes_, 4);
        if (version == 1) fail(is_gltf_1);
        if (version != 2) fail(fmt::format("is a .glb file of version {}; Tandem reads version 2", version));
        require_bytes(header_bytes + chunk_header_bytes);
        const std::size_t length = word_at(bytes_, 8);
        if (length < header_bytes + chunk_header_bytes) {
            fail(
                fmt::format("has a length of {} bytes in its header, less than any .glb file; the header is wrong, "
                            "so export the file again",
                            length));
        }
        if (length > bytes_.size()) {
            fail(fmt::format(
                "has a length of {} bytes in its header, but only {} bytes: {} are missing; it may be truncated",
                length, bytes_.size(), length - bytes_.size()));
        }
        if (length < bytes_.size()) note_rest("the end that the header gives", bytes_.size() - length);
        bytes_ = bytes_.first(length);
    }

    void note_rest(const char* behind, std::size_t count) {
        flaws_.leave_out("bytes behind the end of the .glb",
                         Flaw(document_.file, "header", fmt::format("{} bytes follow {}", count, behind)));
    }

    /// `type`: the required type; 0 for any.
    ByteView take_chunk(std::size_t& at, const char* which, std::uint32_t type = 0) const {
        const std::size_t length = word_at(bytes_, at);
        if (type != 0 && word_at(bytes_, at + 4) != type) {
            fail(fmt::format("is a .glb file whose {} chunk is not JSON; the JSON chunk must be first", which));
        }
        at += chunk_header_bytes;
        if (length > bytes_.size() - at) {
            fail(fmt::format("has a {} chunk with a length of {} bytes, but only {} follow; it may be truncated", which,
                             length, bytes_.size() - at));
        }
        const ByteView chunk = bytes_.subspan(at, length);
        at += length;
        return chunk;
    }

    Document& document_;
    ByteView bytes_;
    FlawLog& flaws_;
};

/// The message of nlohmann's parser without its bracketed identifier.
std::string plain_message(const std::exception& error) {
    const std::string message = error.what();
    const std::size_t end = message.find("] ");
    return end == std::string::npos ? message : message.substr(end + 2);
}

/// The nesting depth of brackets outside of strings. Counted before parsing: the parser's callback knows the depth too,
/// but makes the time quadratic in the length of an array.
int nesting_of(std::string_view text) {
    int depth = 0;
    int deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') {
            ++i;  // the escaped character is part of the string
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

/// The bytes of a well-formed UTF-8 sequence at the front of `text`, 0 if there is none (RFC 3629, 4).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
    }
    const bool is_overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
    const bool is_beyond = (lead == 0xED && byte(1) > 0x9F) || (lead == 0xF4 && byte(1) > 0x8F);
    return is_overlong || is_beyond ? 0 : length;
}

/// The text with a question mark for every byte that is not UTF-8; empty if all of it is UTF-8.
std::optional<std::string> as_utf8(std::string_view text) {
    std::string repaired;
    std::size_t taken = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = utf8_length(text.substr(at, 4));
        if (length == 0) {
            repaired.append(text.substr(taken, at - taken)).append("?");
            taken = at + 1;
        }
        at += std::max<std::size_t>(1, length);
    }
    if (taken == 0) return std::nullopt;
    return repaired.append(text.substr(taken));
}

Json parse(const Document& document, ByteView bytes, FlawLog& flaws) {
    const auto fail = [&](const std::string& what) {
        throw InputError(fmt::format("{}: {}", document.file.string(), printable(what)));
    };
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.empty()) fail("is empty; a glTF file contains a JSON object");
    if (text.size() > longest_json) {
        fail("has more than 512 MiB of JSON; move the data into buffer files");
    }
    if (nesting_of(text) > deepest_nesting)
        fail(fmt::format("nests its JSON deeper than {} levels; flatten it", deepest_nesting));
    const std::optional<std::string> repaired = as_utf8(text);
    if (repaired) text = *repaired;
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        fail("is not well-formed JSON: " + plain_message(error));
    }
    if (!json.is_object()) fail("is not a JSON object; a glTF file starts with '{'");
    if (repaired) flaws.replace("text that is not UTF-8", "root", "Tandem replaces its bytes by question marks");
    return json;
}

}  // namespace

void Document::fail(std::string_view json_path, std::string_view what) const {
    throw Flaw(file, std::string(json_path), std::string(what));
}

void Document::refuse(std::string_view json_path, std::string_view what) const {
    refuse(Flaw(file, std::string(json_path), std::string(what)));
}

void Document::refuse(const Flaw& flaw) const {
    throw InputError(fmt::format("{}: {}", file.string(), printable(flaw.root())));
}

std::size_t Document::length(const std::string& array) const {
    const Json::json_pointer pointer("/" + array);
    if (!json.contains(pointer)) return 0;
    const Json& found = json[pointer];
    return found.is_array() ? found.size() : 0;
}

Document read_document(const std::filesystem::path& file, FlawLog& flaws) {
    Document document;
    document.file = file;
    document.bytes = read_file(file.string());
    const ByteView bytes = document.bytes;
    if (is_lfs_pointer(bytes)) throw InputError(fmt::format("{}: {}", file.string(), lfs_advice));
    const bool is_glb = bytes.size() >= 4 && word_at(bytes, 0) == glb_magic;
    document.json = parse(document, is_glb ? GlbReader(document, bytes, flaws).run() : bytes, flaws);
    if (!document.chunk) document.bytes = {};
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

#include "tandem/gltf/buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace tandem::gltf {

namespace {

std::optional<int> hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// Percent-decoding (RFC 3986, 2.1); nothing if an escape is broken.
std::optional<std::string> percent_decoded(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            decoded += uri[i];
            continue;
        }
        if (i + 2 >= uri.size()) return std::nullopt;
        const auto high = hexadecimal(uri[i + 1]);
        const auto low = hexadecimal(uri[i + 2]);
        if (!high || !low) return std::nullopt;
        decoded += static_cast<char>(*high * 16 + *low);
        i += 2;
    }
    return decoded;
}

/// "http:" and the like (RFC 3986, 3.1).
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0 || std::isalpha(static_cast<unsigned char>(uri[0])) == 0) {
        return false;
    }
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    });
}

/// What is wrong with a decoded path, or null.
const char* objection(std::string_view path) {
    if (path.empty()) return "is empty; name a file";
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (std::any_of(path.begin(), path.end(), is_control)) return "holds control characters; rename the file";
    if (path.find('\\') != std::string_view::npos) return "holds a backslash; write folders with '/'";
    if (path[0] == '/') return "is an absolute path; put the buffer into the folder of the glTF file";
    for (std::size_t at = 0; at <= path.size();) {
        const std::size_t end = std::min(path.find('/', at), path.size());
        if (path.substr(at, end - at) == "..") {
            return "leads out of the folder of the glTF file with '..'; put the buffer into that folder";
        }
        at = end + 1;
    }
    return nullptr;
}

bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto [in_folder, in_path] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return in_folder == folder.end();
}

/// Bytes of files that several buffers name: each buffer keeps a copy, and a few words of JSON must not fill memory.
constexpr std::size_t most_repeated = std::size_t{1} << 30;

class Locator {
  public:
    Locator(const Document& document, std::size_t index, const Json& buffer)
        : document_(document), index_(index), buffer_(buffer) {}

    BufferSource run() {
        source_.bytes = buffer_["byteLength"].get<std::size_t>();
        const Json* uri = find(buffer_, "uri");
        if (uri == nullptr) {
            in_chunk();
        } else if (const auto& text = uri->get_ref<const std::string&>(); text.starts_with("data:")) {
            in_data_uri(text);
        } else {
            in_file(text);
        }
        return source_;
    }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        document_.fail(fmt::format("buffers[{}].uri", index_), what);
    }

    void require_bytes(std::uintmax_t there, const char* where) const {
        if (there >= source_.bytes) return;
        document_.fail(fmt::format("buffers[{}].byteLength", index_),
                       fmt::format("is {}, but {} has {} bytes; it may be truncated", source_.bytes, where, there));
    }

    void in_chunk() {
        if (!document_.has_chunk || index_ != 0) {
            fail(document_.has_chunk ? "is absent; only the first buffer may live in the binary chunk of a .glb"
                                     : "is absent, and the file has no binary chunk; name a file or embed the data");
        }
        source_.place = BufferSource::Place::chunk;
        require_bytes(document_.chunk.size(), "the binary chunk");
    }

    /// tinygltf decodes; this makes sure that it can and that it gets the size right.
    void in_data_uri(std::string_view uri) {
        static constexpr std::array<std::string_view, 2> headers = {"data:application/octet-stream;base64,",
                                                                    "data:application/gltf-buffer;base64,"};
        const auto header =
            std::find_if(headers.begin(), headers.end(), [&](std::string_view h) { return uri.starts_with(h); });
        if (header == headers.end()) {
            fail(fmt::format("is a data URI that does not begin with '{}' or '{}'", headers[0], headers[1]));
        }
        std::string_view digits = uri.substr(header->size());
        const std::size_t padded = digits.size();
        while (!digits.empty() && digits.back() == '=') digits.remove_suffix(1);
        const auto is_digit = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '/';
        };
        if (padded % 4 != 0 || padded - digits.size() > 2 || !std::all_of(digits.begin(), digits.end(), is_digit)) {
            fail("is a data URI whose base64 is broken; it may be truncated");
        }
        const std::size_t decoded = digits.size() * 3 / 4;
        require_bytes(decoded, "its data URI");
        if (decoded > source_.bytes) {
            document_.fail(
                fmt::format("buffers[{}].byteLength", index_),
                fmt::format("is {}, but its data URI has {} bytes; make them equal", source_.bytes, decoded));
        }
        source_.place = BufferSource::Place::data_uri;
    }

    void in_file(const std::string& uri) {
        if (has_scheme(uri)) fail("has a scheme; Tandem opens files beside the glTF file and data URIs only");
        const auto decoded = percent_decoded(uri);
        if (!decoded) fail("has a '%' that two hexadecimal digits do not follow");
        if (const char* problem = objection(*decoded)) fail(problem);
        const std::filesystem::path parent = document_.file.parent_path();
        const std::filesystem::path folder = parent.empty() ? std::filesystem::path(".") : parent;
        std::error_code error;
        const auto file = std::filesystem::canonical(folder / *decoded, error);
        if (error) fail(fmt::format("names '{}', which is not there; put it beside the glTF file", *decoded));
        const auto inside = std::filesystem::canonical(folder, error);
        if (error || !is_within(file, inside)) {
            fail(fmt::format("names '{}', a link that leads out of the folder of the glTF file", *decoded));
        }
        if (!std::filesystem::is_regular_file(file, error)) fail(fmt::format("'{}' is not a regular file", *decoded));
        const std::uintmax_t there = std::filesystem::file_size(file, error);
        if (error) fail(fmt::format("'{}' cannot be read; check its permissions", *decoded));
        require_bytes(there, "the file");
        source_.place = BufferSource::Place::file;
        source_.file = file;
    }

    const Document& document_;
    std::size_t index_;
    const Json& buffer_;
    BufferSource source_;
};

}  // namespace

std::vector<BufferSource> locate_buffers(const Document& document) {
    std::vector<BufferSource> sources;
    std::set<std::filesystem::path> files;
    std::size_t repeated = 0;
    const Json* buffers = find(document.json, "buffers");
    for (std::size_t i = 0; buffers != nullptr && i < buffers->size(); ++i) {
        sources.push_back(Locator(document, i, (*buffers)[i]).run());
        const BufferSource& source = sources.back();
        if (source.place != BufferSource::Place::file || files.insert(source.file).second) continue;
        repeated += source.bytes;
        if (repeated > most_repeated) {
            document.fail(fmt::format("buffers[{}].uri", i),
                          "loads a file again that earlier buffers hold, beyond 1 GiB of copies; use one buffer");
        }
    }
    return sources;
}

}  // namespace tandem::gltf

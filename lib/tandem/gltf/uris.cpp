#include "tandem/gltf/uris.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/lfs_pointer.h"

namespace tandem::gltf {

namespace {

std::optional<int> hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// Percent-decoding (RFC 3986, 2.1); a '%' that starts no escape is kept.
std::string percent_decoded(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const auto high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal(uri[i + 1]) : std::nullopt;
        const auto low = high ? hexadecimal(uri[i + 2]) : std::nullopt;
        decoded += low ? static_cast<char>(*high * 16 + *low) : uri[i];
        if (low) i += 2;
    }
    return decoded;
}

/// Whether the URI has a scheme, such as "http:" (RFC 3986, 3.1).
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
    if (std::any_of(path.begin(), path.end(), is_control)) return "contains control characters; rename the file";
    if (path[0] == '/') return "is an absolute path; put the file into the folder of the glTF file";
    for (std::size_t at = 0; at <= path.size();) {
        const std::size_t end = std::min(path.find('/', at), path.size());
        if (path.substr(at, end - at) == "..") {
            return "leads out of the folder of the glTF file with '..'; put the file into that folder";
        }
        at = end + 1;
    }
    return nullptr;
}

bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto [in_folder, in_path] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return in_folder == folder.end();
}

unsigned digit_value(char c) {
    if (c >= 'A' && c <= 'Z') return static_cast<unsigned>(c - 'A');
    if (c >= 'a' && c <= 'z') return static_cast<unsigned>(c - 'a') + 26;
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0') + 52;
    return c == '+' ? 62 : 63;
}

}  // namespace

LocatedFile locate_beside(const Document& document, const std::string& json_path, const std::string& uri) {
    const auto fail = [&](std::string_view what) { document.fail(json_path, what); };
    if (has_scheme(uri)) fail("has a scheme; Tandem opens files beside the glTF file and data URIs only");
    std::string name = percent_decoded(uri);
    std::replace(name.begin(), name.end(), '\\', '/');
    if (const char* problem = objection(name)) fail(problem);
    const std::filesystem::path parent = document.file.parent_path();
    const std::filesystem::path folder = parent.empty() ? std::filesystem::path(".") : parent;
    std::error_code error;
    const auto file = std::filesystem::canonical(folder / name, error);
    if (error) fail(fmt::format("names '{}', which does not exist; put it beside the glTF file", name));
    const auto inside = std::filesystem::canonical(folder, error);
    if (error || !is_within(file, inside)) {
        fail(fmt::format("names '{}', a link that leads out of the folder of the glTF file", name));
    }
    if (!std::filesystem::is_regular_file(file, error)) fail(fmt::format("'{}' is not a regular file", name));
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) fail(fmt::format("'{}' cannot be read; check its permissions", name));
    const bool is_pointer = bytes < lfs_pointer_bytes && is_lfs_pointer(read_beside(document, json_path, file));
    return {file, bytes, std::move(name), is_pointer};
}

Bytes read_beside(const Document& document, const std::string& json_path, const std::filesystem::path& file) {
    try {
        return read_file(file.string());
    } catch (const InputError& error) {
        document.fail(json_path, error.what());
    }
}

std::string_view base64_digits(const Document& document, const std::string& json_path, std::string_view uri) {
    const std::size_t comma = std::min(uri.find(','), uri.size());
    if (!uri.substr(0, comma).ends_with(";base64")) {
        document.fail(json_path, "is a data URI that does not start with 'data:', a media type and ';base64,'");
    }
    std::string_view digits = uri.substr(std::min(comma + 1, uri.size()));
    const std::size_t length = digits.size();
    while (!digits.empty() && digits.back() == '=') digits.remove_suffix(1);
    const auto is_digit = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '/';
    };
    const std::size_t padding = length - digits.size();
    const bool has_good_end = padding == 0 ? length % 4 != 1 : length % 4 == 0 && padding <= 2;
    if (!has_good_end || !std::all_of(digits.begin(), digits.end(), is_digit)) {
        document.fail(json_path, "is a data URI whose base64 is broken; it may be truncated");
    }
    return digits;
}

Bytes decode_base64(std::string_view digits) {
    Bytes bytes;
    bytes.reserve(digits.size() * 3 / 4);
    unsigned gathered = 0;
    int bits = 0;
    for (const char c : digits) {
        gathered = (gathered << 6 | digit_value(c)) & 0xFFFFU;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(std::byte(gathered >> bits & 255U));
    }
    return bytes;
}

}  // namespace tandem::gltf

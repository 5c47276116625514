#include "tandem/gltf/buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include "tandem/gltf/uris.h"

namespace tandem::gltf {

namespace {

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
    [[nodiscard]] std::string uri_path() const { return fmt::format("buffers[{}].uri", index_); }
    [[noreturn]] void fail(std::string_view what) const { document_.fail(uri_path(), what); }

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
        const std::string_view digits = base64_digits(document_, uri_path(), uri.substr(header->size()));
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
        const LocatedFile located = locate_beside(document_, uri_path(), uri);
        require_bytes(located.bytes, "the file");
        source_.place = BufferSource::Place::file;
        source_.file = located.path;
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

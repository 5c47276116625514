#include "tandem/gltf/images.h"

#include <fmt/format.h>

#include "tandem/error/error.h"
#include "tandem/film/texels.h"
#include "tandem/gltf/uris.h"

namespace tandem::gltf {

namespace {

/// Of an image's file. A texture of the largest size takes no more when it is not compressed at all.
constexpr std::uintmax_t most_bytes = std::uintmax_t{5} << 28;

class ImageReader {
  public:
    ImageReader(const Source& source, std::size_t index)
        : document_(source.document),
          model_(source.model),
          image_(source.document.json["images"][index]),
          path_(fmt::format("images[{}]", index)) {}

    Image run() {
        const Json* uri = find(image_, "uri");
        const Json* view = find(image_, "bufferView");
        if (uri != nullptr && view != nullptr) document_.fail(path_, "has a uri and a bufferView; keep one");
        if (uri == nullptr && view == nullptr) document_.fail(path_, "has neither a uri nor a bufferView; add one");
        if (view != nullptr) return in_view(view->get<std::size_t>());
        const auto& text = uri->get_ref<const std::string&>();
        return text.starts_with("data:") ? in_data_uri(text) : in_file(text);
    }

  private:
    /// `member`: of the image, where the bytes are from. `name`: what messages call them.
    Image decode(std::span<const std::byte> bytes, const char* member, const std::string& name) const {
        try {
            Texels decoded = decode_texels(bytes, name);
            return {image_.value("name", std::string()), decoded.width, decoded.height, std::move(decoded.texels)};
        } catch (const InputError& error) {
            document_.fail(fmt::format("{}.{}", path_, member), error.what());
        }
    }

    Image in_view(std::size_t index) const {
        const Json& view = document_.json["bufferViews"][index];
        const std::vector<unsigned char>& data = model_.buffers[view["buffer"].get<std::size_t>()].data;
        const auto offset = view.value("byteOffset", std::size_t{0});
        const auto length = view["byteLength"].get<std::size_t>();
        if (offset > data.size() || length > data.size() - offset) {
            document_.fail(path_ + ".bufferView", "reaches beyond its buffer");
        }
        return decode(std::as_bytes(std::span(data).subspan(offset, length)), "bufferView",
                      fmt::format("bufferView {}", index));
    }

    Image in_data_uri(std::string_view uri) const {
        const std::string where = path_ + ".uri";
        for (const std::string_view header : {"data:image/png;base64,", "data:image/jpeg;base64,"}) {
            if (!uri.starts_with(header)) continue;
            const auto digits = base64_digits(document_, where, uri.substr(header.size()));
            return decode(decode_base64(digits), "uri", "data URI");
        }
        document_.fail(where,
                       "is a data URI that does not begin with 'data:image/png;base64,' or 'data:image/jpeg;base64,'");
    }

    Image in_file(const std::string& uri) const {
        const std::string where = path_ + ".uri";
        const LocatedFile located = locate_beside(document_, where, uri);
        if (located.bytes > most_bytes) document_.fail(where, fmt::format("has {} bytes, too many", located.bytes));
        Bytes bytes;
        try {
            bytes = read_file(located.path.string());
        } catch (const InputError& error) {
            document_.fail(where, error.what());
        }
        return decode(bytes, "uri", located.path.filename().string());
    }

    const Document& document_;
    const tinygltf::Model& model_;
    const Json& image_;
    std::string path_;
};

}  // namespace

Image read_image(const Source& source, std::size_t index) { return ImageReader(source, index).run(); }

}  // namespace tandem::gltf

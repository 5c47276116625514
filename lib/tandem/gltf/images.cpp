#include "tandem/gltf/images.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/uris.h"
#include "tandem/images/texel_rows.h"

namespace tandem::gltf {

namespace {

/// Size limit of an image file: that of an uncompressed texture of the largest size.
constexpr std::uintmax_t most_image_bytes = std::uintmax_t{5} << 28;

class ImageReader {
  public:
    ImageReader(const Source& source, std::size_t index)
        : source_(source),
          document_(source.document),
          image_(source.document.json["images"][index]),
          path_(fmt::format("images[{}]", index)) {}

    EncodedImage run() {
        find_bytes();
        as_flaw(document_, result_.json_path, [&] { result_.size = texel_size(result_.bytes, result_.name); });
        return std::move(result_);
    }

    /// Runs `call`; its InputErrors become flaws at `json_path`.
    template <class Call>
    static void as_flaw(const Document& document, const std::string& json_path, Call call) {
        try {
            call();
        } catch (const InputError& error) {
            document.fail(json_path, error.what());
        }
    }

  private:
    void find_bytes() {
        if (const Json* view = find(image_, "bufferView")) return in_view(view->get<std::size_t>());
        const Json* uri = find(image_, "uri");
        if (uri == nullptr) document_.fail(path_, "has neither a uri nor a bufferView; add one");
        result_.json_path = path_ + ".uri";
        const auto& text = uri->get_ref<const std::string&>();
        if (text.starts_with("data:")) return in_data_uri(text);
        in_file(text);
    }

    void in_view(std::size_t index) {
        const Json& view = document_.json["bufferViews"][index];
        const auto buffer = view["buffer"].get<std::size_t>();
        const auto offset = view.value("byteOffset", std::size_t{0});
        result_.json_path = path_ + ".bufferView";
        result_.name = fmt::format("bufferView {}", index);
        result_.place = fmt::format("{} {}", buffer, offset);
        result_.bytes = source_.buffers[buffer].subspan(offset, view["byteLength"].get<std::size_t>());
    }

    void in_data_uri(std::string_view uri) {
        result_.name = "data URI";
        result_.storage = decode_base64(base64_digits(document_, result_.json_path, uri));
        result_.bytes = result_.storage;
    }

    void in_file(const std::string& uri) {
        const LocatedFile located = locate_beside(document_, result_.json_path, uri);
        if (located.bytes > most_image_bytes) {
            document_.fail(result_.json_path,
                           fmt::format("has {} bytes, more than an image may have; make it smaller", located.bytes));
        }
        result_.name = located.path.filename().string();
        result_.place = located.path.string();
        result_.storage = read_beside(document_, result_.json_path, located.path);
        result_.bytes = result_.storage;
    }

    const Source& source_;
    const Document& document_;
    const Json& image_;
    std::string path_;
    EncodedImage result_;
};

}  // namespace

EncodedImage read_image(const Source& source, std::size_t index) { return ImageReader(source, index).run(); }

Image decode_image(const Source& source, std::size_t index, const EncodedImage& encoded, unsigned shift) {
    Image image;
    image.name = source.document.json["images"][index].value("name", std::string());
    ImageReader::as_flaw(source.document, encoded.json_path, [&] {
        Texels decoded = decode_texels(encoded.bytes, encoded.name, shift);
        image.width = decoded.width;
        image.height = decoded.height;
        image.texels = std::move(decoded.texels);
    });
    return image;
}

void halve(Image& image) {
    TexelRows rows(image.width, image.height, 1);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        rows.add(reinterpret_cast<const std::uint8_t*>(&image.texels[std::size_t{y} * image.width]));
    }
    Texels halved = rows.take();
    image.width = halved.width;
    image.height = halved.height;
    image.texels = std::move(halved.texels);
}

}  // namespace tandem::gltf

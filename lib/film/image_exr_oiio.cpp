/// EXR: the only include of OpenImageIO.

// OpenImageIO's headers compile a copy of fmt into this file. Under the usual names it would stand in for libfmt, and
// every program that formats a string would load OpenImageIO and the 200 libraries behind it.
#define FMT_BEGIN_NAMESPACE \
    namespace fmt {         \
    inline namespace tandem_exr {
#define FMT_END_NAMESPACE \
    }                     \
    }
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>

#include "tandem/film/decode_checks.h"
#include "tandem/film/exr_header.h"
#include "tandem/film/image_codecs.h"

namespace tandem {

namespace {

/// Tells OpenImageIO the format; nothing of that name is opened.
constexpr const char* in_memory = "memory.exr";

/// The first of the three channels to read, or of the one channel there is.
int first_channel(const OIIO::ImageSpec& spec, const std::string& name) {
    const auto& channels = spec.channelnames;
    const std::string rgb[] = {"R", "G", "B"};
    const auto at = std::search(channels.begin(), channels.end(), std::begin(rgb), std::end(rgb));
    if (at != channels.end()) return static_cast<int>(at - channels.begin());
    if (channels.size() == 1) return 0;
    fail_decoding(name, "EXR", "there are no channels R, G, B among its " + std::to_string(channels.size()));
}

}  // namespace

void check_exr_support() {}

Bytes encode_exr(const FloatImage& image, const ImageMetadata& metadata) {
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zips:1");
    spec.attribute("DateTime", "");  // else the time of writing: equal films are to give equal files
    for (const auto& [key, value] : to_text(metadata)) spec.attribute(key, value);
    OIIO::Filesystem::IOVecOutput memory;
    const auto output = OIIO::ImageOutput::create(in_memory, &memory);
    if (!output) throw std::runtime_error("OpenImageIO has no EXR writer: " + OIIO::geterror());
    if (!output->open(in_memory, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()) ||
        !output->close()) {
        throw std::runtime_error("OpenImageIO cannot encode the EXR image: " + output->geterror());
    }
    const auto bytes = std::as_bytes(std::span(memory.buffer()));
    return {bytes.begin(), bytes.end()};
}

DecodedImage decode_exr(std::span<const std::byte> bytes, const std::string& name) {
    check_exr_header(bytes, name);
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::open(in_memory, nullptr, &memory);
    if (!input) fail_decoding(name, "EXR", OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();

    DecodedImage result;
    result.format = ImageFormat::exr;
    result.image = {spec.width, spec.height, {}};
    const int first = first_channel(spec, name);
    const std::size_t channels = spec.nchannels == 1 ? 1 : 3;
    std::vector<float> raw(channels * pixel_count(result.image));
    if (!input->read_image(0, 0, first, first + static_cast<int>(channels), OIIO::TypeDesc::FLOAT, raw.data())) {
        fail_decoding(name, "EXR", input->geterror());
    }
    result.image.pixels.resize(pixel_count(result.image));
    for (std::size_t i = 0; i < result.image.pixels.size(); ++i) {
        const float* value = &raw[channels * i];
        result.image.pixels[i] = {value[0], value[channels / 2], value[channels - 1]};
    }

    MetadataText text;
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        if (attribute.type() == OIIO::TypeString) text.emplace_back(attribute.name().string(), attribute.get_string());
    }
    result.metadata = metadata_from_text(text);
    return result;
}

}  // namespace tandem

/// EXR files: the only includes of OpenEXR.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <cstring>
#include <stdexcept>
#include <string>

#include "tandem/base/error.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/decode_checks.h"
#include "tandem/images/exr_header.h"
#include "tandem/images/image_codecs.h"

namespace tandem {

namespace {

/// Keeps OpenEXR from starting threads: the callers have enough threads.
constexpr int no_threads = 0;

class MemoryInput final : public Imf::IStream {
  public:
    MemoryInput(std::span<const std::byte> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

    bool read(char to[], int size) override {
        if (size < 0 || static_cast<std::size_t>(size) > bytes_.size() - at_) throw std::runtime_error("it is cut off");
        std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(size));
        at_ += static_cast<std::size_t>(size);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) throw std::runtime_error("its table of offsets points beyond its end");
        at_ = position;
    }

  private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

class MemoryOutput final : public Imf::OStream {
  public:
    explicit MemoryOutput(Bytes& bytes) : OStream("memory"), bytes_(bytes) {}

    void write(const char from[], int size) override {
        const std::size_t end = at_ + static_cast<std::size_t>(size);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, from, static_cast<std::size_t>(size));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }

  private:
    Bytes& bytes_;
    std::size_t at_ = 0;
};

/// `channel` of the file is the float at `first` in the first pixel.
void add_slice(Imf::FrameBuffer& frame, const char* channel, const float* first, const Imath::Box2i& window) {
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x) + 1;
    frame.insert(channel, Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(Vec3f), width * sizeof(Vec3f)));
}

void add_rgb(Imf::FrameBuffer& frame, const Vec3f& pixel, const Imath::Box2i& window) {
    add_slice(frame, "R", &pixel.x, window);
    add_slice(frame, "G", &pixel.y, window);
    add_slice(frame, "B", &pixel.z, window);
}

/// A pixel has one 32-bit value per channel, adjacent in memory.
void add_plane(Imf::Header& header, Imf::FrameBuffer& frame, const PlaneImage& plane) {
    const std::vector<std::string>& channels = info_of(plane.plane).channels;
    const Imath::Box2i& window = header.dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x) + 1;
    const auto add = [&](Imf::PixelType type, const auto* values) {
        const std::size_t step = channels.size() * sizeof(*values);
        for (std::size_t i = 0; i < channels.size(); ++i) {
            header.channels().insert(channels[i], Imf::Channel(type));
            frame.insert(channels[i], Imf::Slice::Make(type, values + i, window, step, width * step));
        }
    };
    plane.numbers.empty() ? add(Imf::FLOAT, plane.values.data()) : add(Imf::UINT, plane.numbers.data());
}

void check_sampling(const Imf::FrameBuffer& frame, const Imf::ChannelList& channels) {
    for (auto slice = frame.begin(); slice != frame.end(); ++slice) {
        const Imf::Channel& channel = channels[slice.name()];
        if (channel.xSampling == 1 && channel.ySampling == 1) continue;
        throw std::runtime_error(std::string("channel ") + slice.name() + " does not have a value for every pixel");
    }
}

void read_pixels(Imf::MultiPartInputFile& file, const Imf::FrameBuffer& frame) {
    const Imath::Box2i& window = file.header(0).dataWindow();
    if (file.header(0).type() == Imf::TILEDIMAGE) {
        // not as scan lines, for which OpenEXR would keep a whole row of tiles in memory
        Imf::TiledInputPart part(file, 0);
        part.setFrameBuffer(frame);
        part.readTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
    } else {
        Imf::InputPart part(file, 0);
        part.setFrameBuffer(frame);
        part.readPixels(window.min.y, window.max.y);
    }
}

/// The first part, in its data window.
FloatImage read_image(Imf::MultiPartInputFile& file) {
    const Imf::ChannelList& channels = file.header(0).channels();
    const Imath::Box2i& window = file.header(0).dataWindow();
    FloatImage image{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
    image.pixels.resize(pixel_count(image));

    Imf::FrameBuffer frame;
    const bool rgb = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    int count = 0;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) ++count;
    if (rgb) {
        add_rgb(frame, image.pixels[0], window);
    } else if (count == 1) {
        add_slice(frame, channels.begin().name(), &image.pixels[0].x, window);
    } else {
        throw std::runtime_error("there are no channels R, G, B among its " + std::to_string(count));
    }
    check_sampling(frame, channels);
    read_pixels(file, frame);
    if (!rgb) {
        for (Vec3f& pixel : image.pixels) pixel = {pixel.x, pixel.x, pixel.x};
    }
    return image;
}

MetadataText string_attributes(const Imf::Header& header) {
    MetadataText text;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* value = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (value != nullptr) text.emplace_back(attribute.name(), value->value());
    }
    return text;
}

}  // namespace

void check_exr_support() {}

Bytes encode_exr(const FloatImage& image, const ImageMetadata& metadata, std::span<const PlaneImage> planes) {
    Bytes bytes;
    try {
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.zipCompressionLevel() = 1;
        for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        for (const auto& [key, value] : to_text(metadata)) header.insert(key, Imf::StringAttribute(value));
        Imf::FrameBuffer frame;
        add_rgb(frame, image.pixels.at(0), header.dataWindow());
        for (const PlaneImage& plane : planes) add_plane(header, frame, plane);
        MemoryOutput memory(bytes);
        Imf::OutputFile file(memory, header, no_threads);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw std::runtime_error(std::string("OpenEXR cannot encode the EXR image: ") + error.what());
    }
    return bytes;
}

DecodedImage decode_exr(std::span<const std::byte> bytes, const std::string& name) {
    check_exr_header(bytes, name);
    DecodedImage result;
    result.format = ImageFormat::exr;
    MetadataText text;
    try {
        MemoryInput memory(bytes, name);
        constexpr bool reconstruct_offsets = false;  // for incomplete files
        Imf::MultiPartInputFile file(memory, no_threads, reconstruct_offsets);
        result.image = read_image(file);
        text = string_attributes(file.header(0));
    } catch (const std::exception& error) {
        fail_decoding(name, "EXR", error.what());
    }
    result.metadata = metadata_from_text(text);
    return result;
}

}  // namespace tandem

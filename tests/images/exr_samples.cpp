#include "images/exr_samples.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <cstdint>
#include <utility>

#include "images/sample_images.h"

namespace tandem::test {

namespace {

const std::pair<const char*, Imf::Compression> compressions[] = {
    {"none", Imf::NO_COMPRESSION},  {"rle", Imf::RLE_COMPRESSION},   {"zips", Imf::ZIPS_COMPRESSION},
    {"zip", Imf::ZIP_COMPRESSION},  {"piz", Imf::PIZ_COMPRESSION},   {"pxr24", Imf::PXR24_COMPRESSION},
    {"b44", Imf::B44_COMPRESSION},  {"b44a", Imf::B44A_COMPRESSION}, {"dwaa", Imf::DWAA_COMPRESSION},
    {"dwab", Imf::DWAB_COMPRESSION}};

Imf::PixelType type_of(ExrValues values) {
    return values == ExrValues::whole ? Imf::UINT : values == ExrValues::half ? Imf::HALF : Imf::FLOAT;
}

Imf::LevelMode levels_of(ExrLayout layout) {
    if (layout == ExrLayout::mip_map) return Imf::MIPMAP_LEVELS;
    return layout == ExrLayout::rip_map ? Imf::RIPMAP_LEVELS : Imf::ONE_LEVEL;
}

/// Of the first channel and the others.
int sampling_of(const ExrOptions& options, std::size_t channel) { return channel == 0 ? options.sampling : 1; }

Imf::Header header_of(const FloatImage& image, const ExrOptions& options, const char* name) {
    const Imath::V2i corner(options.left, options.top);
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}),
                       Imath::Box2i(corner, corner + Imath::V2i(image.width - 1, image.height - 1)));
    header.setName(name);
    for (const auto& [known, compression] : compressions) {
        if (known == options.compression) header.compression() = compression;
    }
    header.lineOrder() = options.bottom_up ? Imf::DECREASING_Y : Imf::INCREASING_Y;
    header.setType(Imf::SCANLINEIMAGE);
    if (options.layout != ExrLayout::scan_lines) {
        header.setType(Imf::TILEDIMAGE);
        header.setTileDescription(Imf::TileDescription(4, 3, levels_of(options.layout)));
    }
    for (std::size_t c = 0; c < options.channels.size(); ++c) {
        const int sampling = sampling_of(options, c);
        header.channels().insert(options.channels[c], Imf::Channel(type_of(options.values), sampling, sampling));
    }
    return header;
}

/// `Value` is what the file holds.
template <class Value>
void write_part(Imf::MultiPartOutputFile& file, int number, const FloatImage& image, const ExrOptions& options) {
    const Imath::Box2i& window = file.header(number).dataWindow();
    std::vector<std::vector<Value>> planes(options.channels.size());
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < planes.size(); ++c) {
        for (const Vec3f& pixel : image.pixels) {
            const float coordinates[] = {pixel.x, pixel.y, pixel.z};
            planes[c].push_back(static_cast<Value>(coordinates[(c + static_cast<std::size_t>(number)) % 3]));
        }
        const int sampling = sampling_of(options, c);
        frame.insert(options.channels[c],
                     Imf::Slice::Make(type_of(options.values), planes[c].data(), window, 0, 0, sampling, sampling));
    }
    if (options.layout == ExrLayout::scan_lines) {
        Imf::OutputPart part(file, number);
        part.setFrameBuffer(frame);
        part.writePixels(image.height);
        return;
    }
    // the smaller levels are corners of the picture
    Imf::TiledOutputPart part(file, number);
    part.setFrameBuffer(frame);
    for (int y = 0; y < part.numYLevels(); ++y) {
        for (int x = 0; x < part.numXLevels(); ++x) {
            if (!part.isValidLevel(x, y)) continue;
            part.writeTiles(0, part.numXTiles(x) - 1, 0, part.numYTiles(y) - 1, x, y);
        }
    }
}

/// `write(file)` writes the parts.
template <class Write>
Bytes write_parts(const std::vector<Imf::Header>& headers, Write write) {
    Imf::StdOSStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
        write(file);
    }
    return bytes_of(stream.str());
}

}  // namespace

std::vector<std::string> exr_compressions() {
    std::vector<std::string> names;
    for (const auto& [name, compression] : compressions) names.emplace_back(name);
    return names;
}

Bytes write_exr(const FloatImage& image, const ExrOptions& options) {
    std::vector<Imf::Header> headers = {header_of(image, options, "first")};
    if (options.multipart) headers.push_back(header_of(image, options, "second"));
    return write_parts(headers, [&](Imf::MultiPartOutputFile& file) {
        for (int part = 0; part < file.parts(); ++part) {
            if (options.values == ExrValues::whole) write_part<unsigned int>(file, part, image, options);
            if (options.values == ExrValues::half) write_part<half>(file, part, image, options);
            if (options.values == ExrValues::single) write_part<float>(file, part, image, options);
        }
    });
}

Bytes write_deep_exr(bool multipart) {
    const FloatImage image = exr_ramp(2, 2);
    std::vector<Imf::Header> headers = {header_of(image, {.compression = "zips"}, "first")};
    headers[0].setType(Imf::DEEPSCANLINE);
    if (multipart) headers.push_back(header_of(image, {}, "second"));
    return write_parts(headers, [&](Imf::MultiPartOutputFile& file) {
        std::vector<unsigned int> counts(4, 1);
        half sample(1.0F);
        std::vector<half*> samples(4, &sample);
        const Imath::Box2i& window = file.header(0).dataWindow();
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), window));
        for (const char* channel : {"R", "G", "B"}) {
            frame.insert(channel, Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(samples.data()), sizeof(half*),
                                                 2 * sizeof(half*), sizeof(half)));
        }
        Imf::DeepScanLineOutputPart part(file, 0);
        part.setFrameBuffer(frame);
        part.writePixels(2);
        if (multipart) write_part<half>(file, 1, image, {});
    });
}

ExrChannels read_exr_channels(const std::string& path) {
    Imf::InputFile file(path.c_str(), 0);
    const Imath::Box2i& window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x) + 1;
    const auto height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y) + 1;
    ExrChannels channels;
    Imf::FrameBuffer frame;
    const Imf::ChannelList& list = file.header().channels();
    for (auto channel = list.begin(); channel != list.end(); ++channel) {
        const auto add = [&](auto& values) {
            values.resize(width * height);
            const std::size_t step = sizeof(values[0]);
            const Imf::PixelType type = channel.channel().type;
            frame.insert(channel.name(), Imf::Slice::Make(type, values.data(), window, step, width * step));
        };
        channel.channel().type == Imf::UINT ? add(channels.numbers[channel.name()])
                                            : add(channels.floats[channel.name()]);
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return channels;
}

FloatImage exr_ramp(int width, int height) {
    FloatImage image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.pixels.emplace_back(static_cast<float>(64 + x), static_cast<float>(96 + y),
                                      static_cast<float>(128 + x + y));
        }
    }
    return image;
}

}  // namespace tandem::test

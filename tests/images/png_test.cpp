#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "images/sample_images.h"
#include "support/random.h"
#include "tandem/images/fast_deflate.h"
#include "tandem/images/png_encoder.h"
#include "tandem/images/tone_curve.h"

namespace tandem {
namespace {

using namespace test;

TEST(Png, RoundTripAtEveryLevel) {
    const ByteImage image = sample_bytes(61, 23);
    for (int level = 0; level <= 9; ++level) {
        const DecodedImage decoded = decode_png(encode_png(image, sample_metadata(61, 23), level), "memory");
        EXPECT_EQ(decoded.format, ImageFormat::png);
        EXPECT_EQ(decoded.display, sample_display);
        EXPECT_EQ(tone_map(decoded.image, sample_display).image.values, image.values) << "level " << level;
        ASSERT_TRUE(decoded.metadata);
        EXPECT_EQ(*decoded.metadata, sample_metadata(61, 23));
    }
}

/// The bytes as libpng's simplified interface reads them.
ByteImage read_by_libpng(const Bytes& bytes) {
    png_image reader = {};
    reader.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()) == 0) {
        ADD_FAILURE() << reader.message;
        return {};
    }
    EXPECT_EQ(reader.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    ByteImage image{static_cast<int>(reader.width), static_cast<int>(reader.height), {}};
    image.values.resize(PNG_IMAGE_SIZE(reader));
    EXPECT_NE(png_image_finish_read(&reader, nullptr, image.values.data(), 0, nullptr), 0) << reader.message;
    return image;
}

void expect_libpng_reads(const ByteImage& image, int level, const std::string& what) {
    SCOPED_TRACE(what + " at level " + std::to_string(level));
    const ByteImage read = read_by_libpng(encode_png(image, sample_metadata(image.width, image.height), level));
    EXPECT_EQ(read.width, image.width);
    EXPECT_EQ(read.height, image.height);
    EXPECT_TRUE(read.values == image.values) << "libpng reads other pixels";
}

TEST(Png, IsReadByLibpngsSimplifiedInterface) {
    // 21845 pixels make a row of 64 KiB, the size of a band of rows, and 87381 one of 256 KiB, the size of a strip;
    // noise is longer compressed than it was
    constexpr std::pair<int, int> sizes[] = {{1, 1},     {2, 1},     {1, 2},     {1, 30001},  {30001, 1}, {19, 40},
                                             {21845, 2}, {21846, 3}, {21845, 9}, {1021, 400}, {87381, 3}, {87382, 2}};
    for (const auto& [width, height] : sizes) {
        const std::string size = std::to_string(width) + " x " + std::to_string(height);
        for (const int level : {0, 1, 2}) {
            const ByteImage noise = sample_bytes(width, height);
            expect_libpng_reads(noise, level, "noise of " + size);
            expect_libpng_reads({width, height, std::vector<std::uint8_t>(noise.values.size(), 200)}, level,
                                "one colour of " + size);
        }
    }
}

TEST(Png, KeepsPicturesOfRunsAndNoise) {
    for (std::uint64_t picture = 0; picture < 40; ++picture) {
        Random random(picture);
        const auto at_most = [&](std::uint32_t most) { return 1 + random.below(most); };
        ByteImage image{static_cast<int>(at_most(700)), static_cast<int>(at_most(90)), {}};
        while (image.values.size() < 3 * pixel_count(image)) {
            const std::size_t run = at_most(random.below(4) == 0 ? 5000 : 8);
            image.values.insert(image.values.end(), run, static_cast<std::uint8_t>(random.below(256)));
        }
        image.values.resize(3 * pixel_count(image));
        expect_libpng_reads(image, 1, "Random(" + std::to_string(picture) + ")");
    }
}

TEST(Png, HasTheSameBytesHoweverManyThreadsEncodeIt) {
    const ByteImage image = sample_bytes(1000, 901);
    const ImageMetadata metadata = sample_metadata(1000, 901);
    for (const int level : {1, 2}) {
        const Bytes expected = encode_png(image, metadata, level);
        for (const std::size_t thread_count : {1, 2, 5}) {
            PngEncoder encoder(image, metadata, level);
            std::atomic<std::size_t> rest = encoder.part_count();  // from the last part to the first
            {
                std::vector<std::jthread> threads;
                for (std::size_t i = 0; i < thread_count; ++i) {
                    threads.emplace_back([&] {
                        for (std::size_t part = rest--; part >= 1 && part <= encoder.part_count(); part = rest--) {
                            encoder.encode(part - 1);
                        }
                    });
                }
            }
            EXPECT_TRUE(encoder.finish() == expected) << thread_count << " threads, level " << level;
        }
    }
}

TEST(Png, HasPartsIfItIsLarge) {
    EXPECT_EQ(PngEncoder(sample_bytes(20, 20), {}, 1).part_count(), 1U);
    const ByteImage large = sample_bytes(1000, 900);  // 2.7 MB
    EXPECT_EQ(PngEncoder(large, {}, 1).part_count(), FastDeflate::is_available() ? 11U : 1U);
    EXPECT_EQ(PngEncoder(large, {}, 2).part_count(), 1U);
}

TEST(Png, IsRefusedWithoutPixels) {
    for (const auto& [width, height] : {std::pair{0, 0}, {0, 2}, {2, 0}}) {
        const ByteImage empty{width, height, {}};
        for (const int level : {1, 2}) EXPECT_THROW((void)encode_png(empty, {}, level), std::runtime_error);
    }
}

TEST(Png, IsSmallIfItIsSmooth) {
    ByteImage image{1000, 300, {}};
    for (std::size_t i = 0; i < 3 * pixel_count(image); ++i) {
        image.values.push_back(static_cast<std::uint8_t>(i / 3000 / 2 + i % 3000 / 60));
    }
    const std::size_t size = encode_png(image, {}, 1).size();
    EXPECT_LT(size, image.values.size() / 20) << "level 1";
}

/// The chunks that describe colours.
struct Tags {
    bool srgb, gamma, primaries;
    bool operator==(const Tags&) const = default;
};
Tags tags_of(const Bytes& bytes) {
    const std::string_view text = text_of(bytes);
    const auto has = [&](const char* chunk) { return text.find(chunk) != std::string_view::npos; };
    return {has("sRGB"), has("gAMA"), has("cHRM")};
}

TEST(Png, IsTaggedIfItIsSrgb) {
    ImageMetadata metadata = sample_metadata(2, 2);
    EXPECT_EQ(tags_of(encode_png(sample_bytes(2, 2), metadata, 1)), (Tags{true, true, true}));
    metadata.transfer = "linear";
    EXPECT_EQ(tags_of(encode_png(sample_bytes(2, 2), metadata, 1)), (Tags{false, false, false}));
    metadata.transfer = "";
    EXPECT_EQ(tags_of(encode_png(sample_bytes(2, 2), metadata, 1)), (Tags{false, false, false}));
}

TEST(Png, HoldsItsMetadataAsPlainText) {
    const Bytes bytes = encode_png(sample_bytes(2, 2), sample_metadata(2, 2), 1);
    const std::string expected = std::string("tEXttandem:tier") + '\0' + "strict";
    EXPECT_NE(text_of(bytes).find(expected), std::string_view::npos);
}

/// A file of another program: grey with alpha or 16 bits, written with libpng's simplified interface.
Bytes foreign(png_uint_32 format, const void* pixels) {
    png_image writer = {};
    writer.version = PNG_IMAGE_VERSION;
    writer.width = 1;
    writer.height = 1;
    writer.format = format;
    Bytes bytes(4096);
    png_alloc_size_t size = bytes.size();
    EXPECT_NE(png_image_write_to_memory(&writer, bytes.data(), &size, 0, pixels, 0, nullptr), 0) << writer.message;
    bytes.resize(size);
    return bytes;
}

TEST(Png, ReadsOtherKinds) {
    const std::uint8_t grey_alpha[] = {51, 128};
    const DecodedImage grey = decode_png(foreign(PNG_FORMAT_GA, grey_alpha), "memory");
    EXPECT_FALSE(grey.metadata);
    const std::uint16_t deep[] = {65535, 0, 1};
    const DecodedImage sixteen = decode_png(foreign(PNG_FORMAT_LINEAR_RGB, deep), "memory");
    EXPECT_TRUE(same_bits(sixteen.image, {1, 1, {{1, 0, 1.0F / 65535.0F}}}));
    EXPECT_EQ(sixteen.display, (Display{TransferFunction::linear}));
}

TEST(Png, TakesTheTagOfAForeignFile) {
    const std::uint8_t grey_alpha[] = {51, 128};
    Bytes bytes = foreign(PNG_FORMAT_GA, grey_alpha);
    ASSERT_TRUE(tags_of(bytes).srgb) << "libpng's simplified interface tags what it writes";
    const DecodedImage tagged = decode_png(bytes, "memory");
    EXPECT_EQ(tagged.display, Display{});
    EXPECT_NEAR(tagged.image.pixels.at(0).x, 0.0331048F, 1e-7F);
    // a private chunk in its place: the checksum is over the name too
    const std::size_t at = text_of(bytes).find("sRGB");
    std::memcpy(&bytes[at], "prVt", 4);
    const auto checksum = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(&bytes[at]), 5));
    png_save_uint_32(reinterpret_cast<png_bytep>(&bytes[at + 5]), checksum);
    const DecodedImage untagged = decode_png(bytes, "memory");
    EXPECT_EQ(untagged.display, (Display{TransferFunction::linear}));
    EXPECT_TRUE(same_bits(untagged.image, {1, 1, {{0.2F, 0.2F, 0.2F}}}));
}

TEST(Png, WithoutATransferFunctionInItsMetadataIsLinear) {
    ImageMetadata older = sample_metadata(1, 1);
    older.transfer = "";
    older.exposure_stops = 0;
    const DecodedImage decoded = decode_png(encode_png(ByteImage{1, 1, {51, 0, 255}}, older, 1), "memory");
    EXPECT_TRUE(same_bits(decoded.image, {1, 1, {{0.2F, 0, 1}}}));
}

}  // namespace
}  // namespace tandem

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include "images/sample_images.h"
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

TEST(Png, IsReadByLibpngsSimplifiedInterface) {
    const ByteImage image = sample_bytes(19, 40);
    const Bytes bytes = encode_png(image, sample_metadata(19, 40), 1);
    png_image reader = {};
    reader.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()), 0) << reader.message;
    EXPECT_EQ(reader.width, 19U);
    EXPECT_EQ(reader.height, 40U);
    EXPECT_EQ(reader.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    std::vector<std::uint8_t> values(PNG_IMAGE_SIZE(reader));
    ASSERT_NE(png_image_finish_read(&reader, nullptr, values.data(), 0, nullptr), 0) << reader.message;
    EXPECT_EQ(values, image.values);
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
    const DecodedImage decoded = decode_png(encode_png({1, 1, {51, 0, 255}}, older, 1), "memory");
    EXPECT_TRUE(same_bits(decoded.image, {1, 1, {{0.2F, 0, 1}}}));
}

}  // namespace
}  // namespace tandem

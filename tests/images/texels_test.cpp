// Pictures for textures: right texels out of every kind of file, and an error out of broken ones.
#include "tandem/images/texels.h"

#include <gtest/gtest.h>
#include <png.h>

#if TANDEM_HAS_JPEG
#include <cstdio>

#include <jpeglib.h>
#endif

#include "images/sample_images.h"
#include "support/input_error.h"
#include "support/random.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;

/// A PNG of another program, by libpng's simplified interface.
Bytes png(png_uint_32 format, png_uint_32 width, png_uint_32 height, const void* pixels) {
    png_image writer = {};
    writer.version = PNG_IMAGE_VERSION;
    writer.width = width;
    writer.height = height;
    writer.format = format;
    Bytes bytes(65536);
    png_alloc_size_t size = bytes.size();
    EXPECT_NE(png_image_write_to_memory(&writer, bytes.data(), &size, 0, pixels, 0, nullptr), 0) << writer.message;
    bytes.resize(size);
    return bytes;
}

std::string error_of(const Bytes& bytes) {
    return input_error([&] { (void)decode_texels(bytes, "memory"); });
}

TEST(Texels, OfPngKeepAllChannels) {
    const std::uint8_t rgba[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    const Texels found = decode_texels(png(PNG_FORMAT_RGBA, 1, 4, rgba), "memory");
    EXPECT_EQ(found.width, 1U);
    EXPECT_EQ(found.height, 4U);
    EXPECT_EQ(found.texels, (std::vector<std::uint32_t>{0x04030201U, 0x08070605U, 0x0C0B0A09U, 0x100F0E0DU}));
    const auto one = [](png_uint_32 format, const void* pixel) {
        return decode_texels(png(format, 1, 1, pixel), "memory").texels.at(0);
    };
    EXPECT_EQ(one(PNG_FORMAT_RGB, rgba), 0xFF030201U) << "opaque";
    EXPECT_EQ(one(PNG_FORMAT_GRAY, rgba), 0xFF010101U);
    EXPECT_EQ(one(PNG_FORMAT_GA, rgba), 0x02010101U);
    const std::uint16_t deep[] = {65535, 0, 32768, 65535};
    EXPECT_EQ(one(PNG_FORMAT_LINEAR_RGB_ALPHA, deep), 0xFF8000FFU) << "16 bits";
}

TEST(Texels, ThatAreBrokenAreRefused) {
    const ByteImage image = test::sample_bytes(40, 30);
    const Bytes good = encode_png(image, test::sample_metadata(40, 30), 1);
    EXPECT_EQ(decode_texels(good, "memory").texels.size(), 1200U);
    for (std::size_t length = 0; length < good.size(); length += 7) {
        EXPECT_FALSE(error_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length))).empty());
    }
    for (std::uint64_t number = 0; number < 500; ++number) {
        test::Random random(number);
        Bytes bytes = good;
        for (int i = 0; i < 3; ++i)
            bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = std::byte(random.bits() & 255U);
        try {
            (void)decode_texels(bytes, "memory");  // a change in a place that does not matter
        } catch (const InputError&) {
        }
    }
    EXPECT_TRUE(contains(error_of({}), "is not a PNG or JPEG image, the formats of textures"));
}

Bytes with(Bytes bytes, const std::string& more) {
    for (const char c : more) bytes.push_back(std::byte(c));
    return bytes;
}

/// As libpng itself, and every viewer, has it.
TEST(Texels, OfPngMayHaveBytesBehindTheirEnd) {
    const ByteImage image = test::sample_bytes(4, 3);
    const Bytes good = encode_png(image, test::sample_metadata(4, 3), 1);
    EXPECT_EQ(decode_texels(with(good, "and more"), "memory").texels, decode_texels(good, "memory").texels);
    EXPECT_EQ(decode_png(with(good, "and more"), "memory").image.width, 4);
    EXPECT_TRUE(contains(error_of(Bytes(good.begin(), good.end() - 13)), "is not a readable PNG image"));
}

/// A picture of 5 x 3 pixels with the levels 0, 10, 20, ... in green, and alpha.
std::vector<std::uint8_t> numbered_pixels() {
    std::vector<std::uint8_t> pixels;
    for (std::uint8_t i = 0; i < 15; ++i) pixels.insert(pixels.end(), {7, static_cast<std::uint8_t>(10 * i), 0, 200});
    return pixels;
}

TEST(Texels, AreMeansWhenAPictureIsShrunk) {
    const Bytes bytes = png(PNG_FORMAT_RGBA, 5, 3, numbered_pixels().data());
    const Texels half = decode_texels(bytes, "memory", 1);
    EXPECT_EQ(half.width, 3U);
    EXPECT_EQ(half.height, 2U);
    std::vector<std::uint32_t> green;
    for (const std::uint32_t texel : half.texels) {
        EXPECT_EQ(texel & 0xFFFF00FFU, 0xC8000007U);
        green.push_back(texel >> 8 & 255U);
    }
    EXPECT_EQ(green, (std::vector<std::uint32_t>{30, 50, 65, 105, 125, 140})) << "of 4, 4, 2, 2, 2 and 1 pixels";
    const Texels one = decode_texels(bytes, "memory", 12);
    ASSERT_EQ(one.texels.size(), 1U);
    EXPECT_EQ(one.texels[0], 0xC8004607U);
    EXPECT_EQ(texel_size(bytes, "memory").width, 5U);
    EXPECT_EQ(texel_size(bytes, "memory").height, 3U);
}

/// A PNG as libpng's full interface writes it.
Bytes interlaced_png(png_uint_32 edge, const std::vector<std::uint8_t>& grey) {
    Bytes bytes;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    png_set_write_fn(
        writer, &bytes,
        [](png_structp to, png_bytep data, std::size_t size) {
            auto& all = *static_cast<Bytes*>(png_get_io_ptr(to));
            const auto* start = reinterpret_cast<const std::byte*>(data);
            all.insert(all.end(), start, start + size);
        },
        nullptr);
    png_set_IHDR(writer, info, edge, edge, 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    std::vector<png_bytep> rows;
    for (png_uint_32 y = 0; y < edge; ++y) rows.push_back(const_cast<png_bytep>(&grey[std::size_t{y} * edge]));
    png_set_rows(writer, info, rows.data());
    png_write_png(writer, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&writer, &info);
    return bytes;
}

TEST(Texels, OfInterlacedPngAreTheUpperLeftPixels) {
    for (const png_uint_32 edge : {1U, 7U, 16U, 19U}) {
        std::vector<std::uint8_t> grey(std::size_t{edge} * edge);
        for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(37 * i);
        const Bytes bytes = interlaced_png(edge, grey);
        for (unsigned shift = 0; shift < 6; ++shift) {
            const Texels found = decode_texels(bytes, "memory", shift);
            ASSERT_EQ(found.width, shrunk_edge(edge, shift));
            for (std::size_t y = 0; y < found.height; ++y) {
                for (std::size_t x = 0; x < found.width; ++x) {
                    const std::uint32_t expected = grey[(y << shift) * edge + (x << shift)];
                    ASSERT_EQ(found.texels[y * found.width + x], 0xFF000000U | expected * 0x010101U)
                        << edge << ", shift " << shift << ", at " << x << ", " << y;
                }
            }
        }
    }
}

TEST(Texels, InPlaceOfAPointerOfGitLfsAreMissing) {
    const Bytes pointer = with({}, "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 4\n");
    EXPECT_TRUE(contains(error_of(pointer), "'memory' is a Git LFS pointer, not the file itself; run 'git lfs pull'"));
}

TEST(Texels, ThatClaimToBeHugeAreRefusedBeforeMemoryIsAllocated) {
    // Width and height are at bytes 16 to 23, in a chunk whose checksum libpng looks at: so it is made anew.
    const auto claiming = [](std::uint32_t width, std::uint32_t height) {
        const std::uint8_t grey[] = {7};
        Bytes bytes = png(PNG_FORMAT_GRAY, 1, 1, grey);
        for (unsigned i = 0; i < 4; ++i) {
            bytes[16 + i] = std::byte(width >> (24 - 8 * i) & 255U);
            bytes[20 + i] = std::byte(height >> (24 - 8 * i) & 255U);
        }
        std::uint32_t crc = 0xFFFFFFFFU;
        for (std::size_t i = 12; i < 29; ++i) {
            crc ^= std::to_integer<std::uint32_t>(bytes[i]);
            for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
        }
        for (unsigned i = 0; i < 4; ++i) bytes[29 + i] = std::byte(~crc >> (24 - 8 * i) & 255U);
        return bytes;
    };
    EXPECT_TRUE(contains(error_of(claiming(16385, 1)), "its header claims 16385 x 1 pixels"));
    EXPECT_TRUE(contains(error_of(claiming(16384, 16384)), "the pixels need at least"));
    EXPECT_EQ(decode_texels(claiming(1, 1), "memory").texels.at(0), 0xFF070707U) << "the checksum is right";
}

#if TANDEM_HAS_JPEG

Bytes jpeg(J_COLOR_SPACE space, unsigned edge, bool progressive, const std::vector<std::uint8_t>& pixels) {
    jpeg_compress_struct info = {};
    jpeg_error_mgr errors = {};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &memory, &size);
    info.image_width = info.image_height = edge;
    info.input_components = space == JCS_GRAYSCALE ? 1 : space == JCS_CMYK ? 4 : 3;
    info.in_color_space = space;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    if (progressive) jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    const std::size_t row_bytes = std::size_t{edge} * static_cast<std::size_t>(info.input_components);
    while (info.next_scanline < edge) {
        auto* row = const_cast<std::uint8_t*>(pixels.data()) + info.next_scanline * row_bytes;
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    const auto* begin = reinterpret_cast<const std::byte*>(memory);
    Bytes bytes(begin, begin + size);
    jpeg_destroy_compress(&info);
    std::free(memory);
    return bytes;
}

/// A slope, which JPEG keeps nearly as it is.
std::vector<std::uint8_t> slope(unsigned edge, unsigned channels) {
    std::vector<std::uint8_t> values;
    for (unsigned i = 0; i < edge * edge * channels; ++i)
        values.push_back(static_cast<std::uint8_t>(i / channels / edge * 3));
    return values;
}

TEST(Texels, OfJpegAreThoseThatWentIn) {
    for (const bool progressive : {false, true}) {
        for (const J_COLOR_SPACE space : {JCS_RGB, JCS_GRAYSCALE}) {
            const auto values = slope(20, space == JCS_RGB ? 3 : 1);
            const Texels found = decode_texels(jpeg(space, 20, progressive, values), "memory");
            ASSERT_EQ(found.texels.size(), 400U);
            for (unsigned i = 0; i < 400; ++i) {
                for (const int shift : {0, 8, 16}) {
                    ASSERT_NEAR(static_cast<int>(found.texels[i] >> shift & 255U), static_cast<int>(i / 20 * 3), 2)
                        << i;
                }
                ASSERT_EQ(found.texels[i] >> 24, 255U);
            }
        }
    }
}

TEST(Texels, OfJpegAreShrunkAsOthersAre) {
    for (const bool progressive : {false, true}) {
        const Bytes bytes = jpeg(JCS_GRAYSCALE, 40, progressive, std::vector<std::uint8_t>(1600, 90));
        for (unsigned shift = 0; shift < 7; ++shift) {
            const Texels found = decode_texels(bytes, "memory", shift);
            EXPECT_EQ(found.width, shrunk_edge(40, shift)) << shift;
            EXPECT_EQ(found.height, shrunk_edge(40, shift)) << shift;
            for (const std::uint32_t texel : found.texels) EXPECT_NEAR(static_cast<int>(texel & 255U), 90, 1);
        }
    }
}

/// The scans of a progressive file again and again, as fast as they can be written. They are counted and not decoded.
TEST(Texels, OfJpegInVeryManyPassesAreRefused) {
    const Bytes good = jpeg(JCS_RGB, 1024, true, slope(1024, 3));
    EXPECT_EQ(decode_texels(good, "memory").width, 1024U);
    std::size_t scan = 2;  // where the first scan starts
    const auto at = [&](std::size_t i) { return std::to_integer<std::size_t>(good[i]); };
    while (at(scan + 1) != 0xDA) scan += 2 + at(scan + 2) * 256 + at(scan + 3);
    const std::size_t header = 2 + at(scan + 2) * 256 + at(scan + 3);
    Bytes many(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(scan));
    const auto start = good.begin() + static_cast<std::ptrdiff_t>(scan);
    for (int i = 0; i < 4000; ++i) many.insert(many.end(), start, start + static_cast<std::ptrdiff_t>(header));
    many.insert(many.end(), good.end() - 2, good.end());
    EXPECT_TRUE(contains(error_of(many), "decoding it is the work of "));
}

TEST(Texels, OfBrokenJpegAreRefused) {
    for (const bool progressive : {false, true}) {
        const Bytes good = jpeg(JCS_RGB, 64, progressive, slope(64, 3));
        for (std::size_t length = 3; length + 2 < good.size(); length += 11) {
            EXPECT_TRUE(contains(error_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length))),
                                 "'memory' is not a readable JPEG image: "))
                << "cut off at " << length;
        }
        for (std::uint64_t number = 0; number < 500; ++number) {
            test::Random random(number);
            Bytes bytes = good;
            for (int i = 0; i < 3; ++i) {
                bytes[3 + random.below(static_cast<std::uint32_t>(bytes.size()) - 3)] = std::byte(random.bits() & 255U);
            }
            try {
                (void)decode_texels(bytes, "memory");
            } catch (const InputError&) {
            }
        }
    }
    EXPECT_TRUE(contains(error_of(jpeg(JCS_CMYK, 8, false, slope(8, 4))), "its colours are neither grey nor YCbCr"));
}

TEST(Texels, OfJpegThatClaimToBeHugeAreRefused) {
    for (const auto& [edge, reason] :
         {std::pair{16000U, "the pixels need at least"}, std::pair{65000U, "its header claims 65000 x 65000"}}) {
        Bytes bytes = jpeg(JCS_GRAYSCALE, 8, false, slope(8, 1));
        std::size_t at = 2;  // the frame header: FF C0, length, precision, height, width
        while (bytes[at + 1] != std::byte{0xC0}) {
            at += 2 + std::to_integer<std::size_t>(bytes[at + 2]) * 256 + std::to_integer<std::size_t>(bytes[at + 3]);
        }
        bytes[at + 5] = bytes[at + 7] = std::byte(edge >> 8);
        bytes[at + 6] = bytes[at + 8] = std::byte(edge & 255U);
        EXPECT_TRUE(contains(error_of(bytes), reason));
    }
}

#else

TEST(Texels, OfJpegNeedLibjpeg) {
    const Bytes bytes = {std::byte{0xFF}, std::byte{0xD8}, std::byte{0xFF}};
    EXPECT_THROW((void)decode_texels(bytes, "memory"), EnvironmentError);
}

#endif

}  // namespace
}  // namespace tandem

/// Small EXR files of every kind, cut off, forged and damaged: an InputError or a picture, and no more memory than a
/// file of that size may take.
#include <gtest/gtest.h>

#include <algorithm>

#include "images/exr_samples.h"
#include "images/sample_images.h"
#include "support/peak_memory.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;

const FloatImage picture = exr_ramp(5, 4);

struct Sample {
    std::string name;
    Bytes bytes;
};

/// One file of every compression in lines and in tiles, one with levels, and one of two parts.
std::vector<Sample> samples() {
    std::vector<Sample> result;
    for (const std::string& compression : exr_compressions()) {
        for (const ExrLayout layout : {ExrLayout::scan_lines, ExrLayout::tiles}) {
            result.push_back({compression + (layout == ExrLayout::tiles ? " in tiles" : " in lines"),
                              write_exr(picture, {.compression = compression, .layout = layout})});
        }
    }
    result.push_back({"mip map", write_exr(picture, {.layout = ExrLayout::mip_map})});
    result.push_back({"two parts", write_exr(picture, {.multipart = true})});
    return result;
}

/// Whether it is a picture; if not, decoding has to end with an InputError that names the file.
bool is_picture(const Bytes& bytes, const std::string& what) {
    try {
        const FloatImage image = decode_exr(bytes, "some.exr").image;
        EXPECT_EQ(image.pixels.size(), pixel_count(image)) << what;
        return true;
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("'some.exr' is not a readable EXR image: ")) << error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << what << ": " << error.what();
    }
    return false;
}

TEST(MalformedExr, CutOffAnywhere) {
    for (const auto& [name, whole] : samples()) {
        // what is behind the picture, smaller levels or other parts, is not read
        const bool more = name == "mip map" || name == "two parts";
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const std::string what = name + ", cut off after " + std::to_string(size) + " bytes";
            const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            if (!is_picture(part, what)) continue;
            EXPECT_TRUE(more && same_bits(decode_exr(part, "x").image, decode_exr(whole, "x").image)) << what;
        }
    }
}

TEST(MalformedExr, WithAnyBitFlipped) {
    const long before = peak_memory();
    for (auto& [name, bytes] : samples()) {
        for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
            const std::byte mask{static_cast<unsigned char>(1U << (bit % 8))};
            bytes[bit / 8] ^= mask;
            is_picture(bytes, name + ", bit " + std::to_string(bit));
            bytes[bit / 8] ^= mask;
        }
    }
    EXPECT_LT(peak_memory() - before, 256) << "some file made its reader allocate hundreds of MiB";
}

TEST(MalformedExr, DamagedInSeveralPlaces) {
    const long before = peak_memory();
    for (const auto& [name, whole] : samples()) {
        for (unsigned int seed = 0; seed < 500; ++seed) {
            std::mt19937 random(seed);
            Bytes damaged = whole;
            for (unsigned long count = 2 + random() % 6; count > 0; --count) {
                damaged[random() % damaged.size()] = static_cast<std::byte>(random() & 0xFFU);
            }
            is_picture(damaged, name + ", seed " + std::to_string(seed));
        }
    }
    EXPECT_LT(peak_memory() - before, 256) << "some file made its reader allocate hundreds of MiB";
}

/// The file with 32-bit numbers, little endian, from `offset` on in the value of its first such attribute.
Bytes forged(Bytes bytes, std::string_view attribute, std::ptrdiff_t offset,
             const std::vector<std::uint32_t>& numbers) {
    const std::size_t name = text_of(bytes).find(std::string(attribute) + '\0');
    const std::size_t type = text_of(bytes).find('\0', name) + 1;
    const std::size_t size = text_of(bytes).find('\0', type) + 1;
    std::memcpy(bytes.data() + size + sizeof(std::uint32_t) + offset, numbers.data(),
                numbers.size() * sizeof(std::uint32_t));
    return bytes;
}

TEST(MalformedExr, ForgedSizesAreFoundOutBeforeMemoryIsAllocated) {
    const Bytes lines = write_exr(picture, {.compression = "dwab"});
    const Bytes tiles = write_exr(picture, {.layout = ExrLayout::tiles});
    const Bytes parts = write_exr(picture, {.multipart = true});
    const long before = peak_memory();
    for (const auto& [bytes, reason] :
         {std::pair{forged(lines, "dataWindow", 8, {65535, 16383}), "bytes, but"},
          std::pair{forged(lines, "dataWindow", 8, {65536, 3}), "65537 x 4 pixels"},
          std::pair{forged(lines, "dataWindow", 0, {6, 0, 5, 3}), "data window is empty"},
          std::pair{forged(lines, "dataWindow", 8, {4, 65535}), "bytes, but"},
          std::pair{forged(lines, "dataWindow", 8, {65535, 0}), "blocks of lines are too large"},
          std::pair{forged(tiles, "tiles", 0, {0, 3}), "its tiles have no size"},
          std::pair{forged(tiles, "tiles", 0, {65536, 65536}), "its tiles are too large"},
          std::pair{forged(tiles, "tiles", 0, {0xFFFFFFFF, 0xFFFFFFFF}), "its tiles are too large"},
          std::pair{forged(tiles, "tiles", 0, {4096, 4096}), "its tiles or blocks"},
          std::pair{forged(forged(tiles, "tiles", 0, {1, 1}), "dataWindow", 8, {99, 99}), "80000 bytes, but"},
          std::pair{forged(parts, "chunkCount", 0, {0x7FFFFFFF}), "17179869176 bytes, but"}}) {
        const auto message = thrown_message<InputError>([&file = bytes] { (void)decode_exr(file, "some.exr"); });
        EXPECT_NE(message.find(reason), std::string::npos) << message << ", instead of: " << reason;
    }
    EXPECT_LT(peak_memory() - before, 64);
}

TEST(MalformedExr, ForgedAttributesDoNotHideWhatFollows) {
    // OpenEXR passes over these sizes, so it would find other attributes than the check of the header
    const Bytes bytes = write_exr(picture, {});
    for (const char* attribute : {"channels", "compression", "dataWindow", "pixelAspectRatio", "screenWindowCenter"}) {
        for (const std::uint32_t size : {0U, 3U, 215U}) {
            const auto message =
                thrown_message<InputError>([&] { (void)decode_exr(forged(bytes, attribute, -4, {size}), "some.exr"); });
            EXPECT_FALSE(message.empty()) << attribute << ", size " << size;
        }
    }
    const auto message =
        thrown_message<InputError>([&] { (void)decode_exr(forged(bytes, "dataWindow", -4, {215}), "some.exr"); });
    EXPECT_NE(message.find("an attribute of its header is not of its size"), std::string::npos) << message;
}

TEST(MalformedExr, AFileThatWasNeverFinishedIsRefused) {
    Bytes bytes = write_exr(picture, {.compression = "none"});
    // the table of the offsets of four lines stands before the lines, each of eight bytes and three halves a pixel
    const std::size_t table = bytes.size() - 4 * (8 + 5 * 6) - 4 * 8;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(table), 4 * 8, std::byte{0});
    const auto message = thrown_message<InputError>([&] { (void)decode_exr(bytes, "some.exr"); });
    EXPECT_NE(message.find("missing"), std::string::npos) << message;
}

TEST(MalformedExr, TilesMayBeLargerThanThePicture) {
    const Bytes bytes = write_exr(exr_ramp(1, 1), {.layout = ExrLayout::tiles});
    EXPECT_TRUE(same_bits(decode_exr(bytes, "x").image, exr_ramp(1, 1)));
}

}  // namespace
}  // namespace tandem

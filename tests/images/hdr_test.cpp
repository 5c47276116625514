// Radiance's pictures: what they hold, and files that are cut off or forged.
#include <gtest/gtest.h>

#include <cmath>

#include "images/sample_images.h"
#include "support/input_error.h"
#include "support/pixel_index.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;
using namespace std::string_literals;

const std::string head = "#?RADIANCE\n# made for a test\nFORMAT=32-bit_rle_rgbe\n\n";

std::string resolution(int width, int height) {
    return "-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

std::vector<Vec3f> pixels_of(const std::string& file) { return decode_hdr(bytes_of(file), "the file").image.pixels; }
std::string hdr_error(const std::string& file) {
    return input_error([&] { (void)decode_hdr(bytes_of(file), "the file"); });
}

/// The bytes of a picture of random pixels: with runs where `runs`, of all lengths.
struct Sample {
    std::vector<std::string> pixels;  ///< four bytes each
    int width, height;

    Sample(int w, int h, bool runs) : width(w), height(h) {
        Random random(static_cast<std::uint64_t>(w) * 1000 + static_cast<std::uint64_t>(h));
        std::string pixel = "\x80\x01\x02\x80"s;
        for (int i = 0; i < w * h; ++i) {
            for (char& c : pixel) {
                if (!runs || random.below(40) == 0) c = static_cast<char>(random.below(256));
            }
            pixel[0] = static_cast<char>(pixel[0] | 4);  // neither 1 nor 2
            pixels.push_back(pixel);
        }
    }
    [[nodiscard]] std::string flat() const {
        std::string text;
        for (const std::string& pixel : pixels) text += pixel;
        return text;
    }
    [[nodiscard]] std::string packed() const {
        std::string text;
        for (int y = 0; y < height; ++y) {
            text += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
            for (std::size_t c = 0; c < 4; ++c) {
                const auto value = [&](int x) { return pixels[pixel_index(x, y, width)][c]; };
                for (int x = 0; x < width;) {
                    int run = 1;
                    while (run < 127 && x + run < width && value(x + run) == value(x)) ++run;
                    if (run > 2) {
                        text += {static_cast<char>(128 + run), value(x)};
                        x += run;
                        continue;
                    }
                    const int count = std::min(width - x, 1 + x % 128);
                    text += static_cast<char>(count);
                    for (int i = 0; i < count; ++i) text += value(x++);
                }
            }
        }
        return text;
    }
    [[nodiscard]] Vec3f at(std::size_t i) const {
        const auto byte = [&](std::size_t c) { return static_cast<unsigned char>(pixels[i][c]); };
        const auto value = [&](std::size_t c) {
            return byte(3) == 0 ? 0.0F : static_cast<float>(byte(c) * std::pow(2.0, byte(3) - 136));
        };
        return {value(0), value(1), value(2)};
    }
};

TEST(Hdr, HoldsTheValuesOfItsBytes) {
    const std::vector<Vec3f> found =
        pixels_of(head + resolution(3, 1) + "\x80\x40\x20\x81"s + "\xFF\x01\x00\xFF"s + "\xFF\xFF\xFF\x00"s);
    EXPECT_EQ(found[0], Vec3f(1, 0.5F, 0.25F));
    EXPECT_EQ(found[1], Vec3f(255 * 0x1p119F, 0x1p119F, 0));
    EXPECT_EQ(found[2], Vec3f(0, 0, 0)) << "exponent 0 is black";
    EXPECT_EQ(decode_hdr(bytes_of(head + resolution(1, 1) + "\x80\x40\x20\x81"s), "x").format, ImageFormat::hdr);
}

TEST(Hdr, IsTheSameFlatAndPacked) {
    for (const auto& [width, height, runs] :
         {std::tuple{8, 3, false}, std::tuple{200, 4, true}, std::tuple{700, 3, true}, std::tuple{300, 2, false},
          std::tuple{7, 5, true}, std::tuple{1, 1, false}}) {
        const Sample sample(width, height, runs);
        const std::string start = head + resolution(width, height);
        const std::vector<Vec3f> flat = pixels_of(start + sample.flat());
        ASSERT_EQ(flat.size(), sample.pixels.size());
        for (std::size_t i = 0; i < flat.size(); ++i) ASSERT_EQ(flat[i], sample.at(i)) << width << ", pixel " << i;
        if (width >= 8) {
            EXPECT_EQ(pixels_of(start + sample.packed()), flat) << width;
        }
    }
}

TEST(Hdr, RowsAndPixelsMayGoEitherWay) {
    const std::string data = "\x10\x00\x00\x88"s + "\x20\x00\x00\x88"s + "\x30\x00\x00\x88"s + "\x40\x00\x00\x88"s;
    const auto reds = [&](const std::string& size) {
        std::vector<float> result;
        const std::string file = head + size + "\n" + data;
        for (const Vec3f& pixel : pixels_of(file)) result.push_back(pixel.x);
        return result;
    };
    EXPECT_EQ(reds("-Y 2 +X 2"), (std::vector<float>{16, 32, 48, 64}));
    EXPECT_EQ(reds("+Y 2 +X 2"), (std::vector<float>{48, 64, 16, 32}));
    EXPECT_EQ(reds("-Y 2 -X 2"), (std::vector<float>{32, 16, 64, 48}));
}

TEST(Hdr, ExposureIsTakenOut) {
    const std::string data = resolution(1, 1) + "\x80\x40\x20\x81"s;
    EXPECT_EQ(pixels_of("#?RGBE\nEXPOSURE=2\nEXPOSURE= 4.0 \n\n" + data)[0], Vec3f(0.125F, 0.0625F, 0.03125F));
    EXPECT_EQ(pixels_of("#?RADIANCE\r\nGAMMA=1\r\nPRIMARIES=0 0\r\n\r\n" + data)[0], Vec3f(1, 0.5F, 0.25F));
}

TEST(Hdr, SaysWhatIsWrong) {
    const std::string pixel = "\x80\x40\x20\x81"s;
    using Case = std::pair<std::string, const char*>;
    const std::vector<Case> cases = {
        {"#?", "header is cut off"},
        {"P6\n", "#?"},
        {head, "header is cut off"},
        {head + "-Y 1 +X 1", "header is cut off"},
        {head + "\n", "row by row"},
        {head + "+X 1 -Y 1\n" + pixel, "row by row"},
        {head + "-Y 1\n" + pixel, "row by row"},
        {head + "-Y one +X 1\n" + pixel, "height is 'one'"},
        {head + "-Y 1 +X 1e3\n" + pixel, "width is '1e3'"},
        {head + "-Y 0 +X 1\n", "1 x 0"},
        {head + "-Y 70000 +X 1\n", "1 x 70000"},
        {head + "-Y 65536 +X 16384\n" + pixel, "only 4 exist"},
        {head + "-Y 2 +X 1\n" + pixel, "only 4 exist"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "32-bit_rle_xyze"},
        {"#?RADIANCE\nEXPOSURE=0\n\n" + resolution(1, 1) + pixel, "exposure"},
        {"#?RADIANCE\nEXPOSURE=much\n\n" + resolution(1, 1) + pixel, "exposure is 'much'"},
        {"#?RADIANCE\nEXPOSURE=1e-30\n\n" + resolution(1, 1) + "\xFF\xFF\xFF\xFF"s, "3.4e38"},
        {head + resolution(8, 1) + "\x02\x02\x00\x09"s + std::string(32, 'x'), "a row claims 9"},
        {head + resolution(8, 1) + "\x02\x02\x00\x08\x89\x01"s + std::string(32, 'x'), "beyond the end"},
        {head + resolution(8, 1) + "\x02\x02\x00\x08\x00\x01"s + std::string(32, 'x'), "is empty"},
        {head + resolution(8, 1) + "\x02\x02\x00\x08\x08"s + std::string(7, 'x'), "pixels are cut off"},
        {head + resolution(2, 1) + pixel + "\x01\x01\x01\x05"s, "before 1991"}};
    for (const auto& [file, reason] : cases) EXPECT_TRUE(contains(hdr_error(file), reason));
}

TEST(Hdr, CutOffAnywhereIsAnInputError) {
    const Sample sample(40, 3, true);
    const std::string start = head + resolution(40, 3);
    for (const std::string& data : {sample.flat(), sample.packed()}) {
        const std::string whole = start + data;
        EXPECT_EQ(pixels_of(whole).size(), 120U);
        for (std::size_t size = 0; size < whole.size(); ++size) {
            EXPECT_THROW((void)decode_hdr(bytes_of(whole.substr(0, size)), "x"), InputError) << size;
        }
    }
}

TEST(Hdr, DamagedBytesGiveAnImageOrAnInputError) {
    const Sample sample(40, 3, true);
    const std::string start = head + resolution(40, 3);
    for (const std::string& data : {sample.flat(), sample.packed()}) {
        const std::string whole = start + data;
        for (std::uint64_t seed = 0; seed < 2000; ++seed) {
            Random random(seed);
            std::string damaged = whole;
            for (std::uint32_t count = 1 + random.below(6); count > 0; --count) {
                damaged[random.below(static_cast<std::uint32_t>(whole.size()))] = static_cast<char>(random.below(256));
            }
            try {
                const DecodedImage decoded = decode_hdr(bytes_of(damaged), "x");
                ASSERT_EQ(decoded.image.pixels.size(), pixel_count(decoded.image)) << "seed " << seed;
            } catch (const InputError&) {
            } catch (const std::exception& other) {
                ADD_FAILURE() << "seed " << seed << ": " << other.what();
            }
        }
    }
}

TEST(Hdr, IsToldByItsBytes) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.hdr");
    write_file(path, head + resolution(1, 1) + "\x80\x40\x20\x81"s);
    EXPECT_EQ(read_image(path).image.pixels[0], Vec3f(1, 0.5F, 0.25F));
    EXPECT_TRUE(contains(input_error([&] { (void)format_of(path); }), ".exr")) << "it is not written";
}

}  // namespace
}  // namespace tandem

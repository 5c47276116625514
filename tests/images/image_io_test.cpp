#include "tandem/images/image_io.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "images/sample_images.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/images/tone_curve.h"

namespace tandem {
namespace {

using namespace test;

struct FileKind {
    const char* name;
    bool ppm_text;
    ImageFormat format;
    bool keeps_floats;
};

void PrintTo(const FileKind& kind, std::ostream* out) { *out << kind.name << (kind.ppm_text ? " as text" : ""); }

class ImageFile : public testing::TestWithParam<FileKind> {};

TEST_P(ImageFile, RoundTripWithMetadata) {
    const TemporaryFolder folder;
    const std::string path = folder.file(GetParam().name);
    const FloatImage image = sample_floats(21, 13);
    ImageMetadata given = sample_metadata(0, 0);
    given.transfer = "none that there is";
    given.exposure_stops = 77;
    write_image(path, image, given, {.ppm_text = GetParam().ppm_text, .display = sample_display});
    const DecodedImage read = read_image(path);
    EXPECT_EQ(read.format, GetParam().format);
    ImageMetadata expected = sample_metadata(21, 13);
    if (GetParam().keeps_floats) {
        EXPECT_TRUE(same_bits(read.image, image));
        expected = with_display(expected, {TransferFunction::linear});
        expected.exposure_rule = "";
    } else {
        const ByteImage levels = tone_map(image, sample_display).image;
        EXPECT_EQ(tone_map(read.image, sample_display).image.values, levels.values);
        EXPECT_TRUE(same_bits(read.image, to_float(levels, sample_display)));
    }
    EXPECT_EQ(read.display, display_of(expected));
    ASSERT_TRUE(read.metadata);
    EXPECT_EQ(*read.metadata, expected) << "the size is the image's, the display that of the options";
    EXPECT_EQ(read_metadata(path), read.metadata);
}

TEST_P(ImageFile, IsSrgbUnlessToldOtherwise) {
    const FloatImage image{1, 1, {{0.25F, 0.5F, 1}}};
    const TemporaryFolder folder;
    const std::string path = folder.file(GetParam().name);
    write_image(path, image, {}, {.ppm_text = GetParam().ppm_text});
    const DecodedImage read = read_image(path);
    ASSERT_TRUE(read.metadata);
    EXPECT_EQ(read.metadata->transfer, GetParam().keeps_floats ? "linear" : "srgb");
    EXPECT_NEAR(read.image.pixels[0].x, 0.25F, 0.004F) << "linear, but for the rounding to a level";
    EXPECT_NEAR(read.image.pixels[0].y, 0.5F, 0.004F);
    EXPECT_EQ(read.image.pixels[0].z, 1.0F);
}

TEST_P(ImageFile, AFilmIsWrittenAsItsMeans) {
    const TemporaryFolder folder;
    Film film(4, 2, 3);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) film.sums()[i] = {0.1 * static_cast<double>(i), 1, 2};
    const WriteOptions options = {.ppm_text = GetParam().ppm_text};
    write_image(folder.file(GetParam().name), film, {}, options);
    write_image(folder.file(std::string("b") + GetParam().name), film_to_image(film), {}, options);
    EXPECT_EQ(read_file(folder.file(GetParam().name)), read_file(folder.file(std::string("b") + GetParam().name)));
}

TEST_P(ImageFile, TheEncoderCountsTheNaNThatItLoses) {
    const FloatImage image{2, 1, {{std::bit_cast<float>(0x7FC00000U), 0, 0}, {1, 1, 1}}};
    const EncodedImage encoded = encode_image(image, GetParam().format, {});
    EXPECT_EQ(encoded.nan_values, GetParam().keeps_floats ? 0U : 1U);
}

TEST_P(ImageFile, AFailedWriteNamesThePathAndLeavesNothing) {
    const TemporaryFolder folder;
    const std::string path = folder.file(std::string("none/") + GetParam().name);
    const auto message = thrown_message<InputError>([&] { write_image(path, sample_floats(2, 2), {}); });
    EXPECT_NE(message.find(path), std::string::npos) << message;
    EXPECT_TRUE(folder.names().empty());
}

const FileKind file_kinds[] = {{"a.ppm", false, ImageFormat::ppm, false},
                               {"a.ppm", true, ImageFormat::ppm_text, false},
                               {"a.PNG", false, ImageFormat::png, false},
#if TANDEM_HAS_EXR
                               {"a.exr", false, ImageFormat::exr, true},
#endif
                               {"a.pfm", false, ImageFormat::pfm, true}};

INSTANTIATE_TEST_SUITE_P(Kinds, ImageFile, testing::ValuesIn(file_kinds));

TEST(ImageFiles, OfEqualFilmsAreEqualAtAnyTime) {
    const auto encode_all = [] {
        std::vector<Bytes> files;
        for (const FileKind& kind : file_kinds) {
            files.push_back(encode_image(sample_floats(20, 20), kind.format, sample_metadata(0, 0)).bytes);
        }
        return files;
    };
    const std::vector<Bytes> first = encode_all();
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a time of writing has seconds
    EXPECT_EQ(encode_all(), first);
}

TEST(ImageFileName, TheExtensionDecides) {
    EXPECT_EQ(format_of("a/b.c/x.ppm"), ImageFormat::ppm);
    EXPECT_EQ(format_of("x.PPM", {.ppm_text = true}), ImageFormat::ppm_text);
    EXPECT_EQ(format_of("x.png", {.ppm_text = true}), ImageFormat::png);
    for (const char* path : {"x", "x.jpg", ".png", "png", "x.png/"}) {
        const auto message = thrown_message<InputError>([&] { (void)format_of(path); });
        EXPECT_NE(message.find(".exr"), std::string::npos) << path;
    }
}

TEST(PfmSidecar, CountsOnlyBesideItsOwnBytes) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.pfm");
    write_image(path, sample_floats(3, 3), sample_metadata(0, 0));
    ASSERT_TRUE(read_metadata(path));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.pfm", "a.pfm.txt"}));
    write_file(path, encode_pfm({1, 1, {{1, 2, 3}}}));
    EXPECT_FALSE(read_metadata(path)) << "the metadata of an image that was there before";
    write_image(path, sample_floats(3, 3), sample_metadata(0, 0));
    std::filesystem::remove(path + ".txt");
    EXPECT_FALSE(read_metadata(path));
}

}  // namespace
}  // namespace tandem

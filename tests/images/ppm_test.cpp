#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "images/sample_images.h"
#include "tandem/base/error.h"
#include "tandem/images/tone_curve.h"

namespace tandem {
namespace {

using namespace test;

/// What a reader that knows nothing of Tandem finds: written from the format's man page with iostreams alone.
struct PlainPpm {
    std::string magic;
    std::size_t width = 0, height = 0, most = 0;
    std::vector<int> values;
    std::size_t longest_line = 0;
};

PlainPpm read_plainly(std::string_view file) {
    std::istringstream in{std::string(file)};
    PlainPpm result;
    const auto word = [&] {
        std::string text;
        while (in >> text && text.front() == '#') in.ignore(1 << 20, '\n');
        return text;
    };
    result.magic = word();
    result.width = std::stoul(word());
    result.height = std::stoul(word());
    result.most = std::stoul(word());
    if (result.magic == "P6") {
        in.get();
        for (int c = in.get(); in; c = in.get()) result.values.push_back(c);
        return result;
    }
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        result.longest_line = std::max(result.longest_line, line.size());
        std::istringstream numbers(line);
        for (int value = 0; numbers >> value;) result.values.push_back(value);
    }
    return result;
}

class Ppm : public testing::TestWithParam<ImageFormat> {
  protected:
    static Bytes encode(const ByteImage& image) {
        const auto encode = GetParam() == ImageFormat::ppm_text ? encode_ppm_text : encode_ppm;
        return encode(image, sample_metadata(image.width, image.height));
    }
};

TEST_P(Ppm, IsReadByAPlainReader) {
    const ByteImage image = sample_bytes(37, 29);
    const PlainPpm plain = read_plainly(text_of(encode(image)));
    EXPECT_EQ(plain.magic, GetParam() == ImageFormat::ppm_text ? "P3" : "P6");
    EXPECT_EQ(plain.width, 37U);
    EXPECT_EQ(plain.height, 29U);
    EXPECT_EQ(plain.most, 255U);
    EXPECT_EQ(plain.values, std::vector<int>(image.values.begin(), image.values.end()));
    EXPECT_LE(plain.longest_line, 70U);
}

TEST_P(Ppm, RoundTrip) {
    const ByteImage image = sample_bytes(31, 17);
    const DecodedImage decoded = decode_ppm(encode(image), "memory");
    EXPECT_EQ(decoded.format, GetParam());
    EXPECT_EQ(decoded.display, sample_display);
    EXPECT_EQ(tone_map(decoded.image, sample_display).image.values, image.values);
    ASSERT_TRUE(decoded.metadata);
    EXPECT_EQ(*decoded.metadata, sample_metadata(31, 17));
}

TEST_P(Ppm, TheSmallestImage) {
    const ByteImage image{1, 1, {255, 0, 7}};
    const FloatImage decoded = decode_ppm(encode(image), "memory").image;
    EXPECT_EQ(tone_map(decoded, sample_display).image.values, image.values);
}

INSTANTIATE_TEST_SUITE_P(Formats, Ppm, testing::Values(ImageFormat::ppm_text, ImageFormat::ppm));

TEST(PpmText, IsOnePixelALine) {
    const Bytes bytes = encode_ppm_text(ByteImage{2, 1, {0, 10, 255, 9, 99, 100}}, {});
    const std::string_view text = text_of(bytes);
    EXPECT_TRUE(text.starts_with("P3\n#")) << text;
    EXPECT_TRUE(text.ends_with("\n2 1\n255\n0 10 255\n9 99 100\n")) << text;
}

TEST(PpmReader, TakesForeignFiles) {
    const auto first = [](std::string_view file) {
        const DecodedImage decoded = decode_ppm(bytes_of(file), "memory");
        EXPECT_FALSE(decoded.metadata);
        return decoded.image.pixels.at(0);
    };
    const Vec3f spread = first("P3 # a comment: of somebody\r\n#\n1\t1\r\n15\n0  15\n\n5");
    EXPECT_EQ(spread.x, 0.0F);
    EXPECT_EQ(spread.y, 1.0F);
    EXPECT_EQ(spread.z, 5.0F / 15.0F);
    using namespace std::string_view_literals;
    const Vec3f deep = first("P6 1 1 65535\n\x00\x01\xFF\xFF\x80\x00 and more"sv);
    EXPECT_EQ(deep.x, 1.0F / 65535.0F);
    EXPECT_EQ(deep.y, 1.0F);
    EXPECT_EQ(deep.z, 32768.0F / 65535.0F);
}

TEST(PpmReader, TakesTheDisplayOfItsMetadata) {
    const auto read = [](const std::string& comments) {
        return decode_ppm(bytes_of("P3\n" + comments + "1 1\n15\n3 0 15\n"), "memory");
    };
    const DecodedImage older = read("# tandem:frame: 7\n");
    EXPECT_EQ(older.display, (Display{TransferFunction::linear}));
    EXPECT_EQ(older.image.pixels[0].x, 0.2F);
    const DecodedImage srgb = read("# tandem:transfer: srgb\n# tandem:exposure_stops: -1\n");
    EXPECT_EQ(srgb.display, (Display{TransferFunction::srgb, -1}));
    EXPECT_NEAR(srgb.image.pixels[0].x, 2 * 0.0331048F, 1e-7F);
    EXPECT_EQ(srgb.image.pixels[0].z, 2.0F);
    for (const char* comment : {"transfer: pq", "exposure_stops: 1e9", "exposure_stops: nan", "exposure_stops: x"}) {
        EXPECT_THROW((void)read(std::string("# tandem:") + comment + "\n"), InputError) << comment;
    }
}

}  // namespace
}  // namespace tandem

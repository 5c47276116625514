#include <gtest/gtest.h>

#include "images/sample_images.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;

#if TANDEM_HAS_EXR

TEST(Exr, RoundTripKeepsEveryBit) {
    const FloatImage image = sample_floats(67, 45);
    const DecodedImage decoded = decode_exr(encode_exr(image, sample_metadata(67, 45)), "memory");
    EXPECT_EQ(decoded.format, ImageFormat::exr);
    EXPECT_TRUE(same_bits(decoded.image, image));
    ASSERT_TRUE(decoded.metadata);
    EXPECT_EQ(*decoded.metadata, sample_metadata(67, 45));
}

TEST(Exr, AFilmsMeansSurviveBitForBit) {
    Film film(5, 4, 7);
    double value = 0.1;
    for (Vec3d& sum : film.sums()) {
        sum = {value, value * 1e-40, value * 1e30};
        value *= -3.7;
    }
    const FloatImage means = film_to_image(film);
    EXPECT_TRUE(same_bits(decode_exr(encode_exr(means, {}), "memory").image, means));
}

TEST(Exr, IsThirtyTwoBitFloatAndUncroppedRgb) {
    const Bytes bytes = encode_exr(sample_floats(8, 8), {});
    const std::string_view text = text_of(bytes);
    EXPECT_TRUE(text.starts_with("v/1\x01"));
    using namespace std::string_view_literals;
    const std::size_t channels = text.find("channels\0chlist\0"sv);
    ASSERT_NE(channels, std::string_view::npos);
    for (const std::string_view channel : {"B\0\2\0\0\0"sv, "G\0\2\0\0\0"sv, "R\0\2\0\0\0"sv}) {  // type 2: float
        EXPECT_NE(text.find(channel, channels), std::string_view::npos) << channel;
    }
}

/// Of `tandem-render named:paper --size 2x1 --spp 1`, when Tandem wrote EXR through OpenImageIO; the values are from
/// its PFM.
TEST(Exr, FilesOfOpenImageIoAreReadWithTheirMetadata) {
    const DecodedImage old = read_image(TANDEM_IMAGES "/written_by_openimageio.exr");
    EXPECT_TRUE(
        same_bits(old.image, {2, 1, {{0x1.af1eecp-1F, 0x1.cf78f4p-1F, 1}, {0x1.71b6cp-1F, 0x1.aaa0d8p-1F, 1}}}));
    ASSERT_TRUE(old.metadata);
    EXPECT_EQ(old.metadata->film_sha256, "85666931fa84884b93ecc2ced2c229acf9210f593937b66cab06869c7bc9d896");
    EXPECT_EQ(old.metadata->limits, "8,16,4");
    EXPECT_EQ(old.metadata->version, "0.1.0");
    // the same bytes are written today, but for an attribute without a value, by which the only line is nearer
    using namespace std::string_view_literals;
    constexpr std::string_view empty_date = "capDate\0string\0\0\0\0\0"sv;
    Bytes expected = read_file(TANDEM_IMAGES "/written_by_openimageio.exr");
    const auto date = expected.begin() + static_cast<std::ptrdiff_t>(text_of(expected).find(empty_date));
    expected.erase(date, date + empty_date.size());
    constexpr std::size_t line = 8 + 2 * sizeof(Vec3f);
    std::byte& offset = expected[expected.size() - line - sizeof(std::uint64_t)];
    offset = static_cast<std::byte>(std::to_integer<std::size_t>(offset) - empty_date.size());
    EXPECT_EQ(encode_exr(old.image, *old.metadata), expected);
}

#else

TEST(Exr, WithoutOpenExrSaysWhatToInstall) {
    const auto message = thrown_message<EnvironmentError>([] { (void)format_of("picture.exr"); });
    EXPECT_NE(message.find("libopenexr-dev"), std::string::npos) << message;
    EXPECT_FALSE(thrown_message<EnvironmentError>([] { (void)encode_exr(sample_floats(1, 1), {}); }).empty());
    EXPECT_FALSE(thrown_message<EnvironmentError>([] { (void)decode_exr({}, "picture.exr"); }).empty());
}

#endif

}  // namespace
}  // namespace tandem

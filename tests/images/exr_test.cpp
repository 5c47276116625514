#include <gtest/gtest.h>

#include "images/sample_images.h"
#include "support/thrown_message.h"
#include "tandem/error/error.h"
#include "tandem/film/image_io.h"

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

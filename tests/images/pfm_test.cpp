#include <gtest/gtest.h>

#include "images/sample_images.h"

namespace tandem {
namespace {

using namespace test;

TEST(Pfm, RoundTripKeepsEveryBit) {
    const FloatImage image = sample_floats(23, 31);
    const DecodedImage decoded = decode_pfm(encode_pfm(image), "memory");
    EXPECT_EQ(decoded.format, ImageFormat::pfm);
    EXPECT_TRUE(same_bits(decoded.image, image));
}

TEST(Pfm, IsLittleEndianFromTheBottomUp) {
    const FloatImage image{1, 2, {{1, 2, 3}, {4, 5, 6}}};
    const Bytes bytes = encode_pfm(image);
    const std::string_view text = text_of(bytes);
    const std::string_view head = "PF\n1 2\n-1.0\n";
    ASSERT_TRUE(text.starts_with(head));
    ASSERT_EQ(text.size(), head.size() + 24);
    using namespace std::string_view_literals;
    EXPECT_EQ(text.substr(head.size(), 4), "\x00\x00\x80\x40"sv);       // 4
    EXPECT_EQ(text.substr(head.size() + 12, 4), "\x00\x00\x80\x3F"sv);  // 1
}

TEST(Pfm, ReadsBigEndianAndOneChannel) {
    using namespace std::string_view_literals;
    const DecodedImage decoded = decode_pfm(bytes_of("Pf\n1 2\n2.5\n\x3F\x80\x00\x00\x40\x00\x00\x00"sv), "memory");
    EXPECT_TRUE(same_bits(decoded.image, {1, 2, {{2, 2, 2}, {1, 1, 1}}}));
}

}  // namespace
}  // namespace tandem

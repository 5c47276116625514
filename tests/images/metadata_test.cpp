#include <gtest/gtest.h>

#include "images/sample_images.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using namespace test;

TEST(Metadata, TextRoundTrip) {
    const ImageMetadata metadata = sample_metadata(640, 480);
    const MetadataText text = to_text(metadata);
    EXPECT_EQ(text.front().first, "tandem:film_sha256");
    EXPECT_EQ(metadata_from_text(text), metadata);
}

TEST(Metadata, EmptyTextsAreLeftOut) {
    for (const auto& [key, value] : to_text({})) EXPECT_EQ(value, "0") << key;
    EXPECT_EQ(metadata_from_text(to_text({})), ImageMetadata{});
}

TEST(Metadata, KeysOfOthersAreNotOurs) {
    EXPECT_FALSE(metadata_from_text({}));
    EXPECT_FALSE(metadata_from_text({{"Software", "another"}, {"seed", "5"}}));
    const auto mixed = metadata_from_text({{"Software", "another"}, {"tandem:seed", "5"}, {"tandem:later", "?"}});
    ASSERT_TRUE(mixed);
    EXPECT_EQ(mixed->seed, 5U);
}

TEST(Metadata, ANumberThatIsNoneIsAnError) {
    for (const char* value : {"", "-1", "5x", " 5", "18446744073709551616", "5.0"}) {
        const auto message = thrown_message<InputError>([&] { (void)metadata_from_text({{"tandem:seed", value}}); });
        EXPECT_NE(message.find("tandem:seed"), std::string::npos) << value;
    }
}

TEST(Metadata, ExposuresKeepTheirBits) {
    for (const double stops : {-6.3, 0.1, 1.0 / 3, 0.0, -99.99999999999999}) {
        const ImageMetadata metadata = with_display({}, {TransferFunction::linear, stops});
        EXPECT_EQ(metadata_from_text(to_text(metadata)), metadata) << stops;
        EXPECT_EQ(display_of(metadata), (Display{TransferFunction::linear, stops}));
    }
    const auto message = thrown_message<InputError>([] {
        (void)metadata_from_text({{"tandem:exposure_stops", "-6.3 "}});
    });
    EXPECT_NE(message.find("'-6.3 ', not a number"), std::string::npos) << message;
}

TEST(Metadata, WithoutATransferFunctionAreOfALinearFile) {
    EXPECT_EQ(display_of({}), (Display{TransferFunction::linear}));
}

TEST(Metadata, LineBreaksCannotBeSmuggledIn) {
    ImageMetadata metadata;
    metadata.backend = "cpu\ntandem:seed: 9";
    EXPECT_THROW((void)to_text(metadata), InputError);
    metadata.backend = "caf\xC3\xA9";
    EXPECT_THROW((void)to_text(metadata), InputError);
}

}  // namespace
}  // namespace tandem

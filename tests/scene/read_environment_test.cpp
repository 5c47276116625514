// Files of environments: what is read, and what is refused.
#include "tandem/scene/read_environment.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/input_error.h"
#include "support/temporary_folder.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;

constexpr float infinity = std::numeric_limits<float>::infinity();

class ReadEnvironment : public ::testing::Test {
  protected:
    std::string written(const FloatImage& image) {
        std::string path = folder_.file("sky.pfm");
        write_file(path, encode_pfm(image));
        return path;
    }
    TemporaryFolder folder_;
};

TEST_F(ReadEnvironment, KeepsLightAndReplacesNegativeValues) {
    const EnvironmentFile file = read_environment(
        written({3, 2, {{1, 2, 3}, {-1e-6F, 5, 0}, {0, -0.0F, 1}, {-1, -1, -1}, {0x1p100F, 0, 0}, {1e-40F, 0, 0}}}));
    EXPECT_EQ(file.picture.pixels,
              (std::vector<Vec3f>{{1, 2, 3}, {0, 5, 0}, {0, 0, 1}, {0, 0, 0}, {0x1p100F, 0, 0}, {1e-40F, 0, 0}}));
    EXPECT_EQ(file.negative_texels, 2U);
    EXPECT_EQ(file.picture.width, 3);
}

TEST_F(ReadEnvironment, SaysWhereAValueIsNoLight) {
    for (const float value : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 2e30F, -2e30F}) {
        const std::string path = written({2, 2, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, value, 0}}});
        const std::string message = input_error([&] { (void)read_environment(path); });
        EXPECT_TRUE(contains(message, "column 1 of row 1"));
        EXPECT_TRUE(contains(message, path));
    }
}

TEST_F(ReadEnvironment, RefusesWhatIsNoPictureOfLight) {
    const std::string png = folder_.file("sky.png");
    write_image(png, FloatImage{1, 1, {{1, 1, 1}}}, {});
    EXPECT_TRUE(contains(input_error([&] { (void)read_environment(png); }), "8 bits"));
    EXPECT_TRUE(contains(input_error([&] { (void)read_environment(folder_.file("none.hdr")); }), "none.hdr"));
}

}  // namespace
}  // namespace tandem

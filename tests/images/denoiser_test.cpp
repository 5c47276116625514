// The calls of Open Image Denoise, against a small library of our own that records them.
#include "tandem/images/denoiser.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"

namespace tandem {
namespace {

class Denoising : public testing::Test {
  protected:
    Denoising() { ::setenv("STUB_DENOISER_LOG", log_.c_str(), 1); }
    ~Denoising() override {
        ::unsetenv("STUB_DENOISER_LOG");
        ::unsetenv("STUB_DENOISER_FAILS");
    }

    std::string log() const {
        const Bytes bytes = read_file(log_);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    test::TemporaryFolder folder_;
    std::string log_ = folder_.file("log");
};

/// Two samples per pixel; pixel i has the mean colour (i, 2 i, 3 i) and the albedo i / 10.
Film film_with_planes() {
    Film film(3, 2, 2, denoiser_planes);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const auto value = static_cast<double>(i);
        film.sums()[i] = {2 * value, 4 * value, 6 * value};
        film.planes().albedo[i] = Vec3d{value, value, value} * 0.2;
        film.planes().normal[i] = {0, 0, 2};
    }
    return film;
}

/// The message of the EnvironmentError that `call` throws.
template <class Call>
std::string environment_error(Call call) {
    return test::thrown_message<EnvironmentError>(call);
}

TEST_F(Denoising, TheColourAndItsPlanesAreFiltered) {
    {
        const Denoiser denoiser(TANDEM_STUB_DENOISER, 3);
        EXPECT_EQ(denoiser.name(), "Open Image Denoise 2.3.4");
        const FloatImage image = denoiser.denoise(film_with_planes());
        ASSERT_EQ(image.width, 3);
        ASSERT_EQ(image.pixels.size(), 6U);
        for (std::size_t i = 0; i < 6; ++i) {
            const auto value = static_cast<float>(i);
            EXPECT_FLOAT_EQ(image.pixels[i].x, value / 2 + value / 10);
            EXPECT_FLOAT_EQ(image.pixels[i].z, 3 * value / 2 + value / 10);
        }
    }
    EXPECT_EQ(log(),
              "device 1\nnumThreads 3\nsetAffinity 0\ncommit device\nfilter RT\nimage color 3 3x2 0\n"
              "image albedo 3 3x2 0\nimage normal 3 3x2 0\nimage output 3 3x2 0\nhdr 1\nexecute\nrelease filter\n"
              "release device\n");
}

TEST_F(Denoising, WhatIsMissingIsSaidWithWhereItWasLookedFor) {
    const std::string named = environment_error([] { const Denoiser none("/nowhere/libOpenImageDenoise.so.2"); });
    for (const char* part : {"/nowhere/libOpenImageDenoise.so.2", "No such file", "--denoiser", "docs/denoising.md"}) {
        EXPECT_NE(named.find(part), std::string::npos) << part << "\n" << named;
    }
    try {
        const Denoiser installed;
        GTEST_SKIP() << installed.name() << " is installed here";
    } catch (const EnvironmentError& error) {
        const std::string text = error.what();
        for (const char* part :
             {"LD_LIBRARY_PATH", "libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "Install"}) {
            EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
        }
    }
}

TEST_F(Denoising, ALibraryThatLacksAFunctionIsRefused) {
    const std::string text = environment_error([] { const Denoiser none(TANDEM_INCOMPLETE_DENOISER); });
    EXPECT_NE(text.find("oidnExecuteFilter"), std::string::npos) << text;
}

TEST_F(Denoising, ItsOwnErrorsComeOut) {
    for (const char* what : {"device", "commit", "filter", "execute"}) {
        ::setenv("STUB_DENOISER_FAILS", what, 1);
        const std::string text = environment_error([] {
            const Denoiser denoiser(TANDEM_STUB_DENOISER);
            (void)denoiser.denoise(film_with_planes());
        });
        EXPECT_NE(text.find("the stub was told to fail"), std::string::npos) << what << "\n" << text;
    }
}

}  // namespace
}  // namespace tandem

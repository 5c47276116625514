// Images drawn again: those as written match, changed ones do not, and what cannot be judged is refused.
#include "tandem/render/verify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/input_error.h"
#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"
#include "tandem/images/image_io.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/pixel_filter_names.h"
#include "tandem/render/sampler_names.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;
using test::thrown_message;

class VerifyTest : public testing::Test {
  protected:
    VerifyTest() {
        job.width = 100;
        job.height = 50;
        job.samples = 6;
        job.seed = 3;
        write.durability = Durability::written;
        write.display = {TransferFunction::srgb, 0.7};
    }

    [[nodiscard]] FramePlan plan() const { return plan_frame(scene, {}, job); }
    /// Renders the frame, writes it, and reads it back.
    DecodedImage image(const std::string& name) {
        ImageMetadata metadata = describe(job, frame_hash(scene, plan()), "cpu");
        Film film = render_frame(*backend, scene, plan()).result.film;
        metadata.film_sha256 = film_hash(film);
        write_image(folder.file(name), std::move(film), metadata, write);
        return read_image(folder.file(name));
    }
    Verdict verify(const DecodedImage& image, std::size_t tiles = 1000) {
        return verify_image(*backend, scene, {}, image, {.tiles = tiles, .seed = 5});
    }

    test::TemporaryFolder folder;
    Scene scene = named_scene("paper");
    std::unique_ptr<Backend> backend = make_backend("cpu");
    RenderJob job;
    WriteOptions write;
};

TEST_F(VerifyTest, ImagesAsWrittenMatch) {
    std::vector<std::string> names = {"a.png", "a.ppm", "a.pfm"};
    if (thrown_message<EnvironmentError>(check_exr_support).empty()) names.emplace_back("a.exr");
    for (const std::string& name : names) {
        const Verdict all = verify(image(name));
        EXPECT_TRUE(all.matches()) << name;
        EXPECT_TRUE(all.has_film && all.film_matches) << name;
        EXPECT_EQ(all.drawn_pixels, 5000U);
        EXPECT_EQ(all.largest_unseen_share(), 0);
    }
    const Verdict some = verify(image("a.png"), 6);
    EXPECT_TRUE(some.matches());
    EXPECT_EQ(some.drawn, 6U);
    EXPECT_EQ(some.tiles, 8U);
    EXPECT_EQ(some.largest_unseen_share(), 0.5);
}

TEST_F(VerifyTest, ImagesOfEverySamplerMatchAndOldOnesAreRandom) {
    for (const Sampler sampler : {Sampler::sobol, Sampler::sobol_blue}) {
        job.sampler = sampler;
        DecodedImage drawn = image("a.pfm");
        EXPECT_TRUE(verify(drawn).matches()) << to_string(sampler);
        drawn.metadata->sampler = "random";
        EXPECT_FALSE(verify(drawn).matches()) << "the samples are others";
    }
    job.sampler = Sampler::random;
    DecodedImage old = image("a.pfm");
    old.metadata->sampler.clear();
    EXPECT_TRUE(verify(old).matches());
    old.metadata->sampler = "sobol2";
    EXPECT_TRUE(contains(input_error([&] { (void)verify(old); }), "no sampler 'sobol2'"));
}

TEST_F(VerifyTest, ImagesOfEveryFilterMatchAndOldOnesHaveBox) {
    for (const PixelFilter filter : {PixelFilter::tent, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
        job.filter = filter;
        DecodedImage drawn = image("a.pfm");
        EXPECT_TRUE(verify(drawn).matches()) << to_string(filter);
        drawn.metadata->filter.clear();
        EXPECT_FALSE(verify(drawn).matches()) << "the samples are elsewhere";
    }
    job.filter = PixelFilter::box;
    DecodedImage old = image("a.pfm");
    old.metadata->filter.clear();
    EXPECT_TRUE(verify(old).matches());
    old.metadata->filter = "sinc";
    EXPECT_TRUE(contains(input_error([&] { (void)verify(old); }), "no filter 'sinc'"));
}

TEST_F(VerifyTest, ChangedPixelsAreFound) {
    DecodedImage floats = image("a.pfm");
    float& value = floats.image.pixels[42 * 100 + 70].y;
    value = std::nextafter(value, 2.0F);  // one bit
    const Verdict verdict = verify(floats);
    EXPECT_FALSE(verdict.matches());
    EXPECT_EQ(verdict.differing_pixels, 1U);
    ASSERT_EQ(verdict.differing.size(), 1U);
    EXPECT_EQ(verdict.differing[0].left, 64);
    EXPECT_EQ(verdict.differing[0].top, 32);

    DecodedImage levels = image("a.png");
    float& level = levels.image.pixels[0].x;
    level = level > 0.2F ? 0.0F : 0.9F;
    EXPECT_EQ(verify(levels).differing_pixels, 1U);

    DecodedImage other_hash = image("a.png");
    other_hash.metadata->film_sha256[0] ^= 1;
    EXPECT_EQ(verify(other_hash).differing_pixels, 0U);
    EXPECT_FALSE(verify(other_hash).matches());
}

TEST_F(VerifyTest, MotionBlurMatches) {
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = Shutter{0, 0.5, 3};
    }
    ASSERT_TRUE(is_blurred(plan()));
    EXPECT_TRUE(verify(image("a.pfm")).matches());
}

TEST_F(VerifyTest, TilesWithSamplesOfTheirOwnMatch) {
    job.samples = 512;
    const std::atomic<bool> never{false};
    auto frame = render_to_target(*backend, scene, plan(), {.error = 0.004}, never, [] { return 0.0; });
    ImageMetadata metadata = describe(job, frame_hash(scene, plan()), "cpu");
    metadata.film_sha256 = film_hash(frame->frame.result.film);
    metadata.tile_samples = frame->tile_samples;
    ASSERT_NE(metadata.tile_samples.find(' ', 4), std::string::npos) << metadata.tile_samples;
    for (const char* name : {"a.png", "a.pfm"}) {
        write_image(folder.file(name), frame->frame.result.film, metadata, write);
        const Verdict verdict = verify(read_image(folder.file(name)));
        EXPECT_EQ(verdict.differing_pixels, 0U);
        EXPECT_TRUE(verdict.film_matches);
    }
}

TEST_F(VerifyTest, WhatCannotBeJudgedIsRefused) {
    const DecodedImage good = image("a.png");
    const auto refusal = [&](auto change) {
        DecodedImage bad = good;
        change(bad);
        return input_error([&] { (void)verify(bad); });
    };
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata.reset(); }), "no metadata"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->width = 99; }), "99 x 50"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->tier = "fast"; }), "tier fast"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->tier = "best"; }), "best"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->samples = 0; }), "samples"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->scene_hash[3] ^= 1; }), "the scene is not that"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->tile_samples = "32: 4"; }), "samples of the tiles"));
    EXPECT_TRUE(contains(refusal([](DecodedImage& i) { i.metadata->denoised = "a filter"; }), "denoised by a filter"));
    backend = make_backend("oracle");
    EXPECT_TRUE(contains(refusal([](DecodedImage&) {}), "--backend cpu"));
}

}  // namespace
}  // namespace tandem

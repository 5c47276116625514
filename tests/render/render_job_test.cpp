// Jobs that backends refuse.
#include "tandem/render/render_job.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/render/pixel_job.h"
#include "tandem/render/sampler_names.h"

namespace tandem {
namespace {

using test::thrown_message;

std::string refusal_of(const FilmWindow& window) {
    RenderJob job;
    job.width = 40;
    job.height = 30;
    job.window = window;
    return thrown_message<InputError>([&] { check(job); });
}

TEST(RenderJob, HasItsWindowWithinTheFilm) {
    for (const FilmWindow& good : {FilmWindow{0, 0, 40, 30}, FilmWindow{39, 29, 1, 1}, FilmWindow{7, 0, 33, 1}}) {
        EXPECT_EQ(refusal_of(good), "");
    }
    const int far = std::numeric_limits<int>::max();
    for (const FilmWindow& bad : {FilmWindow{0, 0, 41, 30}, FilmWindow{40, 0, 1, 1}, FilmWindow{-1, 0, 1, 1},
                                  FilmWindow{0, 30, 1, 1}, FilmWindow{3, 3, 0, 1}, FilmWindow{3, 3, 1, -5},
                                  FilmWindow{1, 0, far, 1}, FilmWindow{0, far, 1, far}, FilmWindow{0, 1, 40, 30}}) {
        EXPECT_NE(refusal_of(bad).find("within the film of 40 x 30"), std::string::npos) << refusal_of(bad);
    }
}

TEST(RenderJob, OfALargeFilmIsAllowedAWindow) {
    RenderJob job;
    job.width = job.height = 65536;
    EXPECT_NE(thrown_message<InputError>([&] { check(job); }).find("render windows of it"), std::string::npos);
    job.window = FilmWindow{65000, 65000, 500, 500};
    EXPECT_EQ(thrown_message<InputError>([&] { check(job); }), "");
}

TEST(RenderJob, HasNoVarianceFromSamplesThatAreNotIndependent) {
    for (const SamplerInfo& info : sampler_infos()) {
        RenderJob job;
        job.sampler = info.sampler;
        EXPECT_EQ(thrown_message<InputError>([&] { check(job); }), "") << info.name;
        job.planes = FilmPlane::variance;
        const std::string refusal = thrown_message<InputError>([&] { check(job); });
        EXPECT_EQ(refusal.empty(), info.sampler == Sampler::random) << info.name;
        if (refusal.empty()) continue;
        EXPECT_NE(refusal.find("use the sampler 'random'"), std::string::npos) << refusal;
    }
}

// A filter may send rays beyond the film: those too must be traceable.
TEST(RenderJob, NeedsACameraWhoseRaysOfTheFilterAreTraceable) {
    PreparedCamera camera;
    camera.render_from_camera = compose({0, 0, 0}, Quaternion{}, {1, 1, 1});
    camera.orthographic = true;
    camera.half_height = 0.8e18;
    RenderJob job;
    job.width = job.height = 4;
    EXPECT_EQ(thrown_message<InputError>([&] { (void)make_pixel_job(camera, job); }), "");
    job.filter = PixelFilter::gaussian;  // 0.4e18 farther
    const std::string refusal = thrown_message<InputError>([&] { (void)make_pixel_job(camera, job); });
    EXPECT_NE(refusal.find("farther than 1e18"), std::string::npos) << refusal;
}

TEST(SamplerNames, AreReadAsTheyAreWritten) {
    for (const SamplerInfo& info : sampler_infos()) EXPECT_EQ(parse_sampler(to_string(info.sampler)), info.sampler);
    EXPECT_EQ(sampler_infos().front().sampler, Sampler::random);
    const std::string refusal = thrown_message<InputError>([] { (void)parse_sampler("halton"); });
    EXPECT_NE(refusal.find("'halton'; the samplers are random, sobol, sobol_blue"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace tandem

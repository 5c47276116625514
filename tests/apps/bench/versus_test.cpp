#include "versus.h"

#include <gtest/gtest.h>

#include "loop_backend.h"
#include "tandem/base/error.h"

namespace tandem::bench {
namespace {

VersusOptions small_frames() {
    VersusOptions options;
    options.size = {20, 18};
    options.samples = 2;
    options.repetitions = 4;
    return options;
}

VersusOptions small_rays() {
    VersusOptions options = small_frames();
    options.scene = "named:spheres/50";
    options.rays = RaySet::random;
    options.ray_edge = 16;
    return options;
}

TEST(Versus, MeasuresEveryBackendInEveryRound) {
    Report report;
    EXPECT_TRUE(run_versus(small_frames(), loop_source(), report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 2U);
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.seconds.size(), 4U);
        ASSERT_FALSE(row.phases.empty());
        for (const PhaseTimings& phase : row.phases) EXPECT_EQ(phase.seconds.size(), 4U) << phase.name;
    }
    ASSERT_TRUE(report.rows[1].factor.has_value());
    EXPECT_EQ(report.rows[1].factor->over, "cpu");
    EXPECT_EQ(report.rows[1].factor->ratio.pairs, 4U);
}

TEST(Versus, UnequalPicturesAreNotCompared) {
    Report report;
    EXPECT_FALSE(run_versus(small_frames(), loop_source(spoil_the_gpu), report));
    EXPECT_NE(prose_of(report).find("1 of 360 pixels differ between cpu and cuda."), std::string::npos)
        << prose_of(report);
}

TEST(Versus, TheTierFastPromisesNoEqualPictures) {
    VersusOptions options = small_frames();
    options.tier = "fast";
    Report report;
    EXPECT_TRUE(run_versus(options, loop_source(spoil_the_gpu), report));
    EXPECT_EQ(report.rows[0].tier, "fast");
    EXPECT_NE(prose_of(report).find("1 of 360 pixels differ"), std::string::npos) << "but they are compared";
    options = small_rays();
    options.tier = "fast";
    Report rays;
    EXPECT_TRUE(run_versus(options, loop_source(spoil_the_gpu), rays));
    EXPECT_EQ(rays.rows.size(), 3U) << "there is no second row of the tier fast";
    EXPECT_EQ(property_of(rays, "differing hits"), "1");
    options.tier = "best";
    EXPECT_THROW((void)run_versus(options, loop_source(), rays), InputError);
}

TEST(Versus, OneBackendStandsAloneAndNoneIsAnError) {
    Report report;
    EXPECT_TRUE(run_versus(small_frames(), loop_source(spoil_nothing, "cuda"), report));
    EXPECT_NE(prose_of(report).find("nothing to compare its times with"), std::string::npos);
    VersusOptions options = small_frames();
    options.backends = {"cuda"};
    Report empty;
    EXPECT_THROW((void)run_versus(options, loop_source(spoil_nothing, "cuda"), empty), EnvironmentError);
}

TEST(Versus, RaysAreCountedAndRawEmbreeStandsBeside) {
    Report report;
    EXPECT_TRUE(run_versus(small_rays(), loop_source(), report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 4U);
    EXPECT_EQ(report.rows[2].tier, "fast");
    EXPECT_EQ(report.rows[3].backend, "embree");
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.rays, 256);
        EXPECT_EQ(row.seconds.size(), 4U);
        EXPECT_GT(rays_per_second(row), 0);
    }
    EXPECT_EQ(property_of(report, "differing hits"), "0");
}

TEST(Versus, OneDifferentHitIsFound) {
    Report report;
    EXPECT_FALSE(run_versus(small_rays(), loop_source(spoil_the_gpu), report));
    EXPECT_EQ(property_of(report, "differing hits"), "1");
}

TEST(Versus, RawEmbreeIsLeftOutWhereThereAreBoxes) {
    VersusOptions options = small_rays();
    options.scene = "named:mixed/50";
    Report report;
    EXPECT_TRUE(run_versus(options, loop_source(), report));
    EXPECT_EQ(report.rows.size(), 3U);
}

}  // namespace
}  // namespace tandem::bench

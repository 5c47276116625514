#include "accuracy.h"

#include <gtest/gtest.h>

#include "kind_scenes.h"
#include "loop_backend.h"
#include "tandem/base/error.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/math/ulp.h"

namespace tandem::bench {
namespace {

AccuracyOptions small_accuracy() {
    AccuracyOptions options;
    options.scenes = {"named:paper"};
    options.tiers = {"strict"};
    options.size = {20, 18};
    options.samples = 2;
    options.rays = 200;
    options.repetitions = 2;
    return options;
}

TEST(Accuracy, HoldsOfRightBackends) {
    Report report;
    EXPECT_TRUE(run_accuracy(small_accuracy(), loop_source(), report)) << prose_of(report);
    // two backends; every kind easy and hard, and one frame
    EXPECT_EQ(report.rows.size(), 2 * (2 * primitive_kinds().size() + 1));
    for (const BenchmarkRow& row : report.rows) EXPECT_EQ(row.seconds.size(), 2U) << row.label;
}

TEST(Accuracy, FindsAWrongHitAndAWrongPixel) {
    Report report;
    EXPECT_FALSE(run_accuracy(small_accuracy(), loop_source(spoil_the_gpu), report));
    EXPECT_NE(prose_of(report).find("cpu strict and cuda strict differ in a bit"), std::string::npos);
    EXPECT_NE(prose_of(report).find("1 pixels of cuda strict"), std::string::npos) << prose_of(report);
}

TEST(Accuracy, RefusesAnUnknownTier) {
    AccuracyOptions options = small_accuracy();
    options.tiers = {"sloppy"};
    Report report;
    EXPECT_THROW((void)run_accuracy(options, loop_source(), report), InputError);
}

TEST(Accuracy, RaysOfKindScenesHit) {
    for (const std::string& kind : primitive_kinds()) {
        for (const Difficulty difficulty : {Difficulty::easy, Difficulty::hard}) {
            const KindScene scene = make_kind_scene(kind, difficulty, 500);
            ASSERT_EQ(primitive_count(scene.scene), 64U);
            std::size_t hits = 0;
            for (const Ray<float>& ray : scene.rays) {
                hits += LoopTracer{view(scene.scene)}.closest(ray, NoSource{}, true).primitive != no_primitive ? 1 : 0;
            }
            EXPECT_GT(hits, 150U) << kind;
        }
    }
}

TEST(Ulp, CountsUnitsOfTheLastPlace) {
    EXPECT_EQ(error_in_ulp(1.0F, 1.0), 0.0);
    EXPECT_EQ(error_in_ulp(1.0F, 1.0 + 0x1p-24), 0.5);
    EXPECT_EQ(error_in_ulp(1.0F + 0x1p-23F, 1.0), 1.0);
    EXPECT_EQ(error_in_ulp(0x1p-149F, 0.0), 1.0);
    EXPECT_EQ(error_in_ulp(HUGE_VALF, 1.0), HUGE_VAL);
}

}  // namespace
}  // namespace tandem::bench

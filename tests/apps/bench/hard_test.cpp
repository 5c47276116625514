#include "hard.h"

#include <gtest/gtest.h>

#include "loop_backend.h"
#include "support/input_error.h"
#include "support/temporary_folder.h"
#include "tandem/report/csv_writer.h"
#include "tandem/report/json_writer.h"

namespace tandem::bench {
namespace {

/// Rays, a function, pictures.
HardOptions small_hard() {
    HardOptions options;
    options.cases = {"A2", "B12", "G4", "I1"};
    options.tiers = {"strict"};
    options.rays = 200;
    return options;
}

TEST(Hard, CorrectBackendsKeepTheErrorBounds) {
    Report report;
    EXPECT_TRUE(run_hard(small_hard(), loop_source(), report)) << prose_of(report);
    EXPECT_EQ(report.rows.size(), 7U) << "two backends, three cases; and one case on the host";
    EXPECT_EQ(property_of(report, "error bounds kept"), "7 of 7");
    EXPECT_NE(to_json(report).find("A2 A planet"), std::string::npos);
    EXPECT_NE(to_csv(report.rows).find("A2,"), std::string::npos);
}

TEST(Hard, AWrongHitExceedsTheErrorBoundAndIsReproduced) {
    Report report;
    EXPECT_FALSE(run_hard(small_hard(), loop_source(spoil_the_gpu), report));
    const std::string prose = prose_of(report);
    EXPECT_TRUE(test::contains(prose, "A2 cuda strict exceeds its error bound"));
    EXPECT_TRUE(test::contains(prose, "Ray<float>{{"));
    EXPECT_EQ(prose.find("A2 cpu"), std::string::npos) << prose;
}

TEST(Hard, BackendsThatAreNotThereAreNamed) {
    Report report;
    HardOptions options = small_hard();
    EXPECT_TRUE(run_hard(options, loop_source([](const auto&, const auto&) { return false; }, "cuda"), report));
    EXPECT_TRUE(test::contains(prose_of(report), "Without cuda: it is left out in this test."));
    EXPECT_EQ(report.rows.size(), 4U);
}

TEST(Hard, UnknownNamesAreRefused) {
    const auto refused = [](auto change) {
        HardOptions options = small_hard();
        change(options);
        return test::input_error([&] {
            Report report;
            (void)run_hard(options, loop_source(), report);
        });
    };
    EXPECT_TRUE(test::contains(refused([](auto& o) { o.cases = {std::string("Q7")}; }), "no hard case is named 'Q7'"));
    EXPECT_TRUE(test::contains(refused([](auto& o) { o.tiers = {std::string("sloppy")}; }), "sloppy"));
    EXPECT_TRUE(
        test::contains(refused([](auto& o) { o.export_folder = o.answers = std::string("x"); }), "one at a time"));
    EXPECT_TRUE(test::contains(refused([](auto& o) {
                                   o.cases = {"L1"};
                                   o.tiers = {"fast"};
                               }),
                               "none of these cases"));
    EXPECT_TRUE(test::contains(refused([](auto& o) { o.answers = std::string("/nowhere/answers"); }), "manifest.json"));
}

TEST(Hard, ExportsForOthers) {
    test::TemporaryFolder folder;
    HardOptions options = small_hard();
    options.export_folder = folder.file("corpus");
    Report report;
    EXPECT_TRUE(run_hard(options, loop_source(), report));
    EXPECT_TRUE(test::contains(prose_of(report), "2 cases are in"));
    options.export_folder.clear();
    options.answers = folder.file("corpus/exact");  // the right answers lie as answers do
    Report checked;
    EXPECT_TRUE(run_hard(options, loop_source(), checked)) << prose_of(checked);
    EXPECT_EQ(checked.rows.size(), 2U);
}

}  // namespace
}  // namespace tandem::bench

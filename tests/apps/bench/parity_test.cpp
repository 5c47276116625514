#include "parity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "loop_backend.h"
#include "tandem/base/error.h"
#include "tandem/film/film.h"

namespace tandem::bench {
namespace {

ParityOptions small_parity() {
    ParityOptions options;
    options.scenes = {"named:paper", "named:mixed/20"};
    options.frames = {0, 2};
    options.size = {20, 18};
    options.samples = 2;
    return options;
}

TEST(Parity, VariantsAreThreadsTilesAndInstructionSets) {
    const auto variants = parity_variants({"cpu", "cuda"}, {"x86-64-v2", "x86-64-v3"});
    std::set<std::string> labels;
    std::set<int> threads, tiles;
    for (const ParityVariant& variant : variants) {
        labels.insert(variant.label);
        if (variant.backend == "cpu") {
            threads.insert(variant.options.threads);
            tiles.insert(variant.options.tile_size);
        }
    }
    EXPECT_EQ(labels.size(), variants.size()) << "labels must tell variants apart";
    EXPECT_TRUE(labels.contains("cuda"));
    EXPECT_TRUE(labels.contains("cpu, x86-64-v3"));
    for (const int count : {1, 2, 7}) EXPECT_TRUE(threads.contains(count));
    for (const int tile : {8, 13, 16}) EXPECT_TRUE(tiles.contains(tile));
}

TEST(Parity, HoldsForEqualBackendsAndGivesTheHashes) {
    Report report;
    EXPECT_TRUE(run_parity(small_parity(), loop_source(), report)) << prose_of(report);
    EXPECT_EQ(property_of(report, "equal"), "true");
    const std::string hash = property_of(report, "film named:paper, strict, frame 2");
    EXPECT_EQ(hash.size(), 64U);
    EXPECT_NE(hash, property_of(report, "film named:paper, strict, frame 1"));
    EXPECT_EQ(property_of(report, "film named:paper, precise, frame 2").size(), 64U);
    EXPECT_FALSE(report.rows.empty());
    for (const BenchmarkRow& row : report.rows) EXPECT_EQ(row.seconds.size(), 3U) << row.label;
}

TEST(Parity, IsNotAskedOfATierWithoutIt) {
    ParityOptions options = small_parity();
    options.tiers = {"strict", "fast"};
    Report report;
    EXPECT_THROW((void)run_parity(options, loop_source(), report), InputError);
    EXPECT_TRUE(report.rows.empty());
}

TEST(Parity, OneBitOfOneVariantBreaksIt) {
    const auto spoils = [](const std::string& name, const BackendOptions& options) {
        return name == "cpu" && options.tile_size == 13;
    };
    Report report;
    EXPECT_FALSE(run_parity(small_parity(), loop_source(spoils), report));
    EXPECT_NE(prose_of(report).find("the films differ: cpu, tiles of 13."), std::string::npos) << prose_of(report);
    EXPECT_EQ(property_of(report, "equal"), "false");
}

TEST(Parity, BackendsThatDoNotPromiseBitsAreReportedOnly) {
    const auto spoils = [](const std::string& name, const BackendOptions&) { return name == "oracle"; };
    Report report;
    EXPECT_TRUE(run_parity(small_parity(), loop_source(spoils), report));
    const auto oracle = std::find_if(report.rows.begin(), report.rows.end(),
                                     [](const BenchmarkRow& row) { return row.backend == "oracle"; });
    ASSERT_NE(oracle, report.rows.end());
    EXPECT_FALSE(oracle->errors.empty());
}

TEST(Parity, WithoutAGpuItSaysSo) {
    Report report;
    EXPECT_TRUE(
        run_parity(small_parity(), loop_source([](const auto&, const auto&) { return false; }, "cuda"), report));
    EXPECT_NE(prose_of(report).find("it says nothing about a GPU"), std::string::npos);
}

TEST(Parity, BruteForceIsNotAskedForTheImpossible) {
    ParityOptions options = small_parity();
    options.scenes = {"named:spheres/2000"};
    options.frames = {0, 0};
    options.size = {500, 500};
    options.samples = 1;
    options.backends = {"oracle"};
    Report report;
    EXPECT_TRUE(run_parity(options, loop_source(), report));
    EXPECT_TRUE(report.rows.empty()) << "500,000,000 primitive tests were taken";
}

}  // namespace
}  // namespace tandem::bench

#include "beside_mitsuba.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "run_program.h"
#include "support/temporary_folder.h"

namespace tandem::bench {
namespace {

/// Takes the place of scripts/versus_mitsuba.py.
BesideMitsubaOptions options_with(const test::TemporaryFolder& folder, const std::string& body) {
    std::ofstream(folder.file("script.py")) << body;
    return {folder.file("script.py"), "/some/tandem-render", "scalar_rgb", folder.file("there"), 2, 3};
}

TEST(BesideMitsuba, TheRowsHoldWhatTheScriptMeasured) {
    const test::TemporaryFolder folder;
    const BesideMitsuba result = time_beside_mitsuba(options_with(folder, R"(
import json, sys
words = sys.argv[1:]
assert words[:-1] == ["--render", "/some/tandem-render", "--variant", "scalar_rgb", "--threads", "2", "--repetitions", "3",
                      "--json"], words
with open(words[-1], "w") as file:
    json.dump({"tandem": [1, 2, 3], "mitsuba": [4, 5, 6], "samples": 100, "version": "3.9.0", "variant": "v4"}, file)
)"));
    EXPECT_EQ(result.why_not, "");
    const auto& [theirs, ours] = result.rows;
    EXPECT_EQ(theirs.label, "Mitsuba 3.9.0, scalar_rgb");
    EXPECT_EQ(theirs.seconds, (std::vector<double>{4, 5, 6}));
    EXPECT_EQ(ours.seconds, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(ours.rounds, (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_EQ(ours.variant, "v4");
    EXPECT_EQ(ours.samples, 100);
    EXPECT_TRUE(std::filesystem::is_empty(folder.file("there"))) << "its file is removed";
}

TEST(BesideMitsuba, AScriptThatFailsOrIsNotThereLeavesTheTargetOpen) {
    const test::TemporaryFolder folder;
    const BesideMitsuba failed = time_beside_mitsuba(options_with(folder, "raise SystemExit(3)"));
    EXPECT_EQ(failed.why_not, "not run: python3 with " + folder.file("script.py") +
                                  " for scalar_rgb ended with status 3; its message is above");
    EXPECT_TRUE(failed.rows[0].seconds.empty());
    EXPECT_EQ(time_beside_mitsuba({"/nowhere/script.py", "", "", "", 2, 1}).why_not,
              "not run: there is no /nowhere/script.py here");
}

TEST(RunProgram, TellsHowAProgramEnded) {
    EXPECT_EQ(run_program({"sh", "-c", "exit 5"}), 5);
    EXPECT_EQ(run_program({"/nowhere/program"}), 127);
    EXPECT_EQ(run_program({"sh", "-c", "kill -9 $$"}), 128 + 9);
}

}  // namespace
}  // namespace tandem::bench

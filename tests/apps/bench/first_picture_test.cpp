#include "first_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/temporary_folder.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem::bench {
namespace {

TEST(FirstPicture, IsTimedFromOutsideWithItsPhasesBeside) {
    const test::TemporaryFolder folder;
    const BenchmarkRow row = time_first_picture({TANDEM_RENDER, "named:spheres/100", "cpu", folder.file("there"), 2});
    ASSERT_EQ(row.seconds.size(), 2U);
    const auto render =
        std::find_if(row.phases.begin(), row.phases.end(), [](const auto& phase) { return phase.name == "render"; });
    ASSERT_NE(render, row.phases.end());
    ASSERT_EQ(render->seconds.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_GT(row.seconds[i], render->seconds[i]);
    EXPECT_TRUE(std::filesystem::is_empty(folder.file("there"))) << "its files are removed";
}

TEST(FirstPicture, AProgramThatFailsIsAnErrorThatNamesIt) {
    const test::TemporaryFolder folder;
    const auto message = [&](const char* program, const char* scene) {
        return test::thrown_message<EnvironmentError>([&] {
            (void)time_first_picture({program, scene, "cpu", folder.file("there"), 1});
        });
    };
    EXPECT_NE(message(TANDEM_RENDER, "named:nothing").find("named:nothing"), std::string::npos);
    EXPECT_NE(message("/nowhere/program", "named:paper").find("/nowhere/program"), std::string::npos);
}

}  // namespace
}  // namespace tandem::bench

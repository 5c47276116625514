#include "tandem/base/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>

#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

TEST(AvailableMemory, IsAPartOfThatOfTheMachine) {
    const auto available = available_memory();
    ASSERT_TRUE(available);
    EXPECT_GT(*available, 0U);
    const auto pages = static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES));
    EXPECT_LE(*available, pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
}

TEST(RequiredMemory, IsRefusedWithWhatItIsFor) {
    constexpr std::size_t gibibyte = std::size_t{1} << 30;
    EXPECT_NO_THROW(require_memory(gibibyte, gibibyte, "a scene", "memory"));
    const std::string message = test::thrown_message<EnvironmentError>(
        [] { require_memory(3 * gibibyte / 2, gibibyte, "a scene of 7 spheres", "GPU memory"); });
    EXPECT_EQ(
        message,
        "a scene of 7 spheres needs at least 1.5 GiB of GPU memory, but 1.0 GiB are free; make it smaller, or use a "
        "machine with more");
    EXPECT_EQ(
        test::thrown_message<EnvironmentError>(
            [] { require_memory(gibibyte, gibibyte / 2048, "a scene", "GPU memory"); }),
        "a scene needs at least 1.0 GiB of GPU memory, but 0.5 MiB are free; make it smaller, or use a machine with "
        "more");
    EXPECT_THROW(require_memory(std::size_t{1} << 60, "a scene"), EnvironmentError);
}

}  // namespace
}  // namespace tandem

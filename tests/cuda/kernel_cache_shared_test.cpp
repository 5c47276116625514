// Threads and processes in one cache folder at once: every entry that is found is whole.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "cuda/cache_bytes.h"
#include "cuda/kernel_cache.h"
#include "support/temporary_folder.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;

constexpr int keys = 3;
constexpr int rounds = 150;

/// Stores and looks up the same few keys over and over. Two cubins may be under each key, and nothing else; false if
/// anything else was found, or if a store failed. Small enough a limit makes it evict as well.
bool use(const std::string& folder, std::uint64_t limit_bytes, std::uint64_t seed) {
    const KernelCache cache(folder, limit_bytes);
    Random random(seed);
    for (int i = 0; i < rounds; ++i) {
        const int number = static_cast<int>(random.below(keys));
        const std::string key = cache_key_of(number);
        const auto first = 2 * static_cast<std::uint64_t>(number);
        if (random.coin() && !cache.store(key, some_cubin(first + random.below(2))).empty()) return false;
        const std::vector<std::byte> cubin = cache.find(key).cubin;
        if (!cubin.empty() && cubin != some_cubin(first) && cubin != some_cubin(first + 1)) return false;
    }
    return true;
}

class SharedCache : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(SharedCache, ServesThreads) {
    const TemporaryFolder folder;
    bool good[4] = {};
    std::vector<std::thread> threads;
    for (std::uint64_t i = 0; i < 4; ++i) {
        threads.emplace_back([&, i] { good[i] = use(folder.file(""), GetParam(), i); });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::uint64_t i = 0; i < 4; ++i) EXPECT_TRUE(good[i]) << "use(folder, " << GetParam() << ", " << i << ")";
}

TEST_P(SharedCache, ServesProcesses) {
    const TemporaryFolder folder;
    std::vector<pid_t> children;
    for (std::uint64_t i = 0; i < 3; ++i) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) ::_exit(use(folder.file(""), GetParam(), i) ? 0 : 1);
        children.push_back(child);
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
        int status = -1;
        ASSERT_EQ(::waitpid(children[i], &status, 0), children[i]);
        EXPECT_EQ(status, 0) << "use(folder, " << GetParam() << ", " << i << ")";
    }
    // nothing that a killed process would have left
    for (const std::string& name : folder.names()) EXPECT_FALSE(name.ends_with(".tmp")) << name;
}

INSTANTIATE_TEST_SUITE_P(Limits, SharedCache, ::testing::Values(KernelCache::default_limit_bytes, 12'000U));

}  // namespace
}  // namespace tandem::cuda

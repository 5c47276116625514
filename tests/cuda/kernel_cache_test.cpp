// The kernel cache alone: what it keeps, what it does not trust, and folders that do not work.
#include "cuda/kernel_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "cuda/cache_bytes.h"
#include "cuda/environment.h"
#include "support/temporary_folder.h"
#include "tandem/base/whole_file.h"

namespace tandem::cuda {
namespace {

namespace fs = std::filesystem;
using namespace tandem::test;

class KernelCacheIn : public ::testing::Test {
  protected:
    /// The file of an entry.
    [[nodiscard]] std::string file_of(int number) const { return folder_.file(cache_key_of(number) + ".cubin"); }
    /// Expects that an entry is not used, that the cache says so, and that another store mends it.
    void expect_rebuilt(int number) {
        const KernelCache::Found found = cache_.find(cache_key_of(number));
        EXPECT_TRUE(found.cubin.empty());
        EXPECT_NE(found.problem.find(cache_key_of(number)), std::string::npos) << found.problem;
        EXPECT_EQ(cache_.store(cache_key_of(number), some_cubin(7)), "");
        EXPECT_EQ(cache_.find(cache_key_of(number)).cubin, some_cubin(7));
    }
    TemporaryFolder folder_;
    KernelCache cache_{folder_.file("")};
};

TEST_F(KernelCacheIn, GivesBackWhatWasStored) {
    EXPECT_TRUE(cache_.find(cache_key_of(1)).cubin.empty());
    EXPECT_EQ(cache_.find(cache_key_of(1)).problem, "");
    EXPECT_EQ(cache_.store(cache_key_of(1), some_cubin(1)), "");
    EXPECT_EQ(cache_.store(cache_key_of(2), some_cubin(2, 1)), "");
    EXPECT_EQ(cache_.find(cache_key_of(1)).cubin, some_cubin(1));
    EXPECT_EQ(cache_.find(cache_key_of(2)).cubin, some_cubin(2, 1));
    EXPECT_EQ(folder_.names().size(), 2U) << "a temporary file was left behind";
}

TEST_F(KernelCacheIn, TheLastStoreWins) {
    EXPECT_EQ(cache_.store(cache_key_of(1), some_cubin(1)), "");
    EXPECT_EQ(cache_.store(cache_key_of(1), some_cubin(2)), "");
    EXPECT_EQ(cache_.find(cache_key_of(1)).cubin, some_cubin(2));
}

TEST_F(KernelCacheIn, AFlippedBitAnywhereIsNoticed) {
    ASSERT_EQ(cache_.store(cache_key_of(1), some_cubin(1, 300)), "");
    const Bytes good = read_file(file_of(1));
    for (std::size_t i = 0; i < good.size(); ++i) {
        Bytes bad = good;
        bad[i] ^= std::byte{16};
        write_file(file_of(1), bad, Durability::written);
        EXPECT_TRUE(cache_.find(cache_key_of(1)).cubin.empty()) << "byte " << i;
    }
    expect_rebuilt(1);
}

TEST_F(KernelCacheIn, ATruncatedOrLengthenedEntryIsNoticed) {
    ASSERT_EQ(cache_.store(cache_key_of(1), some_cubin(1, 300)), "");
    Bytes bytes = read_file(file_of(1));
    bytes.push_back(std::byte{0});
    write_file(file_of(1), bytes, Durability::written);
    EXPECT_TRUE(cache_.find(cache_key_of(1)).cubin.empty());
    for (bytes.pop_back(); !bytes.empty();) {
        bytes.pop_back();
        write_file(file_of(1), bytes, Durability::written);
        EXPECT_TRUE(cache_.find(cache_key_of(1)).cubin.empty()) << bytes.size() << " bytes";
    }
    expect_rebuilt(1);
}

TEST_F(KernelCacheIn, AForeignFileIsNoticed) {
    std::ofstream(file_of(1)) << "a text of somebody else, long enough to be taken for a header "
                              << std::string(500, '-');
    expect_rebuilt(1);
}

TEST_F(KernelCacheIn, TheEntryOfAnotherKeyIsNoticed) {
    ASSERT_EQ(cache_.store(cache_key_of(1), some_cubin(1)), "");
    fs::copy_file(file_of(1), file_of(2));
    expect_rebuilt(2);
}

TEST_F(KernelCacheIn, AFolderInAnEntrysPlaceIsToldBothWays) {
    fs::create_directory(file_of(1));
    EXPECT_NE(cache_.find(cache_key_of(1)).problem, "");
    EXPECT_NE(cache_.store(cache_key_of(1), some_cubin(1)), "");
}

TEST_F(KernelCacheIn, NamesThatAreNoKeysNeverReachTheDisk) {
    for (const char* name : {"", "../up", "x"}) {
        EXPECT_NE(cache_.store(name, some_cubin(1)), "") << name;
        EXPECT_TRUE(cache_.find(name).cubin.empty()) << name;
    }
    EXPECT_TRUE(folder_.names().empty());
}

TEST_F(KernelCacheIn, AMissingFolderIsMadeWhenNeeded) {
    const KernelCache deep(folder_.file("a/b/c"));
    EXPECT_TRUE(deep.find(cache_key_of(1)).cubin.empty());
    EXPECT_FALSE(fs::exists(folder_.file("a")));
    EXPECT_EQ(deep.store(cache_key_of(1), some_cubin(1)), "");
    EXPECT_EQ(deep.find(cache_key_of(1)).cubin, some_cubin(1));
}

TEST_F(KernelCacheIn, AFolderThatCannotBeMadeIsTold) {
    std::ofstream(folder_.file("file")) << "in the way";
    const KernelCache blocked(folder_.file("file/cache"));
    EXPECT_TRUE(blocked.find(cache_key_of(1)).cubin.empty());
    EXPECT_NE(blocked.store(cache_key_of(1), some_cubin(1)).find(folder_.file("file")), std::string::npos);
}

TEST_F(KernelCacheIn, AReadOnlyFolderServesWhatIsInIt) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write into read-only folders";
    ASSERT_EQ(cache_.store(cache_key_of(1), some_cubin(1)), "");
    fs::permissions(folder_.file(""), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(cache_.find(cache_key_of(1)).cubin, some_cubin(1));
    EXPECT_NE(cache_.store(cache_key_of(2), some_cubin(2)), "");
    fs::permissions(folder_.file(""), fs::perms::owner_all);
}

TEST_F(KernelCacheIn, OffKeepsNothingAndIsNoProblem) {
    const KernelCache off{{}};
    EXPECT_EQ(off.store(cache_key_of(1), some_cubin(1)), "");
    const KernelCache::Found found = off.find(cache_key_of(1));
    EXPECT_TRUE(found.cubin.empty());
    EXPECT_EQ(found.problem, "");
}

TEST_F(KernelCacheIn, WhatWasUsedLongestAgoGoesFirst) {
    constexpr std::size_t size = 1000;
    const KernelCache small(folder_.file(""), 3 * (size + 200));
    for (const int number : {1, 2, 3}) {
        ASSERT_EQ(small.store(cache_key_of(number), some_cubin(1, size)), "");
        fs::last_write_time(file_of(number), fs::file_time_type::clock::now() - std::chrono::hours(10 - number));
    }
    EXPECT_FALSE(small.find(cache_key_of(1)).cubin.empty());  // now it is the one used last
    ASSERT_EQ(small.store(cache_key_of(4), some_cubin(1, size)), "");
    EXPECT_TRUE(fs::exists(file_of(1)));
    EXPECT_FALSE(fs::exists(file_of(2)));
    EXPECT_TRUE(fs::exists(file_of(3)));
    EXPECT_TRUE(fs::exists(file_of(4)));
}

TEST_F(KernelCacheIn, EvictionLeavesForeignFilesAndClearsOldTemporaries) {
    const std::string old_temporary = folder_.file("." + cache_key_of(1) + ".cubin.1-0.tmp");
    const std::string new_temporary = folder_.file("." + cache_key_of(2) + ".cubin.1-0.tmp");
    const std::vector<std::string> foreign = {folder_.file("notes.txt"), folder_.file("notes.cubin"),
                                              folder_.file(".x.tmp")};
    for (const std::string& path : foreign) std::ofstream(path) << std::string(5000, 'x');
    std::ofstream(old_temporary) << "torn";
    std::ofstream(new_temporary) << "being written";
    for (const std::string& path : {old_temporary, foreign[0], foreign[1], foreign[2]}) {
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(48));
    }
    const KernelCache small(folder_.file(""), 1500);
    ASSERT_EQ(small.store(cache_key_of(3), some_cubin(1, 1000)), "");
    ASSERT_EQ(small.store(cache_key_of(4), some_cubin(1, 1000)), "");
    EXPECT_FALSE(fs::exists(file_of(3)));
    EXPECT_TRUE(fs::exists(file_of(4)));
    EXPECT_FALSE(fs::exists(old_temporary));
    EXPECT_TRUE(fs::exists(new_temporary));
    for (const std::string& path : foreign) EXPECT_TRUE(fs::exists(path)) << path;
}

TEST_F(KernelCacheIn, ACubinOverTheLimitIsNotKept) {
    const KernelCache small(folder_.file(""), 1000);
    EXPECT_NE(small.store(cache_key_of(1), some_cubin(1, 1000)), "");
    EXPECT_TRUE(folder_.names().empty());
}

TEST(KernelCacheFolder, FollowsTheEnvironment) {
    const EnvironmentVariable own("TANDEM_CACHE_DIR", "/own");
    const EnvironmentVariable xdg("XDG_CACHE_HOME", "/xdg");
    const EnvironmentVariable home("HOME", "/home/me");
    EXPECT_EQ(kernel_cache_folder(), "/own/kernels");
    {
        const EnvironmentVariable off("TANDEM_CACHE_DIR", "");
        EXPECT_TRUE(kernel_cache_folder().empty());
    }
    const EnvironmentVariable unset("TANDEM_CACHE_DIR", std::nullopt);
    EXPECT_EQ(kernel_cache_folder(), "/xdg/tandem/kernels");
    const EnvironmentVariable relative("XDG_CACHE_HOME", "relative");
    EXPECT_EQ(kernel_cache_folder(), "/home/me/.cache/tandem/kernels");
    const EnvironmentVariable homeless("HOME", std::nullopt);
    EXPECT_TRUE(kernel_cache_folder().empty());
}

}  // namespace
}  // namespace tandem::cuda

// Linking through the cache.
#include "cuda/specialise.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "cuda/toy_input.h"
#include "support/temporary_folder.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;

TEST(CacheKey, ChangesWithEverythingThatTheCubinDependsOn) {
    const JitInput base = toy_input({});
    std::set<std::string> keys = {cache_key(base, "1"), cache_key(base, "2")};
    const auto add = [&](auto change) {
        JitInput input = base;
        change(input);
        keys.insert(cache_key(input, "1"));
    };
    std::vector<std::byte> other(base.code.begin(), base.code.end());
    other.back() ^= std::byte{1};
    add([&](JitInput& input) { input.code = other; });
    add([](JitInput& input) { input.kernel = "other"; });
    add([](JitInput& input) { input.facts_name = "other"; });
    add([](JitInput& input) { input.facts[1] += 1; });
    add([](JitInput& input) { input.facts.push_back(0); });
    add([](JitInput& input) { input.tier = Tier::fast; });
    add([](JitInput& input) { input.architecture = 89; });
    EXPECT_EQ(keys.size(), 9U);
    EXPECT_EQ(cache_key(base, "1"), cache_key(toy_input({}), "1"));
}

class Specialise : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
    }
    TemporaryFolder folder_;
    KernelCache cache_{folder_.file("")};
    JitInput input_ = toy_input({0, 0});
};

TEST_F(Specialise, LinksOnceAndThenReadsTheSameBytes) {
    const Specialised first = specialise(input_, cache_);
    EXPECT_FALSE(first.from_cache);
    EXPECT_EQ(first.cache_problem, "");
    const Specialised second = specialise(input_, cache_);
    EXPECT_TRUE(second.from_cache);
    EXPECT_EQ(second.cache_problem, "");
    EXPECT_EQ(second.cubin, first.cubin);
    EXPECT_EQ(second.cubin, link(input_));
    EXPECT_FALSE(specialise(toy_input({toy_lights, 3}), cache_).from_cache);
}

TEST_F(Specialise, LinksAgainWhenTheEntryIsBad) {
    const Specialised first = specialise(input_, cache_);
    ASSERT_EQ(folder_.names().size(), 1U);
    std::ofstream(folder_.file(folder_.names().front())) << "somebody else's";
    const Specialised again = specialise(input_, cache_);
    EXPECT_FALSE(again.from_cache);
    EXPECT_NE(again.cache_problem, "");
    EXPECT_EQ(again.cubin, first.cubin);
    EXPECT_TRUE(specialise(input_, cache_).from_cache);
}

TEST_F(Specialise, WorksWithoutACacheAndSaysWhy) {
    std::ofstream(folder_.file("file")) << "in the way";
    const Specialised blocked = specialise(input_, KernelCache(folder_.file("file/cache")));
    EXPECT_FALSE(blocked.cubin.empty());
    EXPECT_NE(blocked.cache_problem, "");
    const Specialised off = specialise(input_, KernelCache({}));
    EXPECT_EQ(off.cubin, blocked.cubin);
    EXPECT_EQ(off.cache_problem, "");
}

}  // namespace
}  // namespace tandem::cuda

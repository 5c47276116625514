// Searches and tables beyond 2 GB, in packets and single numbers. lanes_test.cpp reads small tables with every
// instruction set.
#include "tandem/math/lookup_table.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <vector>

#include "support/random.h"
#include "tandem/math/lanes.h"

namespace tandem::test {
namespace {

using Packet = Lanes<float, Sse4>;
using Word = UInt<Packet>;

// Tables of every length with equal entries among them, and numbers before, between and behind the entries.
TEST(Bisect, FindsTheFirstPlaceThatIsNotBefore) {
    Random random(3);
    for (std::uint32_t count = 1; count <= 70; ++count) {
        std::vector<std::uint32_t> ends(count);
        for (std::uint32_t& end : ends) end = 2 * random.below(count + 1);
        std::sort(ends.begin(), ends.end());
        const LookupTable<std::uint32_t> table = {ends.data(), count};
        for (int round = 0; round < 100; ++round) {
            const Word numbers = Word::from([&](int) { return random.below(2 * count + 3); });
            const Word found = bisect<Word>(count, [&](const Word& place) { return table[place] < numbers; });
            for (int i = 0; i < Packet::size; ++i) {
                const std::uint32_t number = numbers[i];
                const auto place = std::lower_bound(ends.begin(), ends.end(), number) - ends.begin();
                const std::uint32_t expected = std::min(static_cast<std::uint32_t>(place), count - 1);
                ASSERT_EQ(found[i], expected) << number << " among " << count << ", round " << round << ", lane " << i;
                ASSERT_EQ(bisect<std::uint32_t>(count, [&](std::uint32_t at) { return ends[at] < number; }), expected)
                    << number << " among " << count << ", round " << round;
            }
        }
    }
}

// Beyond 2^31 bytes the offsets of a packet do not fit. The memory is reserved, but only two pages of it are used.
TEST(LookupTable, OfMoreThanTwoGigabytesIsReadInLanes) {
    using Word = UInt<Packet>;
    constexpr std::uint32_t width = 65536, height = 8193;
    constexpr std::size_t bytes = sizeof(std::uint32_t) * width * height;
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) GTEST_SKIP() << "the address space is limited";
    auto* numbers = static_cast<std::uint32_t*>(memory);
    numbers[1] = 5;
    numbers[std::size_t{width} * (height - 1) + 7] = 6;
    const LookupTable<std::uint32_t> table = {numbers, width, height};
    const auto row = Word::from([](int i) { return i % 2 == 0 ? 0U : height - 1; });
    const auto column = Word::from([](int i) { return i % 2 == 0 ? 1U : 7U; });
    const Word read = table.at(row, column);
    for (int i = 0; i < Packet::size; ++i) EXPECT_EQ(read[i], i % 2 == 0 ? 5U : 6U) << "lane " << i;
    munmap(memory, bytes);
}

}  // namespace
}  // namespace tandem::test

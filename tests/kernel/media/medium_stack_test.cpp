// The stack of media, apart from geometry; F8 of the corpus tries it along lines.
#include "tandem/kernel/media/medium_stack.h"

#include <gtest/gtest.h>

#include "tandem/math/lanes.h"

namespace tandem {
namespace {

TEST(MediumStack, IsOutsideAtFirst) {
    MediumStack<float> stack;
    EXPECT_EQ(stack.current(), no_medium);
    EXPECT_TRUE(stack.leave(3, true)) << "nothing to leave";
    EXPECT_EQ(stack.current(), no_medium);
}

TEST(MediumStack, TheHighestPriorityFillsAPlaceAndAmongEqualsTheLastEntered) {
    MediumStack<float> stack;
    EXPECT_FALSE(stack.enter(5, 1, true));
    EXPECT_FALSE(stack.enter(6, 0, true));
    EXPECT_EQ(stack.current(), 5U);
    EXPECT_FALSE(stack.enter(7, 1, true));
    EXPECT_EQ(stack.current(), 7U);
    EXPECT_FALSE(stack.leave(5, true));
    EXPECT_EQ(stack.current(), 7U);
    EXPECT_FALSE(stack.leave(7, true));
    EXPECT_EQ(stack.current(), 6U);
    EXPECT_FALSE(stack.leave(6, true));
    EXPECT_EQ(stack.current(), no_medium);
}

TEST(MediumStack, AMediumIsLeftAsOftenAsItWasEntered) {
    MediumStack<float> stack;
    for (int i = 0; i < 2; ++i) EXPECT_FALSE(stack.enter(0, 0, true));
    EXPECT_FALSE(stack.leave(0, true));
    EXPECT_EQ(stack.current(), 0U);
    EXPECT_FALSE(stack.leave(0, true));
    EXPECT_EQ(stack.current(), no_medium);
    EXPECT_TRUE(stack.leave(0, true));
}

TEST(MediumStack, SaysWhenItIsFullAndStaysAsItWas) {
    MediumStack<float> stack;
    for (std::uint32_t i = 0; i < MediumStack<float>::capacity; ++i) EXPECT_FALSE(stack.enter(i, 0, true));
    EXPECT_TRUE(stack.enter(99, 5, true));
    EXPECT_EQ(stack.current(), std::uint32_t{MediumStack<float>::capacity - 1});
}

TEST(MediumStack, LanesDoNotKnowOfEachOther) {
    using Packet = Lanes<float, Sse4>;
    using Word = UInt<Packet>;
    MediumStack<Packet> stack;
    const Word lane = lane_index(Word(0U));
    const Mask<Packet> all(true), low = lane < Word(2U);
    EXPECT_FALSE(any(stack.enter(lane, Word(0U), all)));
    EXPECT_FALSE(any(stack.enter(Word(9U), lane, low)));  // lane 0: equal priority
    const Word inside = stack.current();
    EXPECT_EQ(inside[0], 9U);
    EXPECT_EQ(inside[1], 9U);
    EXPECT_EQ(inside[2], 2U);
    EXPECT_EQ(inside[3], 3U);
    const Mask<Packet> missing = stack.leave(Word(9U), all);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(missing[i], i >= 2) << i;
        EXPECT_EQ(stack.current()[i], static_cast<std::uint32_t>(i));
    }
}

}  // namespace
}  // namespace tandem

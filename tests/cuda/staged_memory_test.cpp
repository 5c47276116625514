// As many paths in stages as fit into the memory that they may have. Needs no GPU.
#include "cuda/staged_memory.h"

#include <gtest/gtest.h>

namespace tandem::cuda {
namespace {

template <class Real>
class StagedMemoryOf : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(StagedMemoryOf, Reals);

TYPED_TEST(StagedMemoryOf, HoldsAsManyPathsAsFit) {
    constexpr StagedMemory memory = staged_memory_of<TypeParam>();
    constexpr std::uint32_t more = memory.most_paths + 2;  // the next even number
    EXPECT_GT(sizeof(StageLists<more>) + more * memory.path_bytes, staged_block_bytes<TypeParam>);
}

}  // namespace
}  // namespace tandem::cuda

// The GPU's versions of over_root.h and rough.h against their contracts. The processor computes both exactly.
#include <gtest/gtest.h>

#include "cuda/approximate_kernels.h"
#include "cuda/cuda_backend.h"

namespace tandem::cuda {
namespace {

TEST(OverRoot, RoundsTheRootAndTheQuotient) {
    if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
    for (const std::uint32_t seed : {1U, 2U}) {
        const test::WrongQuotients wrong = test::wrong_quotients(seed, 16);
        EXPECT_EQ(wrong.count, 0) << std::hexfloat << "seed " << seed << ": y = " << wrong.y << ", d = " << wrong.d;
    }
}

TEST(Rough, IsAsCloseAsItSays) {
    if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
    const test::RelativeErrors most = test::relative_errors(3);
    // no bound holds for a function that was not tried
    EXPECT_GT(most.rough_reciprocal, 0x1p-25);
    EXPECT_LE(most.rough_reciprocal, 0x1p-22);
    EXPECT_GT(most.rough_inverse_square_root, 0x1p-25);
    EXPECT_LE(most.rough_inverse_square_root, 0x1p-22);
    EXPECT_GT(most.close_reciprocal, 0x1p-55);
    EXPECT_LE(most.close_reciprocal, 3 * 0x1p-53);
    EXPECT_GT(most.close_inverse_square_root, 0x1p-55);
    EXPECT_LE(most.close_inverse_square_root, 3 * 0x1p-53);
}

}  // namespace
}  // namespace tandem::cuda

// Lambert's lobe against its closed forms; and that it draws the directions that the path loop drew before it had
// lobes.
#include "tandem/kernel/bsdf/lambert.h"

#include <gtest/gtest.h>

#include "kernel/bsdf/lobe_checks.h"

namespace tandem {
namespace {

using namespace test;

TEST(Lambert, ReflectsItsShareToTheBit) {
    const Lambert<float> lobe{{0.25F, 0.5F, 1}};
    Random random(1);
    for (int i = 0; i < 10'000; ++i) {
        const auto drawn = lobe.sample(direction(random.uniform(0.01, 1.0), 0.3), random_numbers(random));
        ASSERT_TRUE(drawn.valid);
        ASSERT_EQ(drawn.weight, lobe.reflectance);
        ASSERT_EQ(drawn.pdf, drawn.wi.z * inverse_pi);
        ASSERT_EQ(drawn.pdf, lobe.pdf({0, 0, 1}, drawn.wi));
    }
    const Vec3f f = lobe.f({0, 0, 1}, direction(0.5, 0.1));
    EXPECT_FLOAT_EQ(f.y, static_cast<float>(0.5 / pi));
}

// In the frame around the normal the local direction is the one that sample_cosine_hemisphere() draws around it, but
// for the sign of zeros.
TEST(Lambert, DrawsTheBitsOfTheWorldSpaceSampler) {
    const Lambert<float> lobe{{1, 1, 1}};
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        Random random(number);
        const Vec3d normal = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3d u = random_numbers(random);
        const auto drawn = lobe.sample({0, 0, 1}, u);
        const auto world = sample_cosine_hemisphere<float>(normal, u.x, u.y);
        ASSERT_EQ(from_frame(frame_around(normal), drawn.wi.x, drawn.wi.y, drawn.wi.z), world.direction)
            << "case " << number;
        ASSERT_EQ(drawn.pdf, world.pdf) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem

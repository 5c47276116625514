// The oracle's triangles: what doubles reject before exact signs are asked for must surely miss.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "support/random.h"
#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {
namespace {

// Two triangles share an edge, on either side of it. A line that passes the edge between its ends by a hair's breadth
// crosses at least one of them, so a wrong rejection loses it.
TEST(OracleFaces, LoseNoLineAtASharedEdge) {
    int hits = 0;
    for (std::uint64_t seed = 0; seed < 50'000; ++seed) {
        test::Random random(seed);
        const double scale = std::exp2(random.uniform(-60.0, 60.0));
        const auto coordinate = [&] { return static_cast<float>(random.uniform(-1.0, 1.0) * scale); };
        const auto point = [&] { return Vec3f{coordinate(), coordinate(), coordinate()}; };
        const Vec3f a = point(), b = point(), left = point(), aside = point();
        const Vector along = to_vector(b) - to_vector(a), to_left = to_vector(left) - to_vector(a);
        // on the other side of the edge, in the plane of the first triangle but for rounding
        const Vector opposite = to_vector(a) + along * random.uniform(0.2, 0.8) - to_left * random.uniform(0.2, 2.0);
        const Vec3f right = {static_cast<float>(opposite.x), static_cast<float>(opposite.y),
                             static_cast<float>(opposite.z)};
        const Vector target = to_vector(a) + along * random.uniform(0.3, 0.7) +
                              to_left * (random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-70.0, -40.0)));
        const Vector origin = to_vector(aside) * std::exp2(random.uniform(0.0, 12.0));
        const Line line = {origin, target - origin};
        const auto is_hit = [&](const Vec3f& p, const Vec3f& q, const Vec3f& r) {
            return hit_face({{p, q, r}, {0, 1, 2}}, FaceAttributes{}, nullptr, line).has_value();
        };
        const bool first = is_hit(a, b, left), second = is_hit(b, a, right);
        ASSERT_TRUE(first || second) << "seed " << seed;
        hits += first ? 1 : 0;
    }
    EXPECT_GT(hits, 15'000);  // the line passes on both sides
    EXPECT_LT(hits, 35'000);
}

}  // namespace
}  // namespace tandem::oracle

// Samples of a tile in lanes that become free in any order, and the order in which their radiances are added.
#include "cpu/sample_sets.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <utility>
#include <vector>

#include "cpu/tile_samples.h"

namespace tandem {
namespace {

using Real = Lanes<float, Sse4>;
using Word = UInt<Real>;
using SampleSetsTest = test::TileSamples;

Mask<Real> random_lanes(test::Random& random) {
    const std::uint32_t bits = random.below(16);
    return Word::from([&](int i) { return bits >> i & 1U; }) == Word(1U);
}

// Some packets, whose lanes end in random order, and what the samples' radiances are, by pixel and sample.
class SomePackets {
  public:
    explicit SomePackets(const PixelJob& job) : random_(job.samples) {}

    // Gives samples to idle lanes; returns how many.
    std::uint32_t take(SampleSets<Real>& sets, const PixelJob& job) {
        std::uint32_t count = 0;
        for (Packet& packet : packets_) {
            const Mask<Real> free = !packet.working && random_lanes(random_);
            const LaneSamples<Real> next = sets.take(free);
            EXPECT_FALSE(any(next.taken && !free)) << "a lane that follows a path, or that did not ask, got a sample";
            for (int i = 0; i < Real::size; ++i) {
                if (!next.taken[i]) continue;
                ++count;
                const Vec3d radiance = test::random_radiance(random_);
                const auto at = std::pair(next.y[i] * job.width + next.x[i], next.sample[i] - job.first_sample);
                EXPECT_TRUE(radiances.emplace(at, radiance).second) << "twice: " << at.first << ", " << at.second;
                test::set_lane<Real>(packet.radiances, i, radiance);
            }
            packet.place = select(next.taken, next.place, packet.place);
            packet.working = packet.working || next.taken;
        }
        return count;
    }

    // Ends some paths; returns how many go on.
    std::uint32_t end_some(SampleSets<Real>& sets) {
        std::uint32_t open = 0;
        for (Packet& packet : packets_) {
            const Mask<Real> ended = packet.working && random_lanes(random_);
            sets.keep(packet.place, packet.radiances, ended);
            packet.working = packet.working && !ended;
            open += static_cast<std::uint32_t>(std::popcount(packet.working.bits()));
        }
        return open;
    }

    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3d> radiances;

  private:
    struct Packet {
        Mask<Real> working{false};
        Word place{0U};
        Vec3<Wide<Real>> radiances{};
    };

    test::Random random_;
    std::vector<Packet> packets_{8};
};

TEST_P(SampleSetsTest, TakeEachSampleOnceAndAddThemInTheirOrder) {
    Vec3d sums[test::tile_film_width * test::tile_film_height] = {};
    SampleSets<Real> sets(job_, tile_, sums);
    SomePackets packets(job_);
    int idle_rounds = 0;  // lanes ask at random, so only many rounds without a sample are the end
    while (idle_rounds < 100) {
        sets.add_sets();
        const std::uint32_t taken = packets.take(sets, job_);
        idle_rounds = packets.end_some(sets) == 0 && taken == 0 ? idle_rounds + 1 : 0;
    }
    ASSERT_EQ(packets.radiances.size(), sample_count()) << job_.samples << " samples";
    Vec3d expected[test::tile_film_width * test::tile_film_height] = {};
    for (const auto& [at, radiance] : packets.radiances) {
        EXPECT_LT(at.second, job_.samples);
        EXPECT_TRUE(is_in_tile(at.first % job_.width, at.first / job_.width)) << "pixel " << at.first;
        expected[at.first] = expected[at.first] + radiance;
    }
    test::expect_equal_sums(sums, expected);
}

INSTANTIATE_TEST_SUITE_P(OfAnyTile, SampleSetsTest, test::any_tile_samples());

}  // namespace
}  // namespace tandem

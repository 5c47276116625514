// The order of a block's hits, with threads of the host in place of its warps. Needs no GPU.
#include "cuda/sort_hits.h"

#include <gtest/gtest.h>

#include <array>
#include <barrier>
#include <memory>
#include <thread>
#include <vector>

#include "support/random.h"

namespace tandem::cuda {
namespace {

constexpr std::uint32_t warps = 2, paths = 500;
using Lists = StageLists<paths>;

/// Lanes of warps that exchange values. Each is a thread of the host.
struct WarpLanes {
    static constexpr std::uint32_t count = 32;

    /// The values of a warp's lanes.
    struct Warp {
        std::array<std::uint32_t, count> values{};
        std::barrier<> barrier{static_cast<std::ptrdiff_t>(count)};
    };

    static std::uint32_t thread() { return number; }
    static std::uint32_t threads() { return warps * count; }
    static std::uint32_t lane() { return number % count; }
    static std::uint32_t of_lane(std::uint32_t, std::uint32_t value, std::uint32_t lane) {
        return exchanged(value, [&](const auto& values) { return values[lane]; });
    }
    static std::uint32_t sum_up_to(std::uint32_t value) {
        return exchanged(value, [&](const auto& values) {
            std::uint32_t sum = 0;
            for (std::uint32_t i = 0; i <= lane(); ++i) sum += values[i];
            return sum;
        });
    }

    static thread_local std::uint32_t number;
    static std::array<std::unique_ptr<Warp>, warps> all;

  private:
    template <class Read>
    static std::uint32_t exchanged(std::uint32_t value, const Read& read) {
        Warp& warp = *all[number / count];
        warp.values[lane()] = value;
        warp.barrier.arrive_and_wait();
        const std::uint32_t result = read(warp.values);
        warp.barrier.arrive_and_wait();
        return result;
    }
};
thread_local std::uint32_t WarpLanes::number = 0;
std::array<std::unique_ptr<WarpLanes::Warp>, warps> WarpLanes::all;

void sort_with_warps(Lists& lists, std::uint32_t turn) {
    for (auto& warp : WarpLanes::all) warp = std::make_unique<WarpLanes::Warp>();
    std::vector<std::jthread> threads;
    for (std::uint32_t i = 0; i < WarpLanes::threads(); ++i) {
        threads.emplace_back([&, i] {
            WarpLanes::number = i;
            sort_hits<WarpLanes>(lists, turn, paths);
        });
    }
}

/// The hits of paths: the class of each, or no_class.
constexpr std::uint32_t no_class = Lists::classes;

std::unique_ptr<Lists> lists_with(const std::vector<std::uint32_t>& classes) {
    auto lists = std::make_unique<Lists>();
    for (std::uint32_t path = 0; path < paths; ++path) {
        const std::uint32_t of_class = path < classes.size() ? classes[path] : no_class;
        lists->places[path] = static_cast<std::uint16_t>(
            of_class == no_class ? Lists::no_hit : Lists::place_word(lists->class_count[0][of_class]++, of_class));
    }
    return lists;
}

/// Every hit is shaded or waits with a place of its own in its class.
void expect_each_hit_once(const Lists& lists, const std::vector<std::uint32_t>& classes) {
    std::vector<std::uint32_t> found(paths);
    for (std::uint32_t of_class = 0; of_class < Lists::classes; ++of_class) {
        for (std::uint32_t i = lists.class_start[of_class]; i < lists.class_start[of_class + 1]; ++i) {
            const std::uint32_t path = lists.hits[i];
            ASSERT_LT(path, classes.size());
            EXPECT_EQ(classes[path], of_class);
            ++found[path];
        }
        const std::uint32_t shaded = lists.class_start[of_class + 1] - lists.class_start[of_class];
        EXPECT_EQ(lists.class_warps[of_class + 1] - lists.class_warps[of_class], (shaded + 31) / 32);
    }
    std::vector<std::vector<bool>> taken(Lists::classes);
    for (std::uint32_t i = 0; i < Lists::classes; ++i) taken[i].resize(lists.class_count[1][i]);
    for (std::uint32_t path = 0; path < paths; ++path) {
        const std::uint32_t word = lists.places[path];
        if (word == Lists::no_hit) continue;
        ASSERT_LT(path, classes.size());
        const std::uint32_t of_class = word % Lists::classes, place = word / Lists::classes;
        EXPECT_EQ(classes[path], of_class);
        ASSERT_LT(place, taken[of_class].size());
        EXPECT_FALSE(taken[of_class][place]) << "two paths have one place";
        taken[of_class][place] = true;
        ++found[path];
    }
    for (std::uint32_t path = 0; path < classes.size(); ++path) {
        EXPECT_EQ(found[path], classes[path] == no_class ? 0U : 1U) << "path " << path;
    }
}

std::uint32_t waiting_hits(const Lists& lists) {
    std::uint32_t waiting = 0;
    for (const std::uint32_t of_class : lists.class_count[1]) waiting += of_class;
    return waiting;
}

TEST(SortHits, ShadesOrKeepsEachHit) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        test::Random random(seed);
        const std::uint32_t used = 1 + random.below(Lists::classes - 1);
        std::vector<std::uint32_t> classes(random.below(paths + 1));
        for (std::uint32_t& of_class : classes) of_class = random.below(8) == 0 ? no_class : random.below(used);
        const auto lists = lists_with(classes);
        sort_with_warps(*lists, 0);
        expect_each_hit_once(*lists, classes);
        for (const std::uint32_t waiting : lists->class_count[1]) EXPECT_LT(waiting, 16U);
    }
}

TEST(SortHits, LetsFewHitsWaitOnlyIfAllWarpsHaveWork) {
    std::vector<std::uint32_t> classes(64 + 3, 5);
    classes.resize(classes.size() + 20, 7);
    const auto lists = lists_with(classes);
    sort_with_warps(*lists, 0);
    EXPECT_EQ(waiting_hits(*lists), 3U);
    EXPECT_EQ(lists->class_count[1][5], 3U) << "20 of class 7 are more than half a warp";

    classes.erase(classes.begin());
    classes.resize(32 + 3);
    const auto few = lists_with(classes);
    sort_with_warps(*few, 0);
    EXPECT_EQ(waiting_hits(*few), 0U) << "one of two warps has whole work";
    expect_each_hit_once(*few, classes);
}

}  // namespace
}  // namespace tandem::cuda

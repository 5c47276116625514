/// Takes the place of the threads of a GPU (cuda/block_lanes.h).
#pragma once

#include <cstdint>

namespace tandem::cuda {

/// A block of one thread.
struct HostLane {
    static constexpr std::uint32_t count = 1;

    static std::uint32_t thread() { return 0; }
    static std::uint32_t threads() { return 1; }
    static std::uint32_t lane() { return 0; }
    static void wait_for_block() {}
    static void reread() {}
    static std::uint32_t together() { return 1; }
    static void wait_for(std::uint32_t) {}
    static std::uint32_t lanes_where(std::uint32_t, bool is) { return is ? 1 : 0; }
    static std::uint32_t lanes_with(std::uint32_t group, std::uint32_t) { return group; }
    static std::uint32_t of_lane(std::uint32_t, std::uint32_t value, std::uint32_t) { return value; }
    static std::uint32_t first(std::uint32_t) { return 0; }
    static std::uint32_t size(std::uint32_t group) { return group; }
    static std::uint32_t place_in(std::uint32_t) { return 0; }
    static std::uint32_t sum_up_to(std::uint32_t value) { return value; }
    template <class Number>
    static Number add(Number& to, Number value) {
        to += value;
        return to - value;
    }
    static std::uint32_t multiprocessor() { return 0; }
    static std::uint32_t read(const std::uint32_t& from) { return from; }
    static void write(std::uint32_t& to, std::uint32_t value) { to = value; }
    static void pause() {}
};

}  // namespace tandem::cuda

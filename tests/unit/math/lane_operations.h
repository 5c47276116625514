/// Every operation of real.h, lanes.h and exact_math.h as a function on arrays of bits, to run for one lane and for
/// packets and compare. This interface is all that the files compiled for an instruction set share with others: what
/// else they use is in lane_operations_body.h, in an unnamed namespace or inlined by force.
#pragma once

#include <cstdint>

namespace tandem::test {

/// Reads three arguments from each of the lanes' slots (low bits for 32-bit types) and writes one result per lane.
struct LaneOperation {
    const char* name;
    void (*run)(const std::uint64_t* a, const std::uint64_t* b, const std::uint64_t* c, std::uint64_t* out);
};

struct LaneOperations {
    const LaneOperation* operations;
    int count;
    int lanes;
};

LaneOperations lane_operations_v2();
LaneOperations lane_operations_v3();
LaneOperations lane_operations_v4();

}  // namespace tandem::test

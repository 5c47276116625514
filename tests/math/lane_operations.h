/// Every operation of real.h, lanes.h and exact_math.h as a function on arrays of bits, to run for one lane and for
/// packets and compare. This interface is all that the files compiled for an instruction set share with others: what
/// else they use is in lane_operations_body.h, in an unnamed namespace, inlined by force, or named after the set.
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
    /// The reject filters; their decisions may differ between instruction sets. A sphere is centre and radius, a box
    /// its lower and upper corner, a triangle its corners, a ray its origin and direction; true if every lane passes.
    bool (*may_touch_sphere)(const float* sphere, const float* ray);
    bool (*may_touch_box)(const float* box, const float* ray);
    bool (*may_touch_triangle)(const float* triangle, const float* ray);
};

/// Does this processor run the functions for x86-64-v3 and v4?
inline bool has_v3() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
inline bool has_v4() { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"); }

LaneOperations lane_operations_v2();
LaneOperations lane_operations_v3();
LaneOperations lane_operations_v4();

}  // namespace tandem::test

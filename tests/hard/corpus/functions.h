/// Kernel functions, on single rays and on packets, against MPFR.
#pragma once

#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <cstdint>

#include "hard/corpus/score.h"
#include "tandem/math/lanes.h"
#include "tandem/math/vec.h"

namespace tandem::hard {

/// A packet on every x86-64 machine of the last decade; wider ones are compared with it by tests/math.
using Packet = Lanes<float, Sse4>;

/// 60 decimal digits: more than any function here can need, and fast.
using Exact =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>, boost::multiprecision::et_off>;

/// Distance from the correct value in float ulps.
inline double ulps_from(float value, const Exact& right) { return ulps_from(value, right.convert_to<double>()); }

/// Lane by lane: a packet made from one number turns -0 into 0.
inline Packet in_all(float value) {
    return Packet::from([&](int) { return value; });
}
inline Vec3<Packet> in_all(const Vec3f& v) { return {in_all(v.x), in_all(v.y), in_all(v.z)}; }

inline bool same_bits(float a, float b) { return bits_of(a) == bits_of(b); }

}  // namespace tandem::hard

/// Converts a texture coordinate to texels, along one axis.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// The wrap mode: what a texture shows outside of [0, 1] (glTF 2.0, 3.8.4.5).
enum class Wrap : std::uint32_t { repeat, mirrored_repeat, clamp_to_edge };

enum class Filter : std::uint32_t { nearest, linear };

/// The two texels around a point: indices from 0 to size - 1, and the weight of the second, in [0, 1).
template <class D>
struct TexelPair {
    D first, second, weight;
};

/// The largest integer not above `a`. In float, for the tier fast, magnitudes of 2^22 and more stay as they are.
template <class D>
TANDEM_HD_INLINE D floor_of(const D& a) {
    D nearest;
    if constexpr (sizeof(Scalar<D>) == sizeof(double)) {
        nearest = round_to_int(a);
    } else {
        const D shift(0x1.8p23F);
        nearest = select(absolute(a) < D(0x1p22F), (a + shift) - shift, a);
    }
    return select(nearest > a, nearest - D(1.0F), nearest);
}

/// Wraps a coordinate to [0, 1]. One that is not finite counts as 0.
template <class D>
TANDEM_HD_INLINE D wrapped(const D& coordinate, Wrap wrap) {
    const D zero(0.0F);
    const D one(1.0F);
    const D finite = select(absolute(coordinate) < D(__builtin_huge_valf()), coordinate, zero);
    if (wrap == Wrap::clamp_to_edge) return lesser(greater(finite, zero), one);
    if (wrap == Wrap::repeat) return finite - floor_of(finite);
    const D two(2.0F);
    const D folded = finite - two * floor_of(finite * D(0.5F));
    return select(folded > one, two - folded, folded);
}

/// The texels around a coordinate of any size on an axis of `size` texels, from 1 to 65536; their centres are at half
/// integers. For Filter::nearest `first` is the texel that contains the point, and the weight is 0.
template <class D>
TANDEM_HD_INLINE TexelPair<D> texels_around(const D& coordinate, Wrap wrap, Filter filter, const D& size) {
    const D zero(0.0F);
    const D last = size - D(1.0F);
    const D along = wrapped(coordinate, wrap) * size;
    // beyond an end follows the other end, or the last texel is repeated
    const D before = wrap == Wrap::repeat ? last : zero;
    const D behind = wrap == Wrap::repeat ? zero : last;
    const auto inside = [&](const D& i) { return select(i < zero, before, select(i > last, behind, i)); };
    if (filter == Filter::nearest) {
        const D texel = inside(floor_of(along));
        return {texel, texel, zero};
    }
    const D position = along - D(0.5F);
    const D below = floor_of(position);
    return {inside(below), inside(below + D(1.0F)), position - below};
}

}  // namespace tandem

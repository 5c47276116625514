/// A texture as kernels read it, and its lookup.
#pragma once

#include "tandem/kernel/texture/texel_axis.h"

namespace tandem {

/// Pointers are to memory of the host or the device, whichever reads them.
struct TextureView {
    const std::uint32_t* texels;  ///< row by row from the top; red in the lowest 8 bits, then green, blue, alpha
    const float* levels;          ///< the linear values of the 256 levels of red, green and blue
    std::uint32_t width, height;  ///< from 1 to 65536
    Wrap wrap_s, wrap_t;          ///< along u, along v
    Filter filter;
};

/// Linear; the colour is not premultiplied by alpha.
template <class Real>
struct Rgba {
    Real r, g, b, a;
};

/// The coordinate from -1 to 1 that a level from 0 to 1 stands for, in a texture of directions.
template <class Real>
TANDEM_HD_INLINE Double<Real> signed_level(const Real& level) {
    const Double<Real> wide = widen(level);
    return (wide + wide) - Double<Real>(1.0F);
}

namespace texture_detail {

/// A T whose lane i is make(i).
template <class T, class Make>
TANDEM_HD_INLINE T from_lanes(Make make) {
    if constexpr (RealTraits<T>::lanes == 1) {
        return T(make(0));
    } else {
        return T::from(make);
    }
}
template <class Real, class Make>
TANDEM_HD_INLINE UInt<Real> words_from_lanes(Make make) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return make(0);
    } else {
        return UInt<Real>::from(make);
    }
}

/// The texel in column x of row y; both are within the texture.
template <class Real>
TANDEM_HD_INLINE UInt<Real> texel(const TextureView& texture, const Double<Real>& x, const Double<Real>& y) {
    return words_from_lanes<Real>([&](int i) {
        const auto column = static_cast<std::uint32_t>(to_wide(lane(x, i)));
        const auto row = static_cast<std::uint32_t>(to_wide(lane(y, i)));
        return texture.texels[static_cast<std::size_t>(row) * texture.width + column];
    });
}

/// Decodes a texel: red, green and blue at `shift` 0, 8 and 16, and alpha.
template <class Real>
TANDEM_HD_INLINE Double<Real> colour(const TextureView& texture, const UInt<Real>& texel, int shift) {
    return widen(from_lanes<Float<Real>>([&](int i) { return texture.levels[(lane(texel, i) >> shift) & 0xFFU]; }));
}
template <class Real>
TANDEM_HD_INLINE Double<Real> alpha(const UInt<Real>& texel) {
    return widen(from_uint<Float<Real>>(texel >> 24)) / Double<Real>(255.0F);
}

/// The four texels around a point, and their weights.
template <class Real>
struct Cell {
    UInt<Real> corner[4];  ///< (first, first), (second, first), (first, second), (second, second) of x, y
    Double<Real> x, y;

    /// Interpolates `value` of the four texels. Exact if they are equal.
    template <class Value>
    TANDEM_HD_INLINE Real mean(Value value) const {
        using D = Double<Real>;
        const D a = value(corner[0]);
        const D c = value(corner[2]);
        const D upper = a + x * (value(corner[1]) - a);
        const D lower = c + x * (value(corner[3]) - c);
        return to_real<Real>(upper + y * (lower - upper));
    }
};

}  // namespace texture_detail

/// The texture at (u, v): (0, 0) is the corner of the first texel, v runs downwards, the whole image is [0, 1]^2.
///
/// Needs: any u and v, in all lanes. One that is not finite counts as 0.
/// Gives: the texel that contains the point (one of the two on a border), or the bilinear mean of the four around it.
///        Texels become linear before the mean, which is computed in double and rounded once. It lies between the least
///        and the greatest of them, except for the rounding of a Real that is a double.
/// Source: the filters and wrap modes are those of glTF 2.0, 3.8.4, for a texture without mipmaps. Tested by
///        tests/kernel/texture/texture_test.cpp.
template <class Real>
TANDEM_HD_INLINE Rgba<Real> sample(const TextureView& texture, const Double<Real>& u, const Double<Real>& v) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const auto size = [](std::uint32_t texels) { return D(to_float(texels)); };
    const TexelPair<D> x = texels_around(u, texture.wrap_s, texture.filter, size(texture.width));
    const TexelPair<D> y = texels_around(v, texture.wrap_t, texture.filter, size(texture.height));
    texture_detail::Cell<Real> cell;
    cell.corner[0] = texture_detail::texel<Real>(texture, x.first, y.first);
    const auto value_of = [&](auto mean) -> Rgba<Real> {
        const auto colour = [&](int shift) {
            return mean([&, shift](const Word& texel) { return texture_detail::colour<Real>(texture, texel, shift); });
        };
        return {colour(0), colour(8), colour(16),
                mean([](const Word& texel) { return texture_detail::alpha<Real>(texel); })};
    };
    if (texture.filter == Filter::nearest) {
        return value_of([&](auto value) { return to_real<Real>(value(cell.corner[0])); });
    }
    cell.corner[1] = texture_detail::texel<Real>(texture, x.second, y.first);
    cell.corner[2] = texture_detail::texel<Real>(texture, x.first, y.second);
    cell.corner[3] = texture_detail::texel<Real>(texture, x.second, y.second);
    cell.x = x.weight;
    cell.y = y.weight;
    return value_of([&](auto value) { return cell.mean(value); });
}

}  // namespace tandem

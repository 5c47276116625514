/// The colour space sRGB: its transfer function and its primaries. On the host. Source: IEC 61966-2-1:1999.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/vec.h"

namespace tandem {

/// The linear value, from 0 to 1, of an sRGB value from 0 to 1. Within a few ulp of double; the same bits on every
/// machine.
[[nodiscard]] inline double linear_of_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : power<float>((value + 0.055) / 1.055, 2.4);
}

// XYZ of linear RGB: the primaries and the white point (D65) of ITU-R BT.709, with more digits than a float has.
inline const Vec3d x_of_rgb{0.4123907992659593, 0.3575843393838780, 0.1804807884018343};
inline const Vec3d y_of_rgb{0.2126390058715103, 0.7151686787677559, 0.0721923153607337};
inline const Vec3d z_of_rgb{0.0193308187155918, 0.1191947797946259, 0.9505321522496605};

/// The luminance of linear RGB; 1 for white.
[[nodiscard]] inline double luminance(const Vec3d& rgb) { return dot(y_of_rgb, rgb); }

}  // namespace tandem

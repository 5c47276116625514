/// Vectors of three and of two numbers, or packets of them. Where an operation rounds more than once (dot, cross,
/// length), the order of operations is part of the result.
#pragma once

#include "tandem/math/error_free.h"
#include "tandem/math/inverse_square_root.h"

namespace tandem {

/// Operators work by component.
template <class T>
struct Vec3 {
    T x, y, z;

    Vec3() = default;
    TANDEM_HD_INLINE constexpr Vec3(const T& of_x, const T& of_y, const T& of_z) : x(of_x), y(of_y), z(of_z) {}
    TANDEM_HD_INLINE constexpr explicit Vec3(const T& all) : x(all), y(all), z(all) {}
    /// Each component converted, with rounding if the type is narrower.
    template <class Other>
    TANDEM_HD_INLINE constexpr explicit Vec3(const Vec3<Other>& a)
        : x(static_cast<T>(a.x)), y(static_cast<T>(a.y)), z(static_cast<T>(a.z)) {}

    TANDEM_HD_INLINE constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    TANDEM_HD_INLINE constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }

    TANDEM_HD_INLINE friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    TANDEM_HD_INLINE friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    TANDEM_HD_INLINE friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    TANDEM_HD_INLINE friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) {
        return {a.x * b.x, a.y * b.y, a.z * b.z};
    }
    TANDEM_HD_INLINE friend constexpr Vec3 operator*(const Vec3& a, const T& b) { return {a.x * b, a.y * b, a.z * b}; }
    TANDEM_HD_INLINE friend constexpr Vec3 operator*(const T& a, const Vec3& b) { return {a * b.x, a * b.y, a * b.z}; }
    TANDEM_HD_INLINE friend constexpr Vec3 operator/(const Vec3& a, const Vec3& b) {
        return {a.x / b.x, a.y / b.y, a.z / b.z};
    }
    TANDEM_HD_INLINE friend constexpr Vec3 operator/(const Vec3& a, const T& b) { return {a.x / b, a.y / b, a.z / b}; }
    TANDEM_HD_INLINE constexpr Vec3& operator+=(const Vec3& a) { return *this = *this + a; }
    TANDEM_HD_INLINE constexpr Vec3& operator-=(const Vec3& a) { return *this = *this - a; }
    TANDEM_HD_INLINE constexpr Vec3& operator*=(const Vec3& a) { return *this = *this * a; }
    TANDEM_HD_INLINE constexpr Vec3& operator*=(const T& a) { return *this = *this * a; }
    TANDEM_HD_INLINE constexpr Vec3& operator/=(const T& a) { return *this = *this / a; }
    TANDEM_HD_INLINE friend constexpr bool operator==(const Vec3& a, const Vec3& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
struct Vec2 {
    T x, y;

    Vec2() = default;
    TANDEM_HD_INLINE constexpr Vec2(const T& of_x, const T& of_y) : x(of_x), y(of_y) {}

    TANDEM_HD_INLINE constexpr T& operator[](int i) { return i == 0 ? x : y; }
    TANDEM_HD_INLINE constexpr const T& operator[](int i) const { return i == 0 ? x : y; }

    TANDEM_HD_INLINE friend constexpr Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
    TANDEM_HD_INLINE friend constexpr Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
    TANDEM_HD_INLINE friend constexpr Vec2 operator*(const Vec2& a, const T& b) { return {a.x * b, a.y * b}; }
    TANDEM_HD_INLINE friend constexpr bool operator==(const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; }
};
using Vec2f = Vec2<float>;
static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24 && sizeof(Vec2f) == 8,
              "vectors have no padding; device buffers rely on it");

/// Sum in the order ((x + y) + z).
template <class Real>
TANDEM_HD_INLINE Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class Real>
TANDEM_HD_INLINE Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// cross(a, b) with each component within 1.5 ulp, however much its products cancel.
template <class D>
TANDEM_HD_INLINE Vec3<D> accurate_cross(const Vec3<D>& a, const Vec3<D>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// Sum of magnitudes.
template <class Real>
TANDEM_HD_INLINE Real norm1(const Vec3<Real>& a) {
    return (absolute(a.x) + absolute(a.y)) + absolute(a.z);
}

/// The unit vector in double, within 4 ulp, for every vector whose squares are normal numbers, which all float vectors
/// satisfy. The zero vector stays zero.
template <class D>
TANDEM_HD_INLINE Vec3<D> normalize(const Vec3<D>& a) {
    const D scale = inverse_square_root(dot(a, a));
    return {a.x * scale, a.y * scale, a.z * scale};
}

template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> widen(const Vec3<Real>& a) {
    return {widen(a.x), widen(a.y), widen(a.z)};
}

/// One rounding per component.
template <class Real>
TANDEM_HD_INLINE Vec3<Float<Real>> narrow(const Vec3<Real>& a) {
    return {narrow(a.x), narrow(a.y), narrow(a.z)};
}

template <class Real>
TANDEM_HD_INLINE Vec3<Real> to_real(const Vec3<Double<Real>>& a) {
    return {to_real<Real>(a.x), to_real<Real>(a.y), to_real<Real>(a.z)};
}

template <class Real>
TANDEM_HD_INLINE Vec3<Real> constant(const Vec3d& a) {
    return {constant<Real>(a.x), constant<Real>(a.y), constant<Real>(a.z)};
}

template <class Real>
TANDEM_HD_INLINE Vec3<Wide<Real>> to_wide(const Vec3<Real>& a) {
    return {to_wide(a.x), to_wide(a.y), to_wide(a.z)};
}

template <class Real>
TANDEM_HD_INLINE Vec3f to_plain(const Vec3<Real>& a) {
    return {to_plain(a.x), to_plain(a.y), to_plain(a.z)};
}

/// Selects by lane; for one ray, the select() of real.h is enough.
template <class Mask, class Real>
requires(RealTraits<Real>::lanes > 1) TANDEM_HD_INLINE Vec3<Real> select(const Mask& mask, const Vec3<Real>& a,
                                                                         const Vec3<Real>& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// The same vector in every lane.
template <class Real, class Scalar>
TANDEM_HD_INLINE Vec3<Real> broadcast(const Vec3<Scalar>& a) {
    return {Real(a.x), Real(a.y), Real(a.z)};
}

}  // namespace tandem

/// Vectors: the only include of GLM. GLM brings the type and the component-wise operators; what rounds more than
/// once (dot, cross, length) is written here, because its order of operations is part of the result.
#pragma once

#include "tandem/math/error_free.h"
#include "tandem/math/inverse_square_root.h"

#define GLM_FORCE_XYZW_ONLY
#if TANDEM_COMPILING_CUDA
#include <cuda.h>  // GLM asks for its CUDA_VERSION
#define GLM_FORCE_CUDA
#pragma nv_diagnostic push
#pragma nv_diag_suppress 20012  // GLM marks defaulted functions for the device, which changes nothing
#else
#define GLM_FORCE_INLINE
#endif
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#if TANDEM_COMPILING_CUDA
#pragma nv_diagnostic pop
#endif

namespace tandem {

template <class Real>
using Vec3 = glm::vec<3, Real, glm::defaultp>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
template <class Real>
using Vec2 = glm::vec<2, Real, glm::defaultp>;
using Vec2f = Vec2<float>;
static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24 && sizeof(Vec2f) == 8,
              "vectors are packed; device buffers rely on it");

/// Sum in the order ((x + y) + z).
template <class Real>
TANDEM_HD Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class Real>
TANDEM_HD Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// cross(a, b) with each component within 1.5 units of its last place, however much its products cancel.
template <class D>
TANDEM_HD Vec3<D> accurate_cross(const Vec3<D>& a, const Vec3<D>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// Sum of magnitudes.
template <class Real>
TANDEM_HD Real norm1(const Vec3<Real>& a) {
    return (absolute(a.x) + absolute(a.y)) + absolute(a.z);
}

/// Unit vector, in double, within 4 units of its last place, of every vector whose squares are normal numbers: of all
/// float vectors. The zero vector stays zero.
template <class D>
TANDEM_HD Vec3<D> normalize(const Vec3<D>& a) {
    const D scale = inverse_square_root(dot(a, a));
    return {a.x * scale, a.y * scale, a.z * scale};
}

template <class Real>
TANDEM_HD Vec3<Double<Real>> widen(const Vec3<Real>& a) {
    return {widen(a.x), widen(a.y), widen(a.z)};
}

/// One rounding per component.
template <class Real>
TANDEM_HD Vec3<Float<Real>> narrow(const Vec3<Real>& a) {
    return {narrow(a.x), narrow(a.y), narrow(a.z)};
}

template <class Real>
TANDEM_HD Vec3<Real> to_real(const Vec3<Double<Real>>& a) {
    return {to_real<Real>(a.x), to_real<Real>(a.y), to_real<Real>(a.z)};
}

template <class Real>
TANDEM_HD Vec3<Real> constant(const Vec3d& a) {
    return {constant<Real>(a.x), constant<Real>(a.y), constant<Real>(a.z)};
}

template <class Real>
TANDEM_HD Vec3<Wide<Real>> to_wide(const Vec3<Real>& a) {
    return {to_wide(a.x), to_wide(a.y), to_wide(a.z)};
}

template <class Real>
TANDEM_HD Vec3f to_plain(const Vec3<Real>& a) {
    return {to_plain(a.x), to_plain(a.y), to_plain(a.z)};
}

/// By lane; one ray needs no more than the select() of real.h.
template <class Mask, class Real>
requires(RealTraits<Real>::lanes > 1) TANDEM_HD Vec3<Real> select(const Mask& mask, const Vec3<Real>& a,
                                                                  const Vec3<Real>& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// The same vector in every lane.
template <class Real, class Scalar>
TANDEM_HD Vec3<Real> broadcast(const Vec3<Scalar>& a) {
    return {Real(a.x), Real(a.y), Real(a.z)};
}

}  // namespace tandem

#include "tandem/oracle/oracle_media.h"

#include <algorithm>
#include <cmath>

namespace tandem::oracle {

Real index_of(const SceneView& scene, std::uint32_t medium) {
    return medium == no_medium ? 1 : Real{scene.optics[medium].ior};
}

Real refract(const Vector& d, const Vector& n, Real from, Real to, Vector& onward) {
    const Real eta = from / to;
    if (eta == 1) {
        onward = d;
        return 0;
    }
    const Real cos_in = std::clamp<Real>(-inner(d, n), 0, 1);
    const Vector tangent = d + n * cos_in;
    const Real sin_out = std::sqrt(inner(tangent, tangent)) * eta;
    if (sin_out > 1) return 1;
    const Real cos_out = std::sqrt((1 - sin_out) * (1 + sin_out));
    onward = unit(tangent * eta - n * cos_out);
    const Real s = (from * cos_in - to * cos_out) / (from * cos_in + to * cos_out);
    const Real p = (from * cos_out - to * cos_in) / (from * cos_out + to * cos_in);
    return (s * s + p * p) / 2;
}

}  // namespace tandem::oracle

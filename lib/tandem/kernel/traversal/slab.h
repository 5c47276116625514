/// Ray-box tests of BVH nodes, for proposals only. The padding of the boxes covers the rounding
/// (kernel/traversal/proposal.h), so speed matters more than the last bit. The only place in kernel code where fminf
/// and fmaxf are allowed.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// A query ray in the form that slab_entry() needs.
struct SlabRay {
    Vec3f inverse_direction;
    Vec3f origin_over_direction;
};

/// `direction` is a unit vector. A component too small to invert is replaced, which moves the ray inside the scene by
/// less than the padding of the boxes.
TANDEM_HD_INLINE SlabRay make_slab_ray(const Vec3f& origin, const Vec3f& direction) {
    const auto invert = [](float d) {
        const float safe = absolute(d) < 1e-18F ? (d < 0.0F ? -1e-18F : 1e-18F) : d;
        return 1.0F / safe;
    };
    const Vec3f inverse = {invert(direction.x), invert(direction.y), invert(direction.z)};
    return {inverse, origin * inverse};
}

/// The entry into the box within [start, limit]; above `limit` if there is none.
TANDEM_HD_INLINE float slab_entry(const SlabRay& ray, float lower_x, float upper_x, float lower_y, float upper_y,
                                  float lower_z, float upper_z, float start, float limit) {
    const float x0 = loose_multiply_add(lower_x, ray.inverse_direction.x, -ray.origin_over_direction.x);
    const float x1 = loose_multiply_add(upper_x, ray.inverse_direction.x, -ray.origin_over_direction.x);
    const float y0 = loose_multiply_add(lower_y, ray.inverse_direction.y, -ray.origin_over_direction.y);
    const float y1 = loose_multiply_add(upper_y, ray.inverse_direction.y, -ray.origin_over_direction.y);
    const float z0 = loose_multiply_add(lower_z, ray.inverse_direction.z, -ray.origin_over_direction.z);
    const float z1 = loose_multiply_add(upper_z, ray.inverse_direction.z, -ray.origin_over_direction.z);
    const float entry = fmaxf(fmaxf(fminf(x0, x1), fminf(y0, y1)), fmaxf(fminf(z0, z1), start));
    const float exit = fminf(fminf(fmaxf(x0, x1), fmaxf(y0, y1)), fminf(fmaxf(z0, z1), limit));
    return entry <= exit ? entry : 3.4e38F;
}

}  // namespace tandem

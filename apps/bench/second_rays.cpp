#include "second_rays.h"

#include "ray_sets.h"

namespace tandem::bench {

RaysToTrace second_rays(const std::vector<Ray<float>>& first, const std::vector<Hit>& hits, int edge, bool shadow) {
    const Vec3d light = {0.8, 3, 2};
    RaysToTrace result{make_rays(RaySet::random, edge), {}, {}};
    result.sources.resize(first.size());
    if (shadow) result.ends.resize(first.size(), {1, no_primitive});
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (hits[i].primitive == no_primitive) continue;
        const Vec3d way = widen(first[i].direction);
        const Vec3d point = widen(first[i].origin) + way * double{hits[i].t};
        Vec3d direction = light - point;
        if (!shadow) {
            direction = widen(result.rays[i].direction);
            if (dot(direction, way) > 0) direction = -direction;
        }
        result.rays[i] = {narrow(point), narrow(direction)};
        result.sources[i].primitive = hits[i].primitive;
    }
    return result;
}

}  // namespace tandem::bench

#include "baseline/embree_native.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ray_sets.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::bench {
namespace {

TEST(EmbreeNative, HitsTheSpheresThatTandemHits) {
    const PreparedScene scene = prepare(named_scene("spheres/500"));
    const LoopTracer tracer{view(scene)};
    for (const int threads : {0, 1, 2}) {
        EmbreeNative native(scene.spheres, threads);
        EXPECT_GE(native.build_seconds(), 0);
        for (const RaySet set : {RaySet::coherent, RaySet::random}) {
            const auto rays = make_rays(set, 64);
            std::vector<Hit> hits(rays.size());
            EXPECT_GT(native.trace(rays, hits), 0);
            int ids = 0, met = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Hit expected = to_hit(tracer.closest(rays[i], NoSource{}, true));
                met += expected.primitive != no_primitive ? 1 : 0;
                if (expected.primitive != hits[i].primitive) {
                    ++ids;
                } else if (expected.primitive != no_primitive) {
                    EXPECT_NEAR(hits[i].t, expected.t, 1e-4 * std::abs(double{expected.t}) + 1e-5);
                }
            }
            EXPECT_GT(met, 500) << to_string(set);
            EXPECT_LE(ids, 8) << "of 4096 rays; Embree's sphere test is approximate at silhouettes";
        }
    }
}

TEST(EmbreeNative, HitsTheTrianglesThatTandemHits) {
    const PreparedScene scene = prepare(named_scene("icosphere/3"));
    const LoopTracer tracer{view(scene)};
    for (const EmbreeFlags flags : {EmbreeFlags::plain, EmbreeFlags::robust}) {
        EmbreeNative native(scene.triangles, 1, flags);
        const auto rays = make_rays(RaySet::coherent, 64);
        std::vector<Hit> hits(rays.size());
        EXPECT_GT(native.trace(rays, hits), 0);
        int met = 0, ids = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = to_hit(tracer.closest(rays[i], NoSource{}, true));
            met += expected.primitive != no_primitive ? 1 : 0;
            ids += expected.primitive != hits[i].primitive ? 1 : 0;
        }
        EXPECT_GT(met, 500);
        EXPECT_LE(ids, 8) << "of 4096 rays; Embree's triangles are approximate at edges";
    }
}

}  // namespace
}  // namespace tandem::bench

/// The CPU's kernels, compiled once per instruction set, behind plain function pointers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "cpu/embree_api.h"
#include "tandem/accuracy/tier.h"
#include "tandem/bvh/proposal.h"
#include "tandem/effects/variants.h"
#include "tandem/geometry/hit.h"
#include "tandem/integrator/pixel.h"
#include "tandem/render/stats.h"
#include "tandem/render/trace_job.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

/// What lies in an Embree scene, by geomID: our primitives, all of them in the exact tiers; in the tier fast faces are
/// Embree's own.
enum GeometryId : std::uint32_t { our_primitives, embree_triangles, embree_quads, geometry_count };

/// A scene as the kernels read it. `embree` is null for a scene of few primitives, which are tried one by one.
struct CpuSceneView {
    SceneView scene;
    StructureFrame frame;
    RTCScene embree;
    std::uint32_t first_id[geometry_count];  ///< of the primitives in each geometry
};

/// Pixels [x0, x1) x [y0, y1).
struct Tile {
    std::uint32_t x0, x1, y0, y1;
};

/// What happened in one.
struct TileStats {
    RenderCounters counters;
    std::uint64_t rays = 0;  ///< if the path loop counts them (counted_ray_effects)

    template <class Real>
    TANDEM_HD void add(const PathTally<Real>& tally) {
        for (int i = 0; i < Real::size; ++i) {
            counters.lost_media += tally.lost_media[i];
            rays += tally.rays[i];
        }
    }
};

/// The sets of effects that the path loop is compiled for.
inline constexpr KernelVariant variants[] = {
    {"plain", {}},
    {"full", all_effects},
};
inline constexpr std::size_t variant_count = std::size(variants);

/// The kernels of one tier for one instruction set.
struct TierKernels {
    /// Writes the sums of the tile's pixels into the film (rows of job.width). By variant.
    TileStats (*render_tile[variant_count])(const CpuSceneView& scene, const PixelJob& job, const Tile& tile,
                                            Vec3d* sums);
    /// Returns how many rays were not traceable.
    std::uint64_t (*trace)(const CpuSceneView& scene, const TraceJob& job);
    /// Embree's callbacks for primitives. The geometry's user pointer is a CpuSceneView.
    RTCIntersectFunctionN intersect;
    RTCOccludedFunctionN occluded;
    /// Embree's filters of hits on its own faces, in the tier fast; else null.
    RTCFilterFunctionN filter_nearest;
    RTCFilterFunctionN filter_any;
};

// By instruction set; the fast tier's are compiled apart, with other flags.
[[nodiscard]] const TierKernels& exact_kernels_v2(Tier tier);
[[nodiscard]] const TierKernels& exact_kernels_v3(Tier tier);
[[nodiscard]] const TierKernels& exact_kernels_v4(Tier tier);
[[nodiscard]] const TierKernels& fast_kernels_v2();
[[nodiscard]] const TierKernels& fast_kernels_v3();
[[nodiscard]] const TierKernels& fast_kernels_v4();

}  // namespace tandem

/// The CPU kernels, compiled once per tier and instruction set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "cpu/cut_primitives.h"
#include "cpu/embree_api.h"
#include "cpu/size_layers.h"
#include "tandem/effects/variants.h"
#include "tandem/kernel/pixel.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/surface_lobes.h"
#include "tandem/kernel/traversal/proposal.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/render/stats.h"
#include "tandem/render/tier.h"
#include "tandem/render/trace_job.h"

namespace tandem {

/// The geometries of an Embree scene, by geomID: user geometry, which holds all primitives in the exact tiers; in the
/// tier fast, faces are Embree's own geometry.
enum GeometryId : std::uint32_t { our_primitives, embree_triangles, embree_quads, geometry_count };

struct GroupView;  // primitive_groups.h

/// A scene as kernels read it. `embree` is null for a scene of few primitives, which are tested one by one. If `groups`
/// is not null, single rays go through its hierarchy.
struct CpuSceneView {
    SceneView scene;
    StructureFrame frame;
    RTCScene embree;
    std::uint32_t first_id[geometry_count];  ///< of the primitives in each geometry
    const GroupView* groups;
    SizeRange sizes;                        ///< of the primitives in `embree`
    const CpuSceneView* smaller = nullptr;  ///< the next layer: the same scene, and a hierarchy of smaller primitives
    const CutPrimitives* cut = nullptr;     ///< null if no primitive is in pieces
    std::uint32_t first_piece = ~0U;        ///< the items of our_primitives from here on are further pieces
    bool splits_packets = false;            ///< whether trace() traces coherent rays one by one too
};

/// The primitive of item `number` of our_primitives.
[[nodiscard]] TANDEM_HD_INLINE std::uint32_t primitive_of_item(const CpuSceneView& view, std::uint32_t number) {
    return number < view.first_piece ? number : view.cut->further[number - view.first_piece].primitive;
}

/// Pixels [x0, x1) x [y0, y1).
struct Tile {
    std::uint32_t x0, x1, y0, y1;
};

/// Statistics of one tile.
struct TileStats {
    RenderCounters counters;
    std::uint64_t rays = 0;  ///< only if the path loop counts them (counted_ray_effects)

    template <class Real>
    TANDEM_HD_INLINE void add(const PathTally<Real>& tally) {
        for (int i = 0; i < Real::size; ++i) {
            counters.lost_media += tally.lost_media[i];
            rays += tally.rays[i];
        }
    }
};

/// The sets of effects that the path loop is compiled for, chosen by the cost of carried effects in the scenes of
/// assets/scenes (docs/performance/cpu.md). `exact` is for measuring that cost (CMake variable
/// TANDEM_EXACT_VARIANT).
inline constexpr KernelVariant variants[] = {
    {"plain", {}},
#if defined(TANDEM_EXACT_EFFECTS)
    {"exact", EffectMask() | TANDEM_EXACT_EFFECTS},
#endif
    {"direct", direct_effects},
    {"full", all_effects},
};
inline constexpr std::size_t variant_count = std::size(variants);

/// The index of a variant.
[[nodiscard]] consteval std::size_t variant_named(std::string_view name) {
    for (std::size_t i = 0; i < variant_count; ++i) {
        if (variants[i].name == name) return i;
    }
    throw "no variant has this name";
}

/// The kernels of one tier for one instruction set (math/lane_registers.h). Each entry is compiled in a file of its own
/// (cpu/kernels/).
template <class Isa, Tier tier>
struct CpuKernels {
    /// Writes the sums of the tile's pixels into the film (rows of job.width).
    template <std::size_t variant>
    static TileStats render_tile(const CpuSceneView& scene, const PixelJob& job, const Tile& tile, Vec3d* sums);
    /// Returns how many rays were not traceable.
    static std::uint64_t trace(const CpuSceneView& scene, const TraceJob& job);
    // Embree's callbacks for user geometry, whose user pointer is a CpuSceneView.
    static void intersect(const RTCIntersectFunctionNArguments* args);
    static void occluded(const RTCOccludedFunctionNArguments* args);
    // Embree's filters for hits on its own faces, in the tier fast.
    static void filter_nearest(const RTCFilterFunctionNArguments* args);
    static void filter_any(const RTCFilterFunctionNArguments* args);
};

/// The kernels as plain function pointers.
struct TierKernels {
    TileStats (*render_tile[variant_count])(const CpuSceneView& scene, const PixelJob& job, const Tile& tile,
                                            Vec3d* sums);
    std::uint64_t (*trace)(const CpuSceneView& scene, const TraceJob& job);
    RTCIntersectFunctionN intersect;
    RTCOccludedFunctionN occluded;
    RTCFilterFunctionN filter_nearest;  ///< null except in the tier fast
    RTCFilterFunctionN filter_any;      ///< the same
    int packet_rays;
};

}  // namespace tandem

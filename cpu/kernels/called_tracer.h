/// The tracer of a scene, behind function calls.
#pragma once

#include "cpu/kernels.h"
#include "cpu/query_source.h"

namespace tandem {

// Defined in cpu/kernels/query.cpp. `Isa` makes the names unique: Real does not always determine the instruction set.
template <class Isa, class Real>
[[nodiscard]] Closest<Real> closest_hit(const CpuSceneView& view, const Ray<Real>& ray, const QuerySource<Real>& source,
                                        const Mask<Real>& active, const Double<Real>& farthest);
template <class Isa, class Real>
[[nodiscard]] Mask<Real> any_hit(const CpuSceneView& view, const Ray<Real>& ray, const Double<Real>& t_max,
                                 const QuerySource<Real>& source, const Mask<Real>& active);
template <class Isa, class Real, class Hits>
[[nodiscard]] Mask<Real> any_blocker(const CpuSceneView& view, const Ray<Real>& ray, const Double<Real>& t_max,
                                     const MaskedShadowSource<Real>& source, const Mask<Real>& active, Hits& hits);

/// Rays that are traced one by one.
template <class Real>
struct RayBatch {
    static constexpr int most = 16;
    int count = 0;
    Ray<Real> ray[most];
    const QuerySource<Real>* source[most];  ///< the caller keeps them; often all are the same
    Double<Real> t_max[most];               ///< for any_hits()
    bool active[most];

    TANDEM_HD_INLINE void add(const Ray<Real>& one, const QuerySource<Real>& from, bool is_active) {
        ray[count] = one;
        source[count] = &from;
        active[count++] = is_active;
    }
};
/// Writes the hit of ray i to hits[i], and whether it is blocked to occluded[i].
template <class Isa, class Real>
void closest_hits(const CpuSceneView& view, const RayBatch<Real>& batch, Closest<Real>* hits);
template <class Isa, class Real>
void any_hits(const CpuSceneView& view, const RayBatch<Real>& batch, bool* occluded);

/// One copy of each function serves the whole path loop and trace(). The plain path loop has its own inline tracer.
template <class Isa>
struct CalledTracer {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all;
    static constexpr bool has_hierarchy = true;
    const CpuSceneView& view;

    template <class Real, class From>
    [[nodiscard]] TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const From& source,
                                                         const Mask<Real>& active,
                                                         const Double<Real>& farthest = no_hit<Real>().t) const {
        return closest_hit<Isa, Real>(view, ray, QuerySource<Real>(source), active, farthest);
    }
    template <class Real, class From>
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                                       const From& source, const Mask<Real>& active) const {
        return any_hit<Isa, Real>(view, ray, t_max, QuerySource<Real>(source), active);
    }
    /// Whether the tracer has find_blocker(): not where it tests all primitives.
    [[nodiscard]] TANDEM_HD_INLINE bool finds_blockers() const { return view.embree != nullptr; }
    /// As BvhStructure::find_blocker().
    template <class Real, class Hits>
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> find_blocker(const Ray<Real>& ray, const Double<Real>& t_max,
                                                           const MaskedShadowSource<Real>& source,
                                                           const Mask<Real>& active, Hits& hits) const {
        return any_blocker<Isa, Real>(view, ray, t_max, source, active, hits);
    }
    template <class Real>
    TANDEM_HD_INLINE void closest(const RayBatch<Real>& batch, Closest<Real>* hits) const {
        closest_hits<Isa, Real>(view, batch, hits);
    }
    template <class Real>
    TANDEM_HD_INLINE void occluded(const RayBatch<Real>& batch, bool* results) const {
        any_hits<Isa, Real>(view, batch, results);
    }
};

}  // namespace tandem

// closest_hit(), any_hit() and Embree's callbacks of one tier for one instruction set.
#include "cpu/embree_tracer.h"
#include "cpu/group_tracer.h"
#include "cpu/kernels/called_tracer.h"
#include "cpu/kernels/tier_reals.h"

namespace tandem {

template <class Isa, class Real>
using IsaOf = std::conditional_t<is_fast<Real>, Fast<Isa>, Isa>;

// Packets go through Embree, or test all primitives of a small scene.

template <class Isa, class Real>
Closest<Real> closest_hit(const CpuSceneView& view, const Ray<Real>& ray, const QuerySource<Real>& source,
                          const Mask<Real>& active, const Double<Real>& farthest) {
    if (view.embree == nullptr) return LoopTracer{view.scene}.closest(ray, source, active, farthest);
    return EmbreeTracer{view}.closest(ray, source, active, farthest);
}

template <class Isa, class Real>
Mask<Real> any_hit(const CpuSceneView& view, const Ray<Real>& ray, const Double<Real>& t_max,
                   const QuerySource<Real>& source, const Mask<Real>& active) {
    if (view.embree == nullptr) return LoopTracer{view.scene}.occluded(ray, t_max, source, active);
    return EmbreeTracer{view}.occluded(ray, t_max, source, active);
}

template <class Isa, class Real, class Hits>
Mask<Real> any_blocker(const CpuSceneView& view, const Ray<Real>& ray, const Double<Real>& t_max,
                       const MaskedShadowSource<Real>& source, const Mask<Real>& active, Hits& hits) {
    return EmbreeTracer{view}.occluded(ray, t_max, QuerySource<Real>(source), active, &hits);
}

// Single rays go through groups, if there are any.

template <class Isa, class Real>
void closest_hits(const CpuSceneView& view, const RayBatch<Real>& batch, Closest<Real>* hits) {
    if (view.groups != nullptr) {
        const auto write = [&](int i, auto& ray) { hits[i] = ray.closest(view); };
        return trace_groups<Search::nearest, IsaOf<Isa, Real>>(view, batch, write);
    }
    for (int i = 0; i < batch.count; ++i) {
        hits[i] = EmbreeTracer{view}.closest(batch.ray[i], *batch.source[i], batch.active[i]);
    }
}

template <class Isa, class Real>
void any_hits(const CpuSceneView& view, const RayBatch<Real>& batch, bool* occluded) {
    if (view.groups != nullptr) {
        const auto write = [&](int i, auto& ray) { occluded[i] = ray.occluded(view, batch.t_max[i]); };
        return trace_groups<Search::any, IsaOf<Isa, Real>>(view, batch, write);
    }
    for (int i = 0; i < batch.count; ++i) {
        occluded[i] = EmbreeTracer{view}.occluded(batch.ray[i], batch.t_max[i], *batch.source[i], batch.active[i]);
    }
}

template <class Isa, Tier tier>
void CpuKernels<Isa, tier>::intersect(const RTCIntersectFunctionNArguments* args) {
    using Reals = TierReals<Isa, tier>;
    intersect_callback<typename Reals::One, typename Reals::Packet>(args);
}
template <class Isa, Tier tier>
void CpuKernels<Isa, tier>::occluded(const RTCOccludedFunctionNArguments* args) {
    using Reals = TierReals<Isa, tier>;
    occluded_callback<typename Reals::One, typename Reals::Packet>(args);
}
template <class Isa, Tier tier>
void CpuKernels<Isa, tier>::filter_nearest(const RTCFilterFunctionNArguments* args) {
    using Reals = TierReals<Isa, tier>;
    filter_callback<Search::nearest, typename Reals::One, typename Reals::Packet>(args);
}
template <class Isa, Tier tier>
void CpuKernels<Isa, tier>::filter_any(const RTCFilterFunctionNArguments* args) {
    using Reals = TierReals<Isa, tier>;
    filter_callback<Search::any, typename Reals::One, typename Reals::Packet>(args);
}

using ThisIsa = TANDEM_KERNEL_ISA;
using These = CpuKernels<ThisIsa, Tier::TANDEM_KERNEL_TIER>;
using One = TierReals<ThisIsa, Tier::TANDEM_KERNEL_TIER>::One;
using Packet = TierReals<ThisIsa, Tier::TANDEM_KERNEL_TIER>::Packet;

template Closest<Packet> closest_hit<ThisIsa, Packet>(const CpuSceneView&, const Ray<Packet>&,
                                                      const QuerySource<Packet>&, const Mask<Packet>&,
                                                      const Double<Packet>&);
template Mask<Packet> any_hit<ThisIsa, Packet>(const CpuSceneView&, const Ray<Packet>&, const Double<Packet>&,
                                               const QuerySource<Packet>&, const Mask<Packet>&);
template Mask<Packet> any_blocker<ThisIsa, Packet, CpuMaskedHits<Packet>>(const CpuSceneView&, const Ray<Packet>&,
                                                                          const Double<Packet>&,
                                                                          const MaskedShadowSource<Packet>&,
                                                                          const Mask<Packet>&, CpuMaskedHits<Packet>&);
template void closest_hits<ThisIsa, One>(const CpuSceneView&, const RayBatch<One>&, Closest<One>*);
template void any_hits<ThisIsa, One>(const CpuSceneView&, const RayBatch<One>&, bool*);
template void These::intersect(const RTCIntersectFunctionNArguments*);
template void These::occluded(const RTCOccludedFunctionNArguments*);
#if TANDEM_KERNEL_FILTERS
template void These::filter_nearest(const RTCFilterFunctionNArguments*);
template void These::filter_any(const RTCFilterFunctionNArguments*);
#endif

}  // namespace tandem

// closest_hit(), any_hit() and Embree's callbacks of one tier for one instruction set.
#include "cpu/group_tracer.h"
#include "cpu/kernels/called_tracer.h"
#include "cpu/kernels/tier_reals.h"

namespace tandem {

template <class Isa, class Real>
using IsaOf = std::conditional_t<is_fast<Real>, Fast<Isa>, Isa>;

// Scenes of few primitives, which have no Embree scene, are only tested with packets (cpu/kernels/trace.cpp).

template <class Isa, class Real>
Closest<Real> closest_hit(const CpuSceneView& view, const Ray<Real>& ray, const QuerySource<Real>& source,
                          const Mask<Real>& active) {
    if constexpr (RealTraits<Real>::lanes > 1) {
        if (view.embree == nullptr) return LoopTracer{view.scene}.closest(ray, source, active);
    } else if (view.groups != nullptr) {
        return GroupTracer<IsaOf<Isa, Real>>{view}.closest(ray, source, active);
    }
    return EmbreeTracer{view}.closest(ray, source, active);
}

template <class Isa, class Real>
Mask<Real> any_hit(const CpuSceneView& view, const Ray<Real>& ray, const Double<Real>& t_max,
                   const QuerySource<Real>& source, const Mask<Real>& active) {
    if constexpr (RealTraits<Real>::lanes > 1) {
        if (view.embree == nullptr) return LoopTracer{view.scene}.occluded(ray, t_max, source, active);
    } else if (view.groups != nullptr) {
        return GroupTracer<IsaOf<Isa, Real>>{view}.occluded(ray, t_max, source, active);
    }
    return EmbreeTracer{view}.occluded(ray, t_max, source, active);
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
void CpuKernels<Isa, tier>::intersect_group(const RTCIntersectFunctionNArguments* args) {
    using One = typename TierReals<Isa, tier>::One;
    intersect_group_callback<One, IsaOf<Isa, One>>(args);
}
template <class Isa, Tier tier>
void CpuKernels<Isa, tier>::occluded_group(const RTCOccludedFunctionNArguments* args) {
    using One = typename TierReals<Isa, tier>::One;
    occluded_group_callback<One, IsaOf<Isa, One>>(args);
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

template Closest<One> closest_hit<ThisIsa, One>(const CpuSceneView&, const Ray<One>&, const QuerySource<One>&,
                                                const Mask<One>&);
template Closest<Packet> closest_hit<ThisIsa, Packet>(const CpuSceneView&, const Ray<Packet>&,
                                                      const QuerySource<Packet>&, const Mask<Packet>&);
template Mask<One> any_hit<ThisIsa, One>(const CpuSceneView&, const Ray<One>&, const Double<One>&,
                                         const QuerySource<One>&, const Mask<One>&);
template Mask<Packet> any_hit<ThisIsa, Packet>(const CpuSceneView&, const Ray<Packet>&, const Double<Packet>&,
                                               const QuerySource<Packet>&, const Mask<Packet>&);
template void These::intersect(const RTCIntersectFunctionNArguments*);
template void These::occluded(const RTCOccludedFunctionNArguments*);
template void These::intersect_group(const RTCIntersectFunctionNArguments*);
template void These::occluded_group(const RTCOccludedFunctionNArguments*);
#if TANDEM_KERNEL_FILTERS
template void These::filter_nearest(const RTCFilterFunctionNArguments*);
template void These::filter_any(const RTCFilterFunctionNArguments*);
#endif

}  // namespace tandem

/// Tracing through Embree: it proposes primitives, the shared intersectors decide.
#pragma once

#include <cstring>

#include "cpu/kernels.h"
#include "tandem/geometry/intersect.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// What travels with a query. The head must come first: Embree hands its address to the callback.
template <class Real>
struct QueryContext {
    embree::QueryContext head;
    FilterRay<Real> filter;  ///< the true ray
    Proposal<Real> proposal;
    Closest<Real> best;
    const Source<Real>* source;               ///< for the nearest hit; null for rays that leave no surface
    const ShadowSource<Real>* shadow_source;  ///< for any hit
};

/// The decision on a candidate for the nearest hit.
template <class Real>
TANDEM_HD void offer_candidate(const SceneView& scene, std::uint32_t primitive, const Mask<Real>& active,
                               QueryContext<Real>& query) {
    if (query.source == nullptr) {
        intersect_primitive<Real>(scene, primitive, query.filter, NoSource{}, active, query.best);
    } else {
        intersect_primitive<Real>(scene, primitive, query.filter, *query.source, active, query.best);
    }
}

/// `One` and `Packet`: the Reals of the tier, for one ray and for many.
template <class One, class Packet>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<One>*>(args->context);
        const Double<One> before = query.best.t;
        offer_candidate<One>(view.scene, args->primID, true, query);
        auto& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
        if (query.best.t < before) ray.tfar = to_plain(query.proposal.limit(query.best.t));
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Packet>*>(args->context);
    const Mask<Packet> active(*reinterpret_cast<const typename Mask<Packet>::Vector*>(args->valid));
    const Double<Packet> before = query.best.t;
    offer_candidate<Packet>(view.scene, args->primID, active, query);
    const Mask<Packet> nearer = query.best.t < before;
    if (any(nearer)) {
        auto& ray = reinterpret_cast<typename embree::Packet<Packet::size>::RayHit*>(args->rayhit)->ray;
        auto* tfar = reinterpret_cast<Float<Packet>*>(ray.tfar);
        *tfar = select(nearer, query.proposal.limit(query.best.t), *tfar);
    }
}

/// As intersect_callback() for any hit before best.t. Embree takes a tfar of -infinity for "occluded".
template <class One, class Packet>
void occluded_callback(const RTCOccludedFunctionNArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    constexpr float found = -__builtin_huge_valf();
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<One>*>(args->context);
        const Double<One> before = query.best.t;
        intersect_primitive<One>(view.scene, args->primID, query.filter, *query.shadow_source, true, query.best);
        if (query.best.t < before) reinterpret_cast<RTCRay*>(args->ray)->tfar = found;
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Packet>*>(args->context);
    const Mask<Packet> active(*reinterpret_cast<const typename Mask<Packet>::Vector*>(args->valid));
    const Double<Packet> before = query.best.t;
    intersect_primitive<Packet>(view.scene, args->primID, query.filter, *query.shadow_source, active, query.best);
    const Mask<Packet> nearer = query.best.t < before;
    if (any(nearer)) {
        auto& ray = *reinterpret_cast<typename embree::Packet<Packet::size>::Ray*>(args->ray);
        auto* tfar = reinterpret_cast<Float<Packet>*>(ray.tfar);
        *tfar = select(nearer, Float<Packet>(found), *tfar);
    }
}

struct EmbreeTracer {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all;

    const CpuSceneView& view;

    /// As LoopTracer::closest().
    template <class Real, class From>
    [[nodiscard]] TANDEM_HD Closest<Real> closest(const Ray<Real>& ray, const From& source, bool active) const {
        QueryContext<Real> query;
        query.best = no_hit<Real>();
        set_source(query, source);
        if (!start(query, ray, active, false)) return query.best;
        RTCRayHit rayhit;
        rayhit.ray = single_ray(query, 3e38F);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect1(view.embree, query.head, rayhit);
        return query.best;
    }

    template <class T, class Isa, class From>
    [[nodiscard]] TANDEM_HD Closest<Lanes<T, Isa>> closest(const Ray<Lanes<T, Isa>>& ray, const From& source,
                                                           const LaneMask<Isa>& active) const {
        using Real = Lanes<T, Isa>;
        QueryContext<Real> query;
        query.best = no_hit<Real>();
        set_source(query, source);
        if (!start(query, ray, active, true)) return query.best;
        alignas(64) typename embree::Packet<Real::size>::RayHit rayhit;
        set_packet(rayhit.ray, query, Float<Real>(3e38F));
        const UInt<Real> none(RTC_INVALID_GEOMETRY_ID);
        std::memcpy(rayhit.hit.geomID, &none, sizeof(none));
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.v;
        embree::intersect(reinterpret_cast<const int*>(&valid), view.embree, query.head, rayhit);
        return query.best;
    }

    /// As LoopTracer::occluded().
    template <class Real>
    [[nodiscard]] TANDEM_HD bool occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                          const ShadowSource<Real>& source, bool active) const {
        QueryContext<Real> query;
        query.best = before<Real>(t_max);
        query.shadow_source = &source;
        if (!start(query, ray, active, false)) return false;
        const float limit = to_plain(query.proposal.limit(t_max));
        if (!(limit >= 0)) return false;
        RTCRay embree_ray = single_ray(query, limit);
        embree::occluded1(view.embree, query.head, embree_ray);
        return query.best.t < t_max;
    }

    template <class T, class Isa>
    [[nodiscard]] TANDEM_HD LaneMask<Isa> occluded(const Ray<Lanes<T, Isa>>& ray, const Double<Lanes<T, Isa>>& t_max,
                                                   const ShadowSource<Lanes<T, Isa>>& source,
                                                   const LaneMask<Isa>& active) const {
        using Real = Lanes<T, Isa>;
        using F = Float<Real>;
        QueryContext<Real> query;
        query.best = before<Real>(t_max);
        query.shadow_source = &source;
        if (!start(query, ray, active, true)) return LaneMask<Isa>(false);
        const F limit = query.proposal.limit(t_max);
        query.proposal.active = query.proposal.active && limit >= F(0.0F);
        if (!any(query.proposal.active)) return LaneMask<Isa>(false);
        alignas(64) typename embree::Packet<Real::size>::Ray embree_ray;
        set_packet(embree_ray, query, select(query.proposal.active, limit, F(0.0F)));
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.v;
        embree::occluded(reinterpret_cast<const int*>(&valid), view.embree, query.head, embree_ray);
        return query.proposal.active && query.best.t < t_max;
    }

  private:
    template <class Real>
    TANDEM_HD static void set_source(QueryContext<Real>& query, const NoSource&) {
        query.source = nullptr;
    }
    template <class Real>
    TANDEM_HD static void set_source(QueryContext<Real>& query, const Source<Real>& source) {
        query.source = &source;
    }

    /// Fills what all queries have; false if no lane can hit anything.
    template <class Real>
    TANDEM_HD bool start(QueryContext<Real>& query, const Ray<Real>& ray, const Mask<Real>& active,
                         bool coherent) const {
        query.proposal = propose(ray, view.frame, active);
        if (!any(query.proposal.active)) return false;
        query.filter = make_filter_ray(ray);
        embree::init_context(query.head, coherent);
        return true;
    }

    template <class Real>
    TANDEM_HD static RTCRay single_ray(const QueryContext<Real>& query, float tfar) {
        const Ray<float> p = {to_plain(query.proposal.ray.origin), to_plain(query.proposal.ray.direction)};
        return {p.origin.x, p.origin.y, p.origin.z, 0, p.direction.x, p.direction.y, p.direction.z, 0,
                tfar,       0xFFFFFFFF, 0,          0};
    }

    template <class PacketRay, class Real>
    TANDEM_HD static void set_packet(PacketRay& ray, const QueryContext<Real>& query, const Float<Real>& tfar) {
        using F = Float<Real>;
        const auto set = [](auto* field, const auto& value) { std::memcpy(field, &value, sizeof(value)); };
        const Ray<F>& p = query.proposal.ray;
        const F zero(0.0F);
        // lanes that take no part still hold numbers: Debian's Embree asserts that every ray is valid
        const Vec3<F> origin = select(query.proposal.active, p.origin, Vec3<F>{zero, zero, zero});
        const Vec3<F> direction = select(query.proposal.active, p.direction, Vec3<F>{zero, zero, F(1.0F)});
        set(ray.org_x, origin.x);
        set(ray.org_y, origin.y);
        set(ray.org_z, origin.z);
        set(ray.dir_x, direction.x);
        set(ray.dir_y, direction.y);
        set(ray.dir_z, direction.z);
        set(ray.tnear, zero);
        set(ray.tfar, tfar);
        set(ray.time, zero);
        set(ray.mask, UInt<Real>(0xFFFFFFFFU));
        set(ray.id, zero);
        set(ray.flags, zero);
    }
};

}  // namespace tandem

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
};

/// Candidate `primitive` for one ray of Embree's.
template <class Real>
TANDEM_HD void offer_candidate(const SceneView& scene, std::uint32_t primitive, QueryContext<Real>& query,
                               RTCRayHit& ray) {
    const Double<Real> before = query.best.t;
    intersect_primitive<Real>(scene, primitive, query.filter, true, query.best);
    if (query.best.t < before) ray.ray.tfar = to_plain(query.proposal.limit(query.best.t));
}

/// Candidate `primitive` for the lanes of `active`.
template <class Real, class PacketRay>
TANDEM_HD void offer_candidate(const SceneView& scene, std::uint32_t primitive, const Mask<Real>& active,
                               QueryContext<Real>& query, PacketRay& ray) {
    const Double<Real> before = query.best.t;
    intersect_primitive<Real>(scene, primitive, query.filter, active, query.best);
    const Mask<Real> nearer = query.best.t < before;
    if (any(nearer)) {
        auto* tfar = reinterpret_cast<Float<Real>*>(ray.ray.tfar);
        *tfar = select(nearer, query.proposal.limit(query.best.t), *tfar);
    }
}

/// `One` and `Packet`: the Reals of the tier, for one ray and for many.
template <class One, class Packet>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<One>*>(args->context);
        offer_candidate<One>(view.scene, args->primID, query, *reinterpret_cast<RTCRayHit*>(args->rayhit));
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Packet>*>(args->context);
    const Mask<Packet> active(*reinterpret_cast<const typename Mask<Packet>::Vector*>(args->valid));
    auto& ray = *reinterpret_cast<typename embree::Packet<Packet::size>::RayHit*>(args->rayhit);
    offer_candidate<Packet>(view.scene, args->primID, active, query, ray);
}

struct EmbreeTracer {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all;

    const CpuSceneView& view;

    template <class Real>
    [[nodiscard]] TANDEM_HD Closest<Real> closest(const Ray<Real>& ray, bool) const {
        QueryContext<Real> query;
        query.best = no_hit<Real>();
        query.proposal = propose(ray, view.frame, true);
        if (!query.proposal.active) return query.best;
        query.filter = make_filter_ray(ray);
        embree::init_context(query.head, false);
        const Ray<float> p = {to_plain(query.proposal.ray.origin), to_plain(query.proposal.ray.direction)};
        RTCRayHit rayhit;
        rayhit.ray = {p.origin.x, p.origin.y, p.origin.z, 0, p.direction.x, p.direction.y, p.direction.z, 0,
                      3e38F,      0xFFFFFFFF, 0,          0};
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect1(view.embree, query.head, rayhit);
        return query.best;
    }

    template <class T, class Isa>
    [[nodiscard]] TANDEM_HD Closest<Lanes<T, Isa>> closest(const Ray<Lanes<T, Isa>>& ray,
                                                           const LaneMask<Isa>& active) const {
        using Real = Lanes<T, Isa>;
        using F = Float<Real>;
        QueryContext<Real> query;
        query.best = no_hit<Real>();
        query.proposal = propose(ray, view.frame, active);
        if (!any(query.proposal.active)) return query.best;
        query.filter = make_filter_ray(ray);
        embree::init_context(query.head, true);
        const Ray<F>& p = query.proposal.ray;
        alignas(64) typename embree::Packet<Real::size>::RayHit rayhit;
        const auto set = [](auto* field, const auto& value) { std::memcpy(field, &value, sizeof(value)); };
        const F zero(0.0F);
        // lanes that take no part still hold numbers: Debian's Embree asserts that every ray is valid
        const Vec3<F> origin = select(query.proposal.active, p.origin, Vec3<F>{zero, zero, zero});
        const Vec3<F> direction = select(query.proposal.active, p.direction, Vec3<F>{zero, zero, F(1.0F)});
        set(rayhit.ray.org_x, origin.x);
        set(rayhit.ray.org_y, origin.y);
        set(rayhit.ray.org_z, origin.z);
        set(rayhit.ray.dir_x, direction.x);
        set(rayhit.ray.dir_y, direction.y);
        set(rayhit.ray.dir_z, direction.z);
        set(rayhit.ray.tnear, zero);
        set(rayhit.ray.tfar, F(3e38F));
        set(rayhit.ray.time, zero);
        const Lanes<std::uint32_t, Isa> ones(0xFFFFFFFFU);
        set(rayhit.ray.mask, ones);
        set(rayhit.ray.id, zero);
        set(rayhit.ray.flags, zero);
        set(rayhit.hit.geomID, ones);
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.v;
        embree::intersect(reinterpret_cast<const int*>(&valid), view.embree, query.head, rayhit);
        return query.best;
    }
};

}  // namespace tandem

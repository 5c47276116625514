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

template <class Isa>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
    using Real = Lanes<float, Isa>;
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<float>*>(args->context);
        const double before = query.best.t;
        offer_candidate<float>(view.scene, args->primID, true, query);
        auto& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
        if (query.best.t < before) ray.tfar = query.proposal.limit(query.best.t);
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Real>*>(args->context);
    const LaneMask<Isa> active(*reinterpret_cast<const typename LaneMask<Isa>::Vector*>(args->valid));
    const Double<Real> before = query.best.t;
    offer_candidate<Real>(view.scene, args->primID, active, query);
    const LaneMask<Isa> nearer = query.best.t < before;
    if (any(nearer)) {
        auto& ray = reinterpret_cast<typename embree::Packet<Real::size>::RayHit*>(args->rayhit)->ray;
        auto* tfar = reinterpret_cast<Real*>(ray.tfar);
        *tfar = select(nearer, query.proposal.limit(query.best.t), *tfar);
    }
}

/// As intersect_callback() for any hit before best.t. Embree takes a tfar of -infinity for "occluded".
template <class Isa>
void occluded_callback(const RTCOccludedFunctionNArguments* args) {
    using Real = Lanes<float, Isa>;
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    constexpr float found = -__builtin_huge_valf();
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<float>*>(args->context);
        const double t_max = query.best.t;
        intersect_primitive<float>(view.scene, args->primID, query.filter, *query.shadow_source, true, query.best);
        if (query.best.t < t_max) reinterpret_cast<RTCRay*>(args->ray)->tfar = found;
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Real>*>(args->context);
    const LaneMask<Isa> active(*reinterpret_cast<const typename LaneMask<Isa>::Vector*>(args->valid));
    const Double<Real> before = query.best.t;
    intersect_primitive<Real>(view.scene, args->primID, query.filter, *query.shadow_source, active, query.best);
    const LaneMask<Isa> nearer = query.best.t < before;
    if (any(nearer)) {
        auto* tfar = reinterpret_cast<Real*>(reinterpret_cast<typename embree::Packet<Real::size>::Ray*>(args->ray)->tfar);
        *tfar = select(nearer, Real(found), *tfar);
    }
}

struct EmbreeTracer {
    const CpuSceneView& view;

    /// As LoopTracer::closest().
    template <class From>
    [[nodiscard]] TANDEM_HD Closest<float> closest(const Ray<float>& ray, const From& source, bool active) const {
        QueryContext<float> query;
        query.best = no_hit<float>();
        set_source(query, source);
        if (!start(query, ray, active, false)) return query.best;
        RTCRayHit rayhit;
        rayhit.ray = single_ray(query, 3e38F);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect1(view.embree, query.head, rayhit);
        return query.best;
    }

    template <class Isa, class From>
    [[nodiscard]] TANDEM_HD Closest<Lanes<float, Isa>> closest(const Ray<Lanes<float, Isa>>& ray, const From& source,
                                                               const LaneMask<Isa>& active) const {
        using Real = Lanes<float, Isa>;
        QueryContext<Real> query;
        query.best = no_hit<Real>();
        set_source(query, source);
        if (!start(query, ray, active, true)) return query.best;
        alignas(64) typename embree::Packet<Real::size>::RayHit rayhit;
        set_packet(rayhit.ray, query, Real(3e38F));
        const Lanes<std::uint32_t, Isa> none(RTC_INVALID_GEOMETRY_ID);
        std::memcpy(rayhit.hit.geomID, &none, sizeof(none));
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.v;
        embree::intersect(reinterpret_cast<const int*>(&valid), view.embree, query.head, rayhit);
        return query.best;
    }

    /// As LoopTracer::occluded().
    [[nodiscard]] TANDEM_HD bool occluded(const Ray<float>& ray, double t_max, const ShadowSource<float>& source,
                                          bool active) const {
        QueryContext<float> query;
        query.best = before<float>(t_max);
        query.shadow_source = &source;
        if (!start(query, ray, active, false)) return false;
        const float limit = query.proposal.limit(t_max);
        if (!(limit >= 0)) return false;
        RTCRay embree_ray = single_ray(query, limit);
        embree::occluded1(view.embree, query.head, embree_ray);
        return query.best.t < t_max;
    }

    template <class Isa>
    [[nodiscard]] TANDEM_HD LaneMask<Isa> occluded(const Ray<Lanes<float, Isa>>& ray, const Lanes<double, Isa>& t_max,
                                                   const ShadowSource<Lanes<float, Isa>>& source,
                                                   const LaneMask<Isa>& active) const {
        using Real = Lanes<float, Isa>;
        QueryContext<Real> query;
        query.best = before<Real>(t_max);
        query.shadow_source = &source;
        if (!start(query, ray, active, true)) return LaneMask<Isa>(false);
        const Real limit = query.proposal.limit(t_max);
        query.proposal.active = query.proposal.active && limit >= Real(0.0F);
        if (!any(query.proposal.active)) return LaneMask<Isa>(false);
        alignas(64) typename embree::Packet<Real::size>::Ray embree_ray;
        set_packet(embree_ray, query, select(query.proposal.active, limit, Real(0.0F)));
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

    TANDEM_HD static RTCRay single_ray(const QueryContext<float>& query, float tfar) {
        const Ray<float>& p = query.proposal.ray;
        return {p.origin.x,    p.origin.y, p.origin.z, 0, p.direction.x, p.direction.y,
                p.direction.z, 0,          tfar,       0xFFFFFFFF,       0, 0};
    }

    template <class PacketRay, class Real>
    TANDEM_HD static void set_packet(PacketRay& ray, const QueryContext<Real>& query, const Real& tfar) {
        const auto set = [](auto* field, const auto& value) { std::memcpy(field, &value, sizeof(value)); };
        const Ray<Real>& p = query.proposal.ray;
        const Real zero(0.0F);
        // lanes that take no part still hold numbers: Debian's Embree asserts that every ray is valid
        const Vec3<Real> origin = select(query.proposal.active, p.origin, Vec3<Real>{zero, zero, zero});
        const Vec3<Real> direction = select(query.proposal.active, p.direction, Vec3<Real>{zero, zero, Real(1.0F)});
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

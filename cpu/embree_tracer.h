/// Traces through Embree: Embree proposes primitives, and the shared intersectors decide. In the tier fast Embree
/// itself decides on faces.
#pragma once

#include <cstring>

#include "cpu/kernels.h"
#include "cpu/query_source.h"
#include "cpu/triangle_query.h"
#include "tandem/kernel/masked_hits.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/math/lanes.h"

namespace tandem {

template <class Real>
using CpuMaskedHits = MaskedHits<PrimitiveKinds::all, Real>;

/// The data of a query. The QueryContext must come first: Embree passes its address to the callback.
template <class Real>
struct QueryContext {
    embree::QueryContext head;
    FilterRay<Real> filter;  ///< the true ray
    Proposal<Real> proposal;
    Closest<Real> best;
    const QuerySource<Real>* source;
    CpuMaskedHits<Real>* masked = nullptr;  ///< of a search for what blocks a shadow ray
    TriangleQuery<Real> triangles;

    /// Whether `masked` decides about primitive `id`.
    [[nodiscard]] TANDEM_HD_INLINE bool asks(const SceneView& scene, std::uint32_t id, const Mask<Real>& active) const {
        return masked != nullptr &&
               may_let_pass<PrimitiveKinds::all>(scene, id, any(active && source->light == UInt<Real>(id)));
    }
};

/// `One` and `Packet`: the Reals of the tier, for one ray and for many.
template <class One, class Packet>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    const std::uint32_t id = primitive_of_item(view, args->primID);
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<One>*>(args->context);
        const Double<One> before = query.best.t;
        intersect_primitive<One>(view.scene, id, query.filter, *query.source, true, query.best);
        auto& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
        // not beyond a face that Embree found
        if (query.best.t < before) ray.tfar = lesser(to_plain(query.proposal.limit(query.best.t)), ray.tfar);
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Packet>*>(args->context);
    Mask<Packet> active(*reinterpret_cast<const typename Mask<Packet>::Vector*>(args->valid));
    auto& ray = reinterpret_cast<typename embree::Packet<Packet::size>::RayHit*>(args->rayhit)->ray;
    auto& tfar = *reinterpret_cast<Float<Packet>*>(ray.tfar);
    if (query.triangles.defers(view, id)) {
        active = query.triangles.template test<Search::nearest>(view, id, *query.source, active, 0.0F, tfar);
        if (!any(active)) [[likely]]
            return;
    }
    const Double<Packet> before = query.best.t;
    intersect_primitive<Packet>(view.scene, id, query.filter, *query.source, active, query.best);
    const Mask<Packet> nearer = query.best.t < before;
    if (any(nearer)) tfar = select(nearer, lesser(query.proposal.limit(query.best.t), tfar), tfar);
}

/// As intersect_callback(), for any hit before best.t. A tfar of -infinity means "occluded" to Embree and its caller.
template <class One, class Packet>
void occluded_callback(const RTCOccludedFunctionNArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    const std::uint32_t id = primitive_of_item(view, args->primID);
    constexpr float found = -__builtin_huge_valf();
    if (args->N == 1) {
        if (args->valid[0] == 0) return;
        auto& query = *reinterpret_cast<QueryContext<One>*>(args->context);
        const Double<One> before = query.best.t;
        intersect_primitive<One>(view.scene, id, query.filter, *query.source, true, query.best);
        if (query.best.t < before) reinterpret_cast<RTCRay*>(args->ray)->tfar = found;
        return;
    }
    auto& query = *reinterpret_cast<QueryContext<Packet>*>(args->context);
    Mask<Packet> active(*reinterpret_cast<const typename Mask<Packet>::Vector*>(args->valid));
    auto& ray = *reinterpret_cast<typename embree::Packet<Packet::size>::Ray*>(args->ray);
    auto& tfar = *reinterpret_cast<Float<Packet>*>(ray.tfar);
    if (query.asks(view.scene, id, active)) [[unlikely]] {
        visit_primitive(view.scene, id, [&]<class Primitive>(const Primitive& primitive) {
            if constexpr (has_filter<Packet, Primitive>) active = active && may_touch(query.filter, primitive);
        });
        if (any(active)) tfar = select(query.masked->block(id, active), Float<Packet>(found), tfar);
        return;
    }
    if (query.triangles.defers(view, id)) {
        active = query.triangles.template test<Search::any>(view, id, *query.source, active, found, tfar);
        if (!any(active)) [[likely]]
            return;
    }
    const Double<Packet> before = query.best.t;
    intersect_primitive<Packet>(view.scene, id, query.filter, *query.source, active, query.best);
    const Mask<Packet> nearer = query.best.t < before;
    if (any(nearer)) tfar = select(nearer, Float<Packet>(found), tfar);
}

namespace embree_detail {

/// The primitive that is number `index` of one of Embree's geometries.
template <class Word>
TANDEM_HD_INLINE Word primitive_of(const CpuSceneView& view, const Word& geometry, const Word& index) {
    return index + select(geometry == Word(embree_triangles), Word(view.first_id[embree_triangles]),
                          Word(view.first_id[embree_quads]));
}

/// The lanes of `valid` in which primitive `id` is a culled face that the ray hits from behind at `t`.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_culled(const SceneView& scene, const Ray<Real>& ray, const Double<Real>& t,
                                      const UInt<Real>& id, const Mask<Real>& valid) {
    Mask<Real> culled(false);
    if ((scene.cutout_kinds & PrimitiveKinds::faces) == 0) return culled;
    for_each_unique_lane(id, valid, [&](std::uint32_t number, const Mask<Real>& here) {
        visit_primitive<PrimitiveKinds::faces>(scene, number, [&](const auto& face) {
            if (face.attributes.sides != FaceSides::culled) return;
            culled =
                culled ||
                (here && surface_point(face, record_hit(face, ray, t, Mask<Real>(false), here), ray, t).from_inside);
        });
    });
    return culled;
}

/// Which of Embree's hits on its own faces to ignore. `s`: their parameter, `id`: their primitive.
template <Search search, class Real>
TANDEM_HD_INLINE Mask<Real> is_excluded(const SceneView& scene, const QueryContext<Real>& query, const Float<Real>& s,
                                        const UInt<Real>& id, const Mask<Real>& valid) {
    const QuerySource<Real>& source = *query.source;
    const Double<Real> t = query.proposal.parameter(s);
    Mask<Real> excluded = source.primitive == id;
    if constexpr (search == Search::nearest) {
        excluded = excluded || !is_beyond<Real>(source.last_masked, t, id);
    } else {
        excluded = excluded || source.light == id || !(t < query.best.t);
    }
    return source.culls ? excluded || is_culled<Real>(scene, query.filter.ray, t, id, valid) : excluded;
}

/// The query of one ray.
template <class Real>
TANDEM_HD_INLINE RTCRay single_ray(const Proposal<Real>& proposal, float tnear, float tfar) {
    const Ray<float> p = {to_plain(proposal.ray.origin), to_plain(proposal.ray.direction)};
    return {p.origin.x, p.origin.y, p.origin.z, tnear, p.direction.x, p.direction.y, p.direction.z, 0,
            tfar,       0xFFFFFFFF, 0,          0};
}

template <class T>
TANDEM_HD_INLINE T load(const void* field) {
    T result;
    std::memcpy(&result, field, sizeof(result));
    return result;
}

}  // namespace embree_detail

/// Embree's filter for hits on its own faces: rejects the face that a ray leaves, the backs of culled faces, the light
/// at the end of a shadow ray, and everything beyond it.
template <Search search, class One, class Packet>
void filter_callback(const RTCFilterFunctionNArguments* args) {
    using embree_detail::is_excluded;
    using embree_detail::load;
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    if (args->N == 1) {
        const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
        const auto& query = *reinterpret_cast<const QueryContext<One>*>(args->context);
        const One s(reinterpret_cast<const RTCRay*>(args->ray)->tfar);
        const std::uint32_t id = embree_detail::primitive_of<std::uint32_t>(view, hit.geomID, hit.primID);
        if (is_excluded<search, One>(view.scene, query, s, id, true)) args->valid[0] = 0;
        return;
    }
    using Lanes = embree::Packet<Packet::size>;
    using Word = UInt<Packet>;
    const auto& hit = *reinterpret_cast<const typename Lanes::Hit*>(args->hit);
    const auto& query = *reinterpret_cast<const QueryContext<Packet>*>(args->context);
    const auto s = load<Float<Packet>>(reinterpret_cast<const typename Lanes::Ray*>(args->ray)->tfar);
    const Word id = embree_detail::primitive_of<Word>(view, load<Word>(hit.geomID), load<Word>(hit.primID));
    const Mask<Packet> valid(load<typename Mask<Packet>::Vector>(args->valid));
    Mask<Packet> counts = valid && !is_excluded<search, Packet>(view.scene, query, s, id, valid);
    if constexpr (search == Search::any) {
        if (query.masked != nullptr) {
            for_each_unique_lane(id, valid, [&](std::uint32_t number, const Mask<Packet>& here) {
                if (!query.asks(view.scene, number, here)) return;
                counts = (counts && !here) || query.masked->block(number, here);
            });
        }
    }
    const auto kept = counts.vector();
    std::memcpy(args->valid, &kept, sizeof(kept));
}

namespace embree_detail {

/// Traces rays through one layer of a scene. `best`: the nearest hit in other layers, and then in this one too.
struct LayerTracer {
    const CpuSceneView& view;

    template <class Real>
    TANDEM_HD_INLINE void closest(const Ray<Real>& ray, const QuerySource<Real>& source, bool active,
                                  Closest<Real>& best) const {
        QueryContext<Real> query;
        query.best = best;
        query.source = &source;
        if (!start(query, ray, active, false)) return;
        RTCRayHit rayhit;
        rayhit.ray = embree_detail::single_ray(query.proposal, to_plain(query.proposal.start_for(source)),
                                               to_plain(query.proposal.limit(best.t)));
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect1(view.embree, query.head, rayhit);
        if constexpr (is_fast<Real>) {
            const std::uint32_t geometry = rayhit.hit.geomID;
            if (geometry != RTC_INVALID_GEOMETRY_ID) {
                const Real t = query.proposal.parameter(rayhit.ray.tfar);
                const auto id = embree_detail::primitive_of<std::uint32_t>(view, geometry, rayhit.hit.primID);
                keep_nearest<Real>(true, t, id, query.best);
            }
        }
        best = query.best;
    }

    template <class T, class Isa>
    TANDEM_HD_INLINE void closest(const Ray<Lanes<T, Isa>>& ray, const QuerySource<Lanes<T, Isa>>& source,
                                  const LaneMask<Isa>& active, Closest<Lanes<T, Isa>>& best) const {
        using Real = Lanes<T, Isa>;
        QueryContext<Real> query;
        query.best = best;
        query.source = &source;
        if (!start(query, ray, active, true)) return;
        alignas(64) typename embree::Packet<Real::size>::RayHit rayhit;
        set_packet(rayhit.ray, query, query.proposal.start_for(source), query.proposal.limit(best.t));
        query.triangles.template start<Search::nearest>(view, query.proposal, source, best.t);
        const UInt<Real> none(RTC_INVALID_GEOMETRY_ID);
        std::memcpy(rayhit.hit.geomID, &none, sizeof(none));
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.vector();
        embree::intersect(reinterpret_cast<const int*>(&valid), view.embree, query.head, rayhit);
        query.triangles.decide(view, ray, embree_detail::load<Float<Real>>(rayhit.ray.tfar), query.proposal.active,
                               query.best);
        if constexpr (is_fast<Real>) {
            using embree_detail::load;
            const auto geometry = load<UInt<Real>>(rayhit.hit.geomID);
            const auto id =
                embree_detail::primitive_of<UInt<Real>>(view, geometry, load<UInt<Real>>(rayhit.hit.primID));
            keep_nearest<Real>(geometry != none, query.proposal.parameter(load<Real>(rayhit.ray.tfar)), id, query.best);
        }
        best = query.best;
    }

    template <class Real>
    [[nodiscard]] TANDEM_HD_INLINE bool occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                                 const QuerySource<Real>& source, bool active) const {
        QueryContext<Real> query;
        query.best = closest_starting_at<Real>(t_max);
        query.source = &source;
        if (!start(query, ray, active, false)) return false;
        const float limit = to_plain(query.proposal.limit(t_max));
        if (!(limit >= 0)) return false;
        RTCRay embree_ray = embree_detail::single_ray(query.proposal, 0.0F, limit);
        embree::occluded1(view.embree, query.head, embree_ray);
        return embree_ray.tfar < 0;
    }

    template <class T, class Isa>
    [[nodiscard]] TANDEM_HD_INLINE LaneMask<Isa> occluded(const Ray<Lanes<T, Isa>>& ray,
                                                          const Double<Lanes<T, Isa>>& t_max,
                                                          const QuerySource<Lanes<T, Isa>>& source,
                                                          const LaneMask<Isa>& active,
                                                          CpuMaskedHits<Lanes<T, Isa>>* masked = nullptr) const {
        using Real = Lanes<T, Isa>;
        using F = Float<Real>;
        QueryContext<Real> query;
        query.best = closest_starting_at<Real>(t_max);
        query.source = &source;
        query.masked = masked;
        if (!start(query, ray, active, true)) return LaneMask<Isa>(false);
        const F limit = query.proposal.limit(t_max);
        query.proposal.active = query.proposal.active && limit >= F(0.0F);
        if (!any(query.proposal.active)) return LaneMask<Isa>(false);
        alignas(64) typename embree::Packet<Real::size>::Ray embree_ray;
        set_packet(embree_ray, query, F(0.0F), select(query.proposal.active, limit, F(0.0F)));
        query.triangles.template start<Search::any>(view, query.proposal, source, t_max);
        alignas(64) typename LaneMask<Isa>::Vector valid = query.proposal.active.vector();
        embree::occluded(reinterpret_cast<const int*>(&valid), view.embree, query.head, embree_ray);
        const Mask<Real> found = query.proposal.active && embree_detail::load<F>(embree_ray.tfar) < F(0.0F);
        query.triangles.decide(view, ray, limit, query.proposal.active && !found, query.best);
        return found || (query.proposal.active && query.best.t < t_max);
    }

  private:
    /// Fills the common part of all queries; false if no lane can hit anything.
    template <class Real>
    TANDEM_HD_INLINE bool start(QueryContext<Real>& query, const Ray<Real>& ray, const Mask<Real>& active,
                                bool coherent) const {
        query.proposal = propose(ray, view.frame, active);
        if (!any(query.proposal.active)) return false;
        query.filter = make_filter_ray(ray);
        embree::init_context(query.head, coherent);
        return true;
    }

    template <class PacketRay, class Real>
    TANDEM_HD_INLINE static void set_packet(PacketRay& ray, const QueryContext<Real>& query, const Float<Real>& tnear,
                                            const Float<Real>& tfar) {
        using F = Float<Real>;
        const auto set = [](auto* field, const auto& value) { std::memcpy(field, &value, sizeof(value)); };
        const Ray<F>& p = query.proposal.ray;
        const F zero(0.0F);
        // inactive lanes need valid rays too, because Debian's Embree asserts that
        const Vec3<F> origin = select(query.proposal.active, p.origin, Vec3<F>{zero, zero, zero});
        const Vec3<F> direction = select(query.proposal.active, p.direction, Vec3<F>{zero, zero, F(1.0F)});
        set(ray.org_x, origin.x);
        set(ray.org_y, origin.y);
        set(ray.org_z, origin.z);
        set(ray.dir_x, direction.x);
        set(ray.dir_y, direction.y);
        set(ray.dir_z, direction.z);
        set(ray.tnear, tnear);
        set(ray.tfar, tfar);
        set(ray.time, zero);
        set(ray.mask, UInt<Real>(0xFFFFFFFFU));
        set(ray.id, zero);
        set(ray.flags, zero);
    }
};

}  // namespace embree_detail

struct EmbreeTracer {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all;
    static constexpr bool has_hierarchy = true;

    const CpuSceneView& view;

    /// As LoopTracer::closest().
    template <class Real>
    [[nodiscard]] TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const QuerySource<Real>& source,
                                                         const Mask<Real>& active,
                                                         const Double<Real>& farthest = no_hit<Real>().t) const {
        Closest<Real> best = {farthest, UInt<Real>(no_primitive)};
        for (const CpuSceneView* layer = &view; layer != nullptr; layer = layer->smaller) {
            embree_detail::LayerTracer{*layer}.closest(ray, source, active, best);
        }
        return best;
    }

    /// As LoopTracer::occluded(). `masked`: CpuMaskedHits*, for packets only.
    template <class Real, class... Masked>
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                                       const QuerySource<Real>& source, const Mask<Real>& active,
                                                       Masked*... masked) const {
        Mask<Real> found(false);
        for (const CpuSceneView* layer = &view; layer != nullptr; layer = layer->smaller) {
            const embree_detail::LayerTracer tracer{*layer};
            found = found || tracer.occluded(ray, t_max, source, active && !found, masked...);
        }
        return found;
    }
};

}  // namespace tandem

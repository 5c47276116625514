/// The query of one ray to the hierarchy of groups, which decides hits after the traversal.
#pragma once

#include "cpu/group_filter.h"
#include "cpu/kernels.h"
#include "cpu/query_source.h"
#include "tandem/kernel/traversal/candidates.h"

namespace tandem {

/// In the exact tiers the filters of a group run on all of its primitives at once, the intervals of hits
/// (hit_interval.h) of the few that remain give the limit of the traversal, and hits that overlap the nearest one are
/// decided after the traversal. In the tier fast a decision costs no more than an interval, so it is made at once.
template <class Real, class Isa>
struct GroupQuery {
    using Lane = Lanes<float, GroupIsa<Isa>>;

    const Ray<Real>* ray;
    const QuerySource<Real>* source;
    Proposal<Real> proposal;
    Closest<Real> best;
    FilterRay<Lane> filter;  ///< the ray in every lane
    QueryRay interval_ray;
    float limit;   ///< the largest query parameter of interest
    float enough;  ///< a certain hit before it ends a search for any hit
    Candidates<4> candidates;

    /// Tests group `number`. True if a search for any hit has found one.
    template <Search search>
    TANDEM_HD_INLINE bool test(const CpuSceneView& view, std::uint32_t number) {
        bool found = false;
        visit_group(
            *view.groups, number, [&](const auto& group) __attribute__((always_inline)) {
                for (unsigned rest = filter_group(filter, group); rest != 0 && !found; rest &= rest - 1) {
                    found = keep<search>(view, group, {number, lowest_bit(rest)});
                }
            });
        return found;
    }

    /// After the traversal.
    TANDEM_HD_INLINE void decide_candidates(const CpuSceneView& view) {
        candidates.for_each(limit, [&](std::uint32_t member) { decide(view, Member::from(member)); });
    }

  private:
    /// A primitive by its place in the group: the numbers of the group are in the cache already, those of the scene are
    /// not.
    struct Member {
        std::uint32_t group;
        int place;

        TANDEM_HD_INLINE static Member from(std::uint32_t number) {
            return {number / group_size, static_cast<int>(number % group_size)};
        }
        [[nodiscard]] TANDEM_HD_INLINE std::uint32_t number() const {
            return group * group_size + static_cast<std::uint32_t>(place);
        }
    };

    // Calls visitor(primitive) with a primitive of a group.
    template <class Visitor>
    TANDEM_HD_INLINE static void visit_member(const CpuSceneView& view, const BodyGroup& group, int place,
                                              const Visitor& visitor) {
        constexpr std::uint32_t others = PrimitiveKinds::bodies & ~PrimitiveKinds::sphere;
        const SceneView& scene = view.scene;
        const std::uint32_t id = group.id[place];
        if (id >= scene.sphere_count) return visit_primitive<others>(scene, id - scene.sphere_count, visitor);
        visitor(Sphere{{group.x[place], group.y[place], group.z[place]}, group.radius[place]});
    }
    template <class Visitor>
    TANDEM_HD_INLINE static void visit_member(const CpuSceneView& view, const TriangleGroup& group, int place,
                                              const Visitor& visitor) {
        Triangle triangle = {corner(group, 0, place), corner(group, 1, place), corner(group, 2, place)};
        if ((view.scene.cutout_kinds & PrimitiveKinds::triangle) != 0) {
            const std::uint32_t index = group.id[place] - view.first_id[embree_triangles];
            triangle.attributes = view.scene.triangles[index].attributes;
        }
        visitor(triangle);
    }
    template <class Visitor>
    TANDEM_HD_INLINE static void visit_member(const CpuSceneView& view, const QuadGroup& group, int place,
                                              const Visitor& visitor) {
        Quad quad = {corner(group, 0, place), corner(group, 1, place), corner(group, 2, place),
                     corner(group, 3, place)};
        if ((view.scene.cutout_kinds & PrimitiveKinds::quad) != 0) {
            quad.attributes = view.scene.quads[group.id[place] - view.first_id[embree_quads]].attributes;
        }
        visitor(quad);
    }
    template <int corners>
    TANDEM_HD_INLINE static Vec3f corner(const FaceGroup<corners>& group, int number, int place) {
        return {group.x[number][place], group.y[number][place], group.z[number][place]};
    }

    TANDEM_HD_INLINE void decide(const CpuSceneView& view, Member member) {
        visit_group(*view.groups, member.group, [&](const auto& group) { decide(view, group, member.place); });
    }
    template <class Group>
    TANDEM_HD_INLINE void decide(const CpuSceneView& view, const Group& group, int place) {
        visit_member(view, group, place, [&](const auto& primitive) {
            test_primitive(primitive, group.id[place], *ray, *source, true, best);
        });
    }

    template <Search search, class Group>
    TANDEM_HD_INLINE bool keep(const CpuSceneView& view, const Group& group, Member member) {
        if constexpr (is_fast<Real>) {
            return decide_at_once<search>([&] { decide(view, group, member.place); });
        } else {
            HitInterval interval = certain_miss;
            visit_member(
                view, group,
                member.place, [&]<class Primitive>(const Primitive& primitive) __attribute__((always_inline)) {
                    interval =
                        query_interval<Real, Primitive>(*source, group.id[member.place], interval_ray, primitive);
                });
            if (!(interval.lo <= limit)) return false;
            if (search == Search::any && interval.hi < enough) return true;
            if constexpr (search == Search::nearest) limit = lesser(limit, interval.hi);
            candidates.add(interval.lo, member.number(), limit);
            if (candidates.overflow == 0) [[likely]]
                return false;
            return make_place<search>(*this, view, member);
        }
    }

    template <Search search, class Decide>
    TANDEM_HD_INLINE bool decide_at_once(const Decide& decide_one) {
        const Double<Real> before = best.t;
        decide_one();
        if (!(best.t < before)) return false;
        // not below 0, where intervals start
        limit = lesser(limit, greater(to_plain(proposal.limit(best.t)), 0.0F));
        return search == Search::any;
    }

    /// For the few rays with too many candidates: decides about all of them.
    template <Search search>
    TANDEM_HD_CALL bool make_place(GroupQuery& query, const CpuSceneView& view, Member member) {
        const Candidates<4> full = query.candidates;
        query.candidates = {};
        const auto decide_one = [&](Member one) {
            return query.template decide_at_once<search>([&] { query.decide(view, one); });
        };
        bool found = decide_one(member);
        for (const std::uint32_t other : full.id) found = decide_one(Member::from(other)) || found;
        return found;
    }
};

}  // namespace tandem

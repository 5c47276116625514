/// Traces rays through a scene with instanced meshes: two levels propose, and the faces as they are in render space
/// decide. The bound of the moved ray is in docs/instances.md.
#pragma once

#include "tandem/kernel/traversal/bvh_tracer.h"

namespace tandem {

/// A face of a mesh in the order of the entries, in object space.
struct alignas(16) EntryFace {
    Vec3f v0, v1, v2;
    std::uint32_t number;  ///< in its mesh
    FaceSides sides;
    std::uint32_t unused = 0;
};
static_assert(sizeof(EntryFace) == 48);

/// The hierarchies of instances and of their meshes, in one array of nodes. The root of the instances is the first, and
/// their entries come before those of the meshes.
struct InstancedBvhView {
    const BvhNode* nodes;
    const std::uint32_t* entry_instances;
    const EntryFace* entry_faces;  ///< by entry - instance_entries
    std::uint32_t instance_entries;
    StructureFrame frame;
    std::uint32_t bits_of_256 = 0x43800000U;  ///< as in BvhView
};

/// The padding of the boxes of a mesh, in its frame: docs/instances.md. `row_norm`: the largest 1-norm of a row of
/// object_from_render of its instances; `scene_reach`: that of the instances in render space; `mesh_reach`: of the
/// mesh's box from its centre.
TANDEM_HD_INLINE float instanced_margin(double row_norm, double scene_reach, double mesh_reach) {
    return round_up((64.0 * row_norm * scene_reach + 16.0 * mesh_reach) * widen(float_roundoff) + 1e-30);
}
/// Limits of row_norm, so that no component of a moved direction is lost.
inline constexpr double least_row_norm = 1e-9, most_row_norm = 1e9;

namespace instanced_detail {

/// The query ray in the frame of a mesh, relative to the centre of its box, with the same parameter.
TANDEM_HD_INLINE NodeRay move_to_object(const MeshInstance& instance, const QueryRay& query) {
    const Vec3f from_centre = query.origin - instance.centre;
    const auto move = [&](const Vec3f& v) {
        return Vec3f{loose_dot(instance.object_from_render[0], v), loose_dot(instance.object_from_render[1], v),
                     loose_dot(instance.object_from_render[2], v)};
    };
    return make_node_ray(move(from_centre), move(query.direction));
}

/// On a stack: the place where a ray leaves an instance.
inline constexpr std::int32_t leave = no_child - 1;

/// The stack of a walk through both levels, in local memory.
struct Stack {
    std::int32_t entries[2 * bvh_stack_size + 1];

    TANDEM_HD_INLINE void set(int i, std::int32_t child) { entries[i] = child; }
    [[nodiscard]] TANDEM_HD_INLINE std::int32_t get(int i) const { return entries[i]; }
};

/// Calls leaf(instance, face) for the faces that the ray may hit in [start, limit], until one returns true. `leaf` may
/// lower `limit`. Returns whether one did.
template <bool starts_late, class Leaf>
TANDEM_HD_INLINE bool walk(const InstancedBvhView& bvh, const MeshInstance* instances, const QueryRay& query,
                           const float& limit, const Leaf& leaf) {
    BvhView nodes{};
    nodes.nodes = bvh.nodes;
    nodes.bits_of_256 = bvh.bits_of_256;
    Stack stack;
    bvh_detail::Walk at = bvh_detail::Walk::from_root(stack);
    const MeshInstance* instance = nullptr;
    NodeRay ray = make_node_ray(query.origin, query.direction);
    while (!at.is_done()) {
        if (!at.is_at_entry() && at.at != leave) at.descend<starts_late>(stack, nodes, ray, query.start, limit);
        if (at.at == leave) {
            ray = make_node_ray(query.origin, query.direction);
            at.pop(stack);
        } else if (at.is_at_entry() && at.entry() < bvh.instance_entries) {
            instance = instances + bvh.entry_instances[at.entry()];
            ray = move_to_object(*instance, query);
            stack.set(at.depth++, at.top);
            at.top = leave;
            at.at = instance->root;
        } else if (at.is_at_entry()) {
            if (leaf(*instance, bvh.entry_faces[at.entry() - bvh.instance_entries])) return true;
            at.pop(stack);
        }
    }
    return false;
}

}  // namespace instanced_detail

/// Not for the tier fast, whose rays are traced by the kernels of strict.
struct InstancedStructure {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all | PrimitiveKinds::instanced;
    static constexpr bool has_hierarchy = true;

    InstancedView scene;
    DeferringBvhTracer others;  ///< the other primitives; without nodes if there are none
    InstancedBvhView bvh;

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        const Double<Real> t_max = best.t;
        if (others.bvh.nodes != nullptr) {
            others.template find<search>(ray, source, best);
            if (search == Search::any && best.t < t_max) return;
        }
        const Proposal<Real> proposal = propose(ray);
        if (!proposal.active) return;
        const QueryRay query = make_query_ray(proposal, bvh.frame, source);
        float limit = limit_of(proposal, best);
        const float enough = search == Search::any ? to_plain(proposal.start(t_max)) : 0.0F;
        Candidates<most_candidates> candidates;
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const bool blocked = instanced_detail::walk<may_start_late>(
            bvh, scene.instances, query, limit, [&](const MeshInstance& instance, const EntryFace& face) {
                const std::uint32_t id = instance.first_id + face.number;
                const HitInterval interval = interval_at<Real>(instance, face, source, query);
                if (!(interval.lo <= limit)) return false;
                if (search == Search::any && interval.hi < enough) return true;
                if constexpr (search == Search::nearest) limit = rough_lesser(limit, interval.hi);
                candidates.add(interval.lo, id, limit);
                return false;
            });
        if (blocked) {
            best = {0.0, some_primitive};
        } else if (candidates.overflow != 0) [[unlikely]] {
            best = decide_crowd<search>(*this, ray, source, best, limit);
        } else {
            candidates.for_each(limit, [&](std::uint32_t id) { decide(ray, source, id, best); });
        }
    }

  private:
    static constexpr int most_candidates = 4;

    template <class Real>
    TANDEM_HD_INLINE Proposal<Real> propose(const Ray<Real>& ray) const {
        if constexpr (std::is_same_v<Real, float>) {
            return propose_quickly(ray, bvh.frame);
        } else {
            return tandem::propose(ray, bvh.frame, true);
        }
    }

    /// Of the hits that may replace `best`. No interval starts before 0.
    template <class Real>
    TANDEM_HD_INLINE static float limit_of(const Proposal<Real>& proposal, const Closest<Real>& best) {
        return greater(to_plain(proposal.limit(best.t)), 0.0F);
    }

    template <class Real, class From>
    TANDEM_HD_INLINE static HitInterval interval_at(const MeshInstance& instance, const EntryFace& face,
                                                    const From& source, const QueryRay& query) {
        const Transform& place = instance.render_from_object;
        const std::uint32_t id = instance.first_id + face.number;
        const EntryTriangle placed = {
            edges_of(place_corner(place, face.v0), place_corner(place, face.v1), place_corner(place, face.v2)), id,
            face.sides};
        return hit_interval_from<Real, Triangle>(source, id, query, placed);
    }

    template <class Real, class From>
    TANDEM_HD_INLINE void decide(const Ray<Real>& ray, const From& source, std::uint32_t id,
                                 Closest<Real>& best) const {
        visit_primitive<PrimitiveKinds::instanced>(
            scene, id, [&](const auto& primitive) { test_primitive(primitive, id, ray, source, true, best); });
    }

    /// For the few rays with too many candidates, as BvhStructure::decide_crowd().
    template <Search search, class Real, class From>
    TANDEM_HD_CALL Closest<Real> decide_crowd(const InstancedStructure& self, Ray<Real> ray, From source,
                                              Closest<Real> best, float limit) {
        const Proposal<Real> proposal = self.propose(ray);
        const QueryRay query = make_query_ray(proposal, self.bvh.frame, source);
        const Double<Real> t_max = best.t;
        Candidates<2> certain;
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const auto keep_or_decide = [&](const MeshInstance& instance, const EntryFace& face) {
            const std::uint32_t id = instance.first_id + face.number;
            const HitInterval interval = interval_at<Real>(instance, face, source, query);
            if (!(interval.lo <= limit)) return false;
            if (search == Search::nearest && interval.hi < interval_detail::infinity) {
                limit = lesser(limit, interval.hi);
                certain.add(interval.lo, id, limit);
                if (certain.overflow == 0) return false;
                certain.overflow = 0;
            }
            const Double<Real> t_before = best.t;
            self.decide(ray, source, id, best);
            if (best.t < t_before) limit = lesser(limit, limit_of(proposal, best));
            return search == Search::any && best.t < t_max;
        };
        (void)instanced_detail::walk<may_start_late>(self.bvh, self.scene.instances, query, limit, keep_or_decide);
        certain.for_each(limit, [&](std::uint32_t id) { self.decide(ray, source, id, best); });
        return best;
    }
};

using InstancedTracer = RayTracer<InstancedStructure>;

}  // namespace tandem

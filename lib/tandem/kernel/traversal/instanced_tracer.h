/// Traces rays through a scene with instanced meshes: hierarchies of two levels propose faces, and the tests decide on
/// the faces in render space. The bounds of the moved ray are in docs/instances.md.
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

/// The data of an instance that a traversal needs: an entry of the upper hierarchy, 64 bytes.
struct alignas(16) EntryInstance {
    Vec3f object_from_render[3];  ///< rows, without the translation
    Vec3f centre;                 ///< of the mesh's box, in render space
    float radius;                 ///< instance_radius()
    std::int32_t root;            ///< the node of the mesh's hierarchy
    std::uint32_t number;         ///< of the MeshInstance
    std::uint32_t unused = 0;
};
static_assert(sizeof(EntryInstance) == 64);

/// The hierarchies of instances and of their meshes, in one array of nodes. The root of the instances is the first, and
/// their entries come before those of the meshes.
struct InstancedBvhView {
    const BvhNode* nodes;
    const EntryInstance* entry_instances;
    const EntryFace* entry_faces;  ///< by entry - instance_entries
    std::uint32_t instance_entries;
    StructureFrame frame;
    std::uint32_t bits_of_8 = 0x4800U;  ///< as in BvhView
};

/// Of a sphere around EntryInstance::centre that contains the instance with a distance to spare: docs/instances.md.
/// `half_diagonal`: of its box in render space; `scene_reach`: that of the instances.
TANDEM_HD_INLINE float instance_radius(double half_diagonal, double scene_reach) {
    return round_up(half_diagonal * (1 + 0x1p-20) + 64.0 * scene_reach * widen(float_roundoff) + 1e-30);
}
/// The padding of the boxes of a mesh, in its frame, for an instance: docs/instances.md. `row_norm`: the largest 1-norm
/// of a row of object_from_render; `scene_reach`: that of the instances in render space; `radius`: instance_radius();
/// `mesh_reach`: of the mesh's box from its centre.
TANDEM_HD_INLINE float instanced_margin(double row_norm, double scene_reach, double radius, double mesh_reach) {
    const double roundings = 6.0 * row_norm * scene_reach + 64.0 * row_norm * radius + 16.0 * mesh_reach;
    return round_up(roundings * widen(float_roundoff) + 1e-30);
}
/// Limits of row_norm, so that no component of a moved direction is lost.
inline constexpr double least_row_norm = 1e-9, most_row_norm = 1e9;

namespace instanced_detail {

/// The query ray without its rounding: a point at query parameter s is origin + s * direction, within 2^-49 of the
/// distances.
struct ExactQuery {
    Vec3d origin, direction;
};

template <class Real>
TANDEM_HD_INLINE ExactQuery exact_query(const Ray<Real>& ray, const StructureFrame& frame,
                                        const Proposal<Real>& proposal) {
    Vec3d direction = widen(ray.direction);
    if constexpr (std::is_same_v<Real, double>) {  // whose squares may be subnormal
        const double largest = max_norm(direction);
        direction = {direction.x / largest, direction.y / largest, direction.z / largest};
    }
    return {unrounded_origin(ray, frame, proposal), normalize(direction)};
}

/// A ray in the frame of a mesh, relative to the centre of its box. Its parameter is that of the query ray less `from`.
struct MovedRay {
    Vec3f origin, direction;
    float from;
};

/// Starts where the ray enters the sphere around the instance, so that float is as accurate as the mesh is small.
TANDEM_HD_INLINE MovedRay move_to_object(const EntryInstance& entry, const QueryRay& query, const ExactQuery& exact) {
    const float nearest = loose_dot(entry.centre - query.origin, query.direction);
    const float from = rough_greater(nearest - entry.radius, 0.0F);
    const Vec3f start = narrow((exact.origin + exact.direction * widen(from)) - widen(entry.centre));
    const auto move = [&](const Vec3f& v) {
        return Vec3f{loose_dot(entry.object_from_render[0], v), loose_dot(entry.object_from_render[1], v),
                     loose_dot(entry.object_from_render[2], v)};
    };
    return {move(start), move(query.direction), from};
}

TANDEM_HD_INLINE EntryInstance load_entry_instance(const InstancedBvhView& bvh, std::uint32_t i) {
    using bvh_detail::Load16, bvh_detail::load_16;
    const auto* address = reinterpret_cast<const char*>(bvh.entry_instances + i);
    const Load16 p = load_16(address), q = load_16(address + 16), r = load_16(address + 32), s = load_16(address + 48);
    return {{{float_of(p.a), float_of(p.b), float_of(p.c)},
             {float_of(p.d), float_of(q.a), float_of(q.b)},
             {float_of(q.c), float_of(q.d), float_of(r.a)}},
            {float_of(r.b), float_of(r.c), float_of(r.d)},
            float_of(s.a),
            static_cast<std::int32_t>(s.b),
            s.c};
}

TANDEM_HD_INLINE EntryFace load_entry_face(const InstancedBvhView& bvh, std::uint32_t i) {
    using bvh_detail::Load16, bvh_detail::load_16;
    const auto* address = reinterpret_cast<const char*>(bvh.entry_faces + i);
    const Load16 p = load_16(address), q = load_16(address + 16), r = load_16(address + 32);
    return {{float_of(p.a), float_of(p.b), float_of(p.c)},
            {float_of(p.d), float_of(q.a), float_of(q.b)},
            {float_of(q.c), float_of(q.d), float_of(r.a)},
            r.b,
            static_cast<FaceSides>(r.c)};
}

/// A mark on a stack: there the ray leaves an instance.
inline constexpr std::int32_t leave = no_child - 1;
/// The number that means no instance.
inline constexpr std::uint32_t outside = 0xFFFFFFFFU;

/// The stack of a traversal of both levels, in local memory.
struct Stack {
    std::int32_t entries[2 * bvh_stack_size + 1];

    TANDEM_HD_INLINE void set(int i, std::int32_t child) { entries[i] = child; }
    // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.UndefReturn): set before
    [[nodiscard]] TANDEM_HD_INLINE std::int32_t get(int i) const { return entries[i]; }
};

/// A traversal of both levels that can be interrupted.
struct Walk {
    bvh_detail::Walk place;
    std::uint32_t instance = outside;  ///< whose mesh it is in

    TANDEM_HD_INLINE explicit Walk(Stack& stack) : place(bvh_detail::Walk::from_root(stack)) {}
    [[nodiscard]] TANDEM_HD_INLINE bool is_done() const { return place.is_done(); }

    /// Calls leaf(instance, face) for the faces that the ray may hit in [start, limit] until one returns true, or the
    /// traversal is done. `leaf` may lower `limit`.
    template <bool starts_late, class Leaf>
    TANDEM_HD_INLINE void go_on(Stack& stack, const InstancedBvhView& bvh, const MeshInstance* instances,
                                const Parked<QueryRay>& query, const Parked<ExactQuery>& exact, const float& limit,
                                const Leaf& leaf) {
        BvhView nodes{};
        nodes.nodes = bvh.nodes;
        nodes.bits_of_8 = bvh.bits_of_8;
        const float start = starts_late ? query.get().start : 0.0F;
        NodeRay ray{};
        float from = 0;  // the query parameter where `ray` starts
        std::uint32_t number = 0;
        // takes the ray of the current level; returns the root of the hierarchy there
        const auto take_ray = [&] {
            const QueryRay same_query = query.get();
            if (instance == outside) {
                ray = make_node_ray(same_query.origin, same_query.direction);
                from = 0;
                return std::int32_t{0};
            }
            const EntryInstance entry = load_entry_instance(bvh, instance);
            const MovedRay moved = move_to_object(entry, same_query, exact.get());
            ray = make_node_ray(moved.origin, moved.direction);
            from = moved.from;
            number = entry.number;
            return entry.root;
        };
        (void)take_ray();
        while (!place.is_done()) {
            if (!place.is_at_entry() && place.at != leave) {
                // from the query parameter to that of the moved ray, with the rounding of the subtraction
                const float last = loose_multiply_add(4.0F * float_roundoff, limit, limit - from);
                const float first =
                    starts_late ? loose_multiply_add(-4.0F * float_roundoff, start, start - from) : 0.0F;
                place.descend<starts_late>(stack, nodes, ray, first, last);
            }
            if (place.at == leave) {
                instance = outside;
                (void)take_ray();
                place.pop(stack);
            } else if (place.is_at_entry() && place.entry() < bvh.instance_entries) {
                instance = place.entry();
                stack.set(place.depth++, place.top);
                place.top = leave;
                place.at = take_ray();
            } else if (place.is_at_entry()) {
                const bool stops = leaf(instances[number], load_entry_face(bvh, place.entry() - bvh.instance_entries));
                place.pop(stack);
                if (stops) return;
            }
        }
    }
};

}  // namespace instanced_detail

/// Not for the tier fast, whose rays are traced by the kernels of strict. `may_lack_instances`: for scenes without
/// instances too, whose `bvh` has no nodes. Tests: PlaneBits.
template <bool may_lack_instances = false>
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
        if (!may_lack_instances || bvh.nodes != nullptr) find_in_instances<search>(ray, source, best);
    }

    /// Whether the tracer has find_blocker().
    TANDEM_HD_INLINE static constexpr bool finds_blockers() { return !may_lack_instances; }

    /// As BvhStructure::find_blocker().
    template <class Real, class Hits>
    TANDEM_HD_INLINE bool find_blocker(const Ray<Real>& ray, const Double<Real>& t_max,
                                       const MaskedShadowSource<Real>& source, bool active, Hits& hits) const {
        if (!active) return false;
        if (others.bvh.nodes != nullptr && others.find_blocker(ray, t_max, source, true, hits)) return true;
        Closest<Real> best = closest_starting_at<Real>(t_max);
        // no instance is the light
        const auto blocks = [&](std::uint32_t id) { return !may_let_pass<kinds>(scene, id, false); };
        const auto decide = [&](const Ray<Real>&, std::uint32_t id) {
            if (!(best.t < t_max) && hits.block(id, true)) best = {0.0, some_primitive};
        };
        visit_instances<Search::any>(ray, source, best, blocks, decide);
        return best.t < t_max;
    }

  private:
    static constexpr int most_candidates = 4;

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find_in_instances(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        const auto blocks = [](std::uint32_t) { return true; };
        const auto decide = [&](const Ray<Real>& same_ray, std::uint32_t id) {
            visit_primitive<PrimitiveKinds::instanced>(
                scene, id, [&](const auto& primitive) { test_primitive(primitive, id, same_ray, source, true, best); });
        };
        visit_instances<search>(ray, source, best, blocks, decide);
    }

    /// Calls decide(ray, id), which may change `best`, for the faces that the ray may hit before best.t. A search for
    /// any hit ends at a certain one if blocks(id).
    template <Search search, class Real, class From, class Blocks, class Decide>
    TANDEM_HD_INLINE void visit_instances(const Ray<Real>& ray, const From& source, Closest<Real>& best,
                                          const Blocks& blocks, const Decide& decide) const {
        const Double<Real> t_max = best.t;
        const Proposal<Real> proposal = propose(ray);
        if (!proposal.active) return;
        const Parked<QueryRay> query(make_query_ray(proposal, bvh.frame, source));
        const Parked<instanced_detail::ExactQuery> exact(instanced_detail::exact_query(ray, bvh.frame, proposal));
        const Parked<Ray<Real>> parked(ray);
        float limit = limit_of(proposal, best);
        const float enough = search == Search::any ? to_plain(proposal.start(t_max)) : 0.0F;
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        instanced_detail::Stack stack;
        instanced_detail::Walk walk(stack);
        bool blocked = false;
        // the few rays that fill all places decide about their candidates, and go on
        do {
            Candidates<most_candidates> candidates;
            const auto keep = [&](const MeshInstance& instance, const EntryFace& face) {
                const std::uint32_t id = instance.first_id + face.number;
                const HitInterval interval = interval_at<Real>(instance, face, source, query.get());
                if (!(interval.lo <= limit)) return false;
                blocked = search == Search::any && interval.hi < enough && blocks(id);
                if constexpr (search == Search::nearest) limit = rough_lesser(limit, interval.hi);
                candidates.add(interval.lo, id, limit);
                return blocked || candidates.is_full(limit);
            };
            walk.go_on<may_start_late>(stack, bvh, scene.instances, query, exact, limit, keep);
            if (blocked) {
                best = {0.0, some_primitive};
                return;
            }
            const Ray<Real> same_ray = parked.get();
            candidates.for_each(limit, [&](std::uint32_t id) { decide(same_ray, id); });
            if (search == Search::any && best.t < t_max) return;
            if (!walk.is_done()) limit = rough_lesser(limit, limit_of(propose(same_ray), best));
        } while (!walk.is_done());
    }

    template <class Real>
    TANDEM_HD_INLINE Proposal<Real> propose(const Ray<Real>& ray) const {
        if constexpr (std::is_same_v<Real, float>) {
            return propose_quickly(ray, bvh.frame);
        } else {
            return tandem::propose(ray, bvh.frame, true);
        }
    }

    /// The limit for hits that may replace `best`. No interval starts before 0.
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
};

using InstancedTracer = RayTracer<InstancedStructure<>>;
/// For every scene with a hierarchy.
using HierarchyTracer = RayTracer<InstancedStructure<true>>;

}  // namespace tandem

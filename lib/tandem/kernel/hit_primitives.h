/// What the lanes of a packet hit, in as few parts as possible: one primitive after the other, except for triangles of
/// one material, which are one part. Tested by tests/kernel/hit_primitives_test.cpp.
#pragma once

#include "tandem/kernel/shapes/triangle_lanes.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// A primitive that some lanes hit.
struct OnePrimitive {
    std::uint32_t id;
};

/// Triangles of one material that some lanes hit. Other lanes have any triangle.
template <class Real>
struct ManyTriangles {
    UInt<Real> id;
    std::uint32_t material;
    TriangleLanes<Real> triangles;
};

template <class Real>
TANDEM_HD_INLINE UInt<Real> ids_of(OnePrimitive hit) {
    return UInt<Real>(hit.id);
}
template <class Real>
TANDEM_HD_INLINE const UInt<Real>& ids_of(const ManyTriangles<Real>& hit) {
    return hit.id;
}

template <std::uint32_t kinds>
TANDEM_HD_INLINE std::uint32_t material_of(const SceneView& scene, OnePrimitive hit) {
    return material_of<kinds>(scene, hit.id);
}
template <std::uint32_t kinds, class Real>
TANDEM_HD_INLINE std::uint32_t material_of(const SceneView&, const ManyTriangles<Real>& hit) {
    return hit.material;
}

/// Calls visitor(primitive) with the primitive, or with all triangles, as TriangleLanes.
template <std::uint32_t kinds, class Visitor>
TANDEM_HD_INLINE void visit_primitive(const SceneView& scene, OnePrimitive hit, const Visitor& visitor) {
    visit_primitive<kinds>(scene, hit.id, visitor);
}
template <std::uint32_t kinds, class Real, class Visitor>
TANDEM_HD_INLINE void visit_primitive(const SceneView&, const ManyTriangles<Real>& hit, const Visitor& visitor) {
    visitor(hit.triangles);
}

/// As hits_far_side() of a primitive. Triangles have no far side.
template <std::uint32_t kinds, class Real, class From>
TANDEM_HD_INLINE Mask<Real> hits_far_side(const SceneView& scene, OnePrimitive hit, const Ray<Real>& ray,
                                          const From& source, const Double<Real>& t, const Mask<Real>& here) {
    return hits_far_side<kinds>(scene, hit.id, ray, source, t, here);
}
template <std::uint32_t kinds, class Real, class From>
TANDEM_HD_INLINE Mask<Real> hits_far_side(const SceneView&, const ManyTriangles<Real>&, const Ray<Real>&, const From&,
                                          const Double<Real>&, const Mask<Real>&) {
    return Mask<Real>(false);
}

namespace hit_primitives_detail {

/// The number of primitives before the triangles.
TANDEM_HD_INLINE std::uint32_t first_triangle(const SceneView& scene) {
    std::uint32_t count = 0;
#define TANDEM_PRIMITIVE(Type, name, names) \
    if (PrimitiveKinds::name < PrimitiveKinds::triangle) count += scene.name##_count;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return count;
}

/// The triangles that lanes hit, and which of them can be one part.
template <class Real>
class HitTriangles {
  public:
    using Word = UInt<Real>;

    /// `id`: of triangles, in the lanes of `hit`, of which there is one; other lanes get any of these.
    TANDEM_HD_INLINE HitTriangles(const SceneView& scene, const Word& id, const Mask<Real>& hit) {
        const Word index = select(hit, id, Word(lane(id, lowest_bit(hit.bits())))) - Word(first_triangle(scene));
        const auto attribute = [&](const auto& of_first) {
            static_assert(sizeof(of_first) == sizeof(std::uint32_t));
            const LookupTable<std::uint32_t, step> words = {reinterpret_cast<const std::uint32_t*>(&of_first),
                                                            scene.triangle_count};
            return words[index];
        };
        const FaceAttributes& first = scene.triangles->attributes;
        triangles_ = {load_corners<Real>(scene.triangles, scene.triangle_count, index),
                      {attribute(first.normals), attribute(first.texcoords)}};
        const LookupTable<std::uint32_t> materials = {scene.material_of, primitive_count(scene)};
        material_ = materials[index + Word(first_triangle(scene))];
        sides_ = attribute(first.sides);
    }

    /// The lanes of `hit` whose triangles can be one part with that of lane i, which is one of them; and that part.
    /// None if the corners of lane i are too far away to be looked up.
    TANDEM_HD_INLINE Mask<Real> part_of(int i, const Word& id, const Mask<Real>& hit, ManyTriangles<Real>& part) const {
        part = {id, lane(material_, i), triangles_};
        LaneAttributes<Real>& attributes = part.triangles.attributes;
        attributes.has_normals = lane(attributes.normals, i) != no_attributes;
        attributes.has_texcoords = lane(attributes.texcoords, i) != no_attributes;
        attributes.sides = static_cast<FaceSides>(lane(sides_, i));
        const auto agrees = [](const Word& index, bool has) {
            return has ? index < Word(most_lane_corners) : index == Word(no_attributes);
        };
        const Mask<Real> here = hit && material_ == Word(part.material) && sides_ == Word(lane(sides_, i)) &&
                                agrees(attributes.normals, attributes.has_normals) &&
                                agrees(attributes.texcoords, attributes.has_texcoords);
        if (!lane(here, i)) return Mask<Real>(false);
        const auto in_all_lanes = [&](const Word& index) { return select(here, index, Word(lane(index, i))); };
        attributes.normals = in_all_lanes(attributes.normals);
        attributes.texcoords = in_all_lanes(attributes.texcoords);
        return here;
    }

  private:
    static constexpr std::uint32_t step = sizeof(Triangle) / sizeof(float);

    TriangleLanes<Real> triangles_;
    Word material_, sides_;
};

/// The lanes whose primitive is not that of the first one.
template <class Real>
TANDEM_HD_INLINE Mask<Real> others(const UInt<Real>& primitive, const Mask<Real>& lanes) {
    return lanes && primitive != UInt<Real>(lane(primitive, lowest_bit(lanes.bits())));
}

}  // namespace hit_primitives_detail

template <class Real>
TANDEM_HD_INLINE SurfacePoint<Real> surface_point(const TriangleLanes<Real>& triangles, const HitRecord<Real>&,
                                                  const Ray<Real>& ray, const Double<Real>& t) {
    const auto normal = geometric_normal<Real>(triangles.v0, triangles.v1, triangles.v2);
    return spawn_detail::plane_point(triangles.v0, normal, ray, t);
}

/// Whether there are several triangles to hit.
template <std::uint32_t kinds, class Real>
inline constexpr bool can_hit_several = RealTraits<Real>::lanes > 1 && (kinds & PrimitiveKinds::triangle) != 0;

/// The lanes that hit triangles, if these are three different ones or more; fewer are visited one after the other.
template <class Real>
TANDEM_HD_INLINE Mask<Real> several_triangles(const SceneView& scene, const UInt<Real>& primitive,
                                              const Mask<Real>& found) {
    using Word = UInt<Real>;
    const Word first(hit_primitives_detail::first_triangle(scene));
    const Mask<Real> triangles = found && !(primitive < first) && primitive < first + Word(scene.triangle_count);
    Mask<Real> rest = triangles;
    for (int different = 0; different < 2 && any(rest); ++different)
        rest = hit_primitives_detail::others<Real>(primitive, rest);
    return triangles && Mask<Real>(any(rest));
}

/// Calls visit(part, here) for the ManyTriangles<Real> that the lanes of `triangles` hit. Returns the lanes that are
/// left.
template <class Real, class Visit>
TANDEM_HD_INLINE Mask<Real> for_each_triangle_part(const SceneView& scene, const UInt<Real>& primitive,
                                                   Mask<Real> triangles, const Visit& visit) {
    const hit_primitives_detail::HitTriangles<Real> hits(scene, primitive, triangles);
    Mask<Real> left(false);
    while (any(triangles)) {
        ManyTriangles<Real> part;
        const Mask<Real> here = hits.part_of(lowest_bit(triangles.bits()), primitive, triangles, part);
        Mask<Real> later = triangles && !here;
        if (any(here) && any(hit_primitives_detail::others<Real>(primitive, here))) {
            visit(part, here);
        } else {
            later = hit_primitives_detail::others<Real>(primitive, triangles);
            left = left || (triangles && !later);
        }
        triangles = later;
    }
    return left;
}

/// Calls visit(part, here) for each OnePrimitive that the lanes of `found` hit, and its lanes; but first
/// visit_triangles(lanes) if these hit several_triangles(), which returns those lanes that are left.
template <std::uint32_t kinds, class Real, class VisitTriangles, class Visit>
TANDEM_HD_INLINE void for_each_part(const SceneView& scene, const UInt<Real>& primitive, Mask<Real> found,
                                    const VisitTriangles& visit_triangles, const Visit& visit) {
    if constexpr (can_hit_several<kinds, Real>) {
        bool may_be_several = scene.triangle_count > 2;
        while (any(found)) {
            const std::uint32_t id = lane(primitive, lowest_bit(found.bits()));
            const Mask<Real> here = found && primitive == UInt<Real>(id);
            const Mask<Real> later = found && !here;
            if (may_be_several && any(later)) {
                may_be_several = false;
                const Mask<Real> triangles = several_triangles<Real>(scene, primitive, found);
                if (any(triangles)) {
                    const Mask<Real> left = visit_triangles(triangles);
                    found = (found && !triangles) || left;
                    continue;
                }
            }
            visit(OnePrimitive{id}, here);
            found = later;
        }
    } else {
        for_each_unique_lane(primitive, found,
                             [&](std::uint32_t id, const Mask<Real>& here) { visit(OnePrimitive{id}, here); });
    }
}

}  // namespace tandem

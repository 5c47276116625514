/// The primitives of area lights, another one in each lane of a packet. Tested by tests/kernel/visit_lights_test.cpp.
#pragma once

#include <cstring>
#include <type_traits>

#include "tandem/kernel/lights/quad_light.h"
#include "tandem/kernel/lights/sphere_light.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/shapes/triangle.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// Whether a kind of primitive can be an area light. Other emissive primitives are found by paths only.
template <class Body>
inline constexpr bool is_light = is_face<Body> || std::is_same_v<Body, Sphere>;

// Primitives of one kind, one in each lane; metres, render space.
template <class Real>
struct LaneSphere {
    Vec3<Real> centre;
    Real radius;
};
template <class Real>
struct LaneTriangle {
    Vec3<Real> v0, v1, v2;
    Mask<Real> double_sided;
    Vec3<Double<Real>> normal;  ///< geometric_normal(); undefined where `double_sided`
};
template <class Real>
struct LaneQuad {
    Vec3<Real> v0, v1, v2, v3;
    Mask<Real> double_sided, culled;
};

namespace visit_lights_detail {

/// Collects the primitives of a packet's lanes.
template <class Real>
class LaneLights {
  public:
    TANDEM_HD void put(int lane, const Sphere& sphere) {
        put_corner(lane, 0, sphere.centre);
        radius_[lane] = Scalar(sphere.radius);
        set_lane(kind_, lane, kind_of<Sphere>);
    }
    TANDEM_HD void put(int lane, const Triangle& face) {
        put_corner(lane, 0, face.v0);
        put_corner(lane, 1, face.v1);
        put_corner(lane, 2, face.v2);
        put_kind_and_sides(lane, face);
        if constexpr (!is_fast<Real>) {
            if (is_double_sided(face.attributes)) return;
            const Vec3d normal = triangle_normal(face.v0, face.v1, face.v2);
            set_lane_constant(normal_.x, lane, normal.x);
            set_lane_constant(normal_.y, lane, normal.y);
            set_lane_constant(normal_.z, lane, normal.z);
        }
    }
    TANDEM_HD void put(int lane, const Quad& face) {
        put_corner(lane, 0, face.v0);
        put_corner(lane, 1, face.v1);
        put_corner(lane, 2, face.v2);
        put_corner(lane, 3, face.v3);
        put_kind_and_sides(lane, face);
    }

    /// Calls visit(light, mask) for each kind of light.
    template <class Visitor>
    TANDEM_HD_INLINE void visit(Visitor visit) const {
        const Mask<Real> spheres = lanes_of<Sphere>(), triangles = lanes_of<Triangle>(), quads = lanes_of<Quad>();
        if (any(spheres)) visit(LaneSphere<Real>{corner(0), load(radius_)}, spheres);
        if (any(triangles)) {
            LaneTriangle<Real> faces = {corner(0), corner(1), corner(2), has_sides(FaceSides::double_sided), normal_};
            if constexpr (is_fast<Real>) faces.normal = normalize(cross(faces.v1 - faces.v0, faces.v2 - faces.v0));
            visit(faces, triangles);
        }
        if (any(quads)) {
            visit(LaneQuad<Real>{corner(0), corner(1), corner(2), corner(3), has_sides(FaceSides::double_sided),
                                 has_sides(FaceSides::culled)},
                  quads);
        }
    }

  private:
    using D = Double<Real>;
    using Word = UInt<Real>;
    using Scalar = typename RealTraits<Real>::Scalar;
    static constexpr int lanes = RealTraits<Real>::lanes;

    TANDEM_HD static Real load(const Scalar (&values)[lanes]) {
        Real loaded;
        static_assert(sizeof(loaded) == sizeof(values));
        std::memcpy(&loaded, values, sizeof(loaded));
        return loaded;
    }
    [[nodiscard]] TANDEM_HD Vec3<Real> corner(int number) const {
        return {load(corner_[number][0]), load(corner_[number][1]), load(corner_[number][2])};
    }
    TANDEM_HD void put_corner(int lane, int number, const Vec3f& at) {
        corner_[number][0][lane] = Scalar(at.x);
        corner_[number][1][lane] = Scalar(at.y);
        corner_[number][2][lane] = Scalar(at.z);
    }
    template <class Face>
    TANDEM_HD void put_kind_and_sides(int lane, const Face& face) {
        set_lane(kind_, lane, kind_of<Face>);
        set_lane(sides_, lane, static_cast<std::uint32_t>(face.attributes.sides));
    }
    [[nodiscard]] TANDEM_HD Mask<Real> has_sides(FaceSides sides) const {
        return sides_ == Word(static_cast<std::uint32_t>(sides));
    }
    template <class Body>
    [[nodiscard]] TANDEM_HD Mask<Real> lanes_of() const {
        return kind_ == Word(kind_of<Body>);
    }

    // zeros in lanes without such a light: all lanes compute
    Scalar corner_[4][3][lanes] = {};  ///< of a face; the first one is the centre of a sphere
    Scalar radius_[lanes] = {};
    Word kind_ = Word(0U);
    Word sides_ = Word(0U);
    Vec3<D> normal_ = {D(0.0), D(0.0), D(0.0)};
};

}  // namespace visit_lights_detail

/// Calls visit(light, here) with the lights among the primitives of the lanes of `active`. `light` is the primitive; in
/// packets all those of one kind, one in each lane of `here`, so that a packet computes each kind once, however many
/// lights its lanes have chosen.
template <class Real, class Visitor>
TANDEM_HD_INLINE void visit_lights(const SceneView& scene, const UInt<Real>& primitive, const Mask<Real>& active,
                                   Visitor visit) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        if (!active) return;
        visit_primitive(
            scene, primitive, [&](const auto& body) __attribute__((always_inline)) {
                using Body = std::decay_t<decltype(body)>;
                if constexpr (is_light<Body>) {
                    if (may_emit_light(kind_of<Body>)) visit(body, Mask<Real>(true));
                }
            });
    } else {
        visit_lights_detail::LaneLights<Real> lights;
        for (auto left = active.bits(); left != 0; left &= left - 1) {
            const int lane_number = lowest_bit(left);
            visit_primitive(scene, lane(primitive, lane_number), [&](const auto& body) {
                if constexpr (is_light<std::decay_t<decltype(body)>>) lights.put(lane_number, body);
            });
        }
        lights.visit(visit);
    }
}

}  // namespace tandem

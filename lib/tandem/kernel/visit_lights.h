/// The primitives of area lights, another one in each lane of a packet. Tested by tests/kernel/visit_lights_test.cpp.
#pragma once

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
    /// The primitive of the lanes of `here`.
    TANDEM_HD void put(const Mask<Real>& here, const Sphere& sphere) {
        put_corners(here, sphere.centre);
        radius_ = select(here, Real(sphere.radius), radius_);
        spheres_ = spheres_ || here;
    }
    TANDEM_HD void put(const Mask<Real>& here, const Triangle& face) {
        put_corners(here, face.v0, face.v1, face.v2);
        put_sides(here, face);
        triangles_ = triangles_ || here;
        if constexpr (!is_fast<Real>) {
            if (is_double_sided(face.attributes)) return;
            normal_ = select(here, broadcast<D>(triangle_normal(face.v0, face.v1, face.v2)), normal_);
        }
    }
    TANDEM_HD void put(const Mask<Real>& here, const Quad& face) {
        put_corners(here, face.v0, face.v1, face.v2, face.v3);
        put_sides(here, face);
        quads_ = quads_ || here;
    }

    /// Calls visit(light, mask) for each kind of light.
    template <class Visitor>
    TANDEM_HD_INLINE void visit(Visitor visit) const {
        const auto& [v0, v1, v2, v3] = corner_;
        if (any(spheres_)) visit(LaneSphere<Real>{v0, radius_}, spheres_);
        if (any(triangles_)) {
            LaneTriangle<Real> faces = {v0, v1, v2, double_sided_, normal_};
            if constexpr (is_fast<Real>) faces.normal = normalize(cross(faces.v1 - faces.v0, faces.v2 - faces.v0));
            visit(faces, triangles_);
        }
        if (any(quads_)) visit(LaneQuad<Real>{v0, v1, v2, v3, double_sided_, culled_}, quads_);
    }

  private:
    using D = Double<Real>;

    template <class... Corners>
    TANDEM_HD void put_corners(const Mask<Real>& here, const Corners&... at) {
        int number = 0;
        ((corner_[number] = select(here, broadcast<Real>(at), corner_[number]), ++number), ...);
    }
    template <class Face>
    TANDEM_HD void put_sides(const Mask<Real>& here, const Face& face) {
        const FaceSides sides = face.attributes.sides;
        double_sided_ = double_sided_ || (here && Mask<Real>(sides == FaceSides::double_sided));
        culled_ = culled_ || (here && Mask<Real>(sides == FaceSides::culled));
    }

    TANDEM_HD static Vec3<Real> zeros() { return {Real(0.0F), Real(0.0F), Real(0.0F)}; }

    // zeros in lanes without such a light: all lanes compute
    Vec3<Real> corner_[4] = {zeros(), zeros(), zeros(), zeros()};  ///< of a face; the first one is a sphere's centre
    Real radius_ = Real(0.0F);
    Vec3<D> normal_ = {D(0.0), D(0.0), D(0.0)};
    Mask<Real> spheres_ = Mask<Real>(false), triangles_ = spheres_, quads_ = spheres_;
    Mask<Real> double_sided_ = spheres_, culled_ = spheres_;
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
        for_each_unique_lane(primitive, active, [&](std::uint32_t number, const Mask<Real>& here) {
            visit_primitive(scene, number, [&](const auto& body) {
                if constexpr (is_light<std::decay_t<decltype(body)>>) lights.put(here, body);
            });
        });
        lights.visit(visit);
    }
}

}  // namespace tandem

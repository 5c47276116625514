/// The surface at a hit: its normal by kind of primitive, its reflectance by material.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/kernel/corner_values.h"
#include "tandem/kernel/material.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/shapes/shading_normal.h"
#include "tandem/kernel/shapes/tangent_frame.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/texture/normal_map.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// Not initialised where nothing needs it: a GPU would store zeros at every vertex.
template <class Real>
struct Surface {
    Vec3<Double<Real>> normal;  ///< for shading: unit, outward, world space
    Reflectance<Real> reflectance;
    // only where the effects need them
    UInt<Real> material;
    Vec3<Real> emission;  ///< on the side that the ray comes from
    Mask<Real> opaque = Mask<Real>(true);
    Mask<Real> unlit = Mask<Real>(false);  ///< its emission lights nothing
    Vec3<Double<Real>> tangent;            ///< where `anisotropic`: x of the lobes' frame, unit, world space
    Mask<Real> anisotropic = Mask<Real>(false);
};

/// A hit point and its surface.
template <class Real>
struct Vertex {
    SurfacePoint<Real> point;
    Surface<Real> surface;
};

/// How many alpha-masked hits a ray passes before it counts as blocked.
inline constexpr std::uint32_t max_masked_hits = 255;

// The normal of each kind where a ray hits the primitive at t, in the lanes of `here`: of a sphere of any length, else
// unit. `record`: the shape's, of this hit.
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Sphere& sphere, const HitRecord<Real>&,
                                       const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>&) {
    return sphere_offset(sphere, ray, t);  // see find_vertex()
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Box&, const HitRecord<Real>& record, const Ray<Real>&,
                                       const Double<Real>&, const Mask<Real>&) {
    return face_normal(record);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Ellipsoid& body, const HitRecord<Real>&,
                                       const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>&) {
    return ellipsoid_normal(body, ray, t);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Parallelepiped& body, const HitRecord<Real>& record,
                                       const Ray<Real>&, const Double<Real>&, const Mask<Real>&) {
    return parallelepiped_normal(body, record);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Triangle& triangle, const HitRecord<Real>&,
                                       const Ray<Real>& ray, const Double<Real>&, const Mask<Real>& here) {
    const Vec3f* normals = corner_normals(scene.normals, triangle.attributes);
    return shading_normal<Real>(triangle, normals, ray, here);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Quad& quad, const HitRecord<Real>& record,
                                       const Ray<Real>& ray, const Double<Real>&, const Mask<Real>& here) {
    const Vec3f* normals = corner_normals(scene.normals, quad.attributes);
    return shading_normal<Real>(quad, record, normals, ray, here);
}

template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const TriangleLanes<Real>& triangles,
                                       const HitRecord<Real>&, const Ray<Real>& ray, const Double<Real>&,
                                       const Mask<Real>& here) {
    return shading_normal(triangles, scene.normals, ray, here);
}

/// The same on a face of an instanced mesh, whose normals are placed for it.
template <class Real>
TANDEM_HD Vec3<Double<Real>> instanced_normal(const SceneView& scene, std::uint32_t id, const Ray<Real>& ray,
                                              const Mask<Real>& here) {
    const InstancedFace at = instanced_face(scene, id);
    const Vec3f* of_mesh = corner_normals(static_cast<const InstancedView&>(scene).mesh_normals, at.face.attributes);
    Vec3f normals[3] = {};
    for (int i = 0; i < 3 && of_mesh != nullptr; ++i) {
        normals[i] = place_normal(at.instance.normal_matrix, of_mesh[i]);
    }
    return shading_normal<Real>(placed(at), of_mesh == nullptr ? nullptr : normals, ray, here);
}

/// normal_at() of a part of for_each_part() that visit_primitive() visits as `body`.
template <std::uint32_t kinds, class Real, class Part, class Body>
TANDEM_HD Vec3<Double<Real>> normal_of(const SceneView& scene, const Part& part, const Body& body,
                                       const HitRecord<Real>& record, const Ray<Real>& ray, const Double<Real>& t,
                                       const Mask<Real>& here) {
    if constexpr (std::is_same_v<Body, Triangle>) {
        if (is_instanced<kinds>(scene, part.id)) return instanced_normal<Real>(scene, part.id, ray, here);
    }
    return normal_at<Real>(scene, body, record, ray, t, here);
}

/// Do materials depend on the position on the surface?
template <class Effects>
TANDEM_HD constexpr bool has_pictures() {
    return Effects::has(Effect::textures) || Effects::has(Effect::normal_maps) || Effects::has(Effect::cutouts);
}

/// `normal` perturbed by a normal map, unit. Where `turned`, on the back of a double-sided face, `normal` is reversed,
/// and so is the map's normal of the front.
template <class Real>
TANDEM_HD_CALL_ON(host)
Vec3<Double<Real>> bent_normal(const SceneView& scene, const MaterialTextures& textures,
                               const Parametrisation<Real>& at, const Vec3<Double<Real>>& normal,
                               const Mask<Real>& turned) {
    const auto texel = sample<Real>(scene.textures, textures.normal, at.u, at.v);
    const auto front = select(turned, -normal, normal);
    const auto bent = mapped_normal<Real>(tangent_frame(front, at.dp_du, at.dp_dv), texel, textures.normal_scale);
    return select(turned, -bent, bent);
}

/// The tangent along which microfacets are rougher. `normal`: the one for shading, unit; on both sides of a face the
/// grooves are the same lines. Without usable coordinates the direction is that of frame_around().
template <class Real>
TANDEM_HD_CALL_ON(host)
Vec3<Double<Real>> brushed_tangent(const Anisotropy& anisotropy, const Parametrisation<Real>& at,
                                   const Vec3<Double<Real>>& normal, const Rgba<Real>& texel) {
    return rough_tangent<Real>(anisotropy, tangent_frame(normal, at.dp_du, at.dp_dv), texel);
}

/// Is the surface opaque at `hit`, or masked out, in the lanes of `found`?
template <std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD_CALL_ON(host)
Mask<Real> is_opaque_at(const SceneView& scene, const Ray<Real>& ray, const From& source, const Closest<Real>& hit,
                        const Mask<Real>& found) {
    Mask<Real> opaque(true);
    const auto test = [&](const auto& part, const Mask<Real>& here) {
        const std::uint32_t material = material_of<kinds>(scene, part);
        if (!has_alpha_mask(scene, material)) return;
        const MaterialTextures& textures = scene.textures.materials[material];
        bool on_face = false;
        const Mask<Real> exits = hits_far_side<kinds>(scene, part, ray, source, hit.t, here);
        HitRecord<Real> record;
        visit_primitive<kinds>(scene, part, [&](const auto& body) {
            on_face = is_face<std::decay_t<decltype(body)>>;
            record = record_hit(body, ray, hit.t, exits, here);
        });
        CornerValues<kinds, Real, std::decay_t<decltype(part)>> values(scene, part, record, ray, hit.t, here);
        const Real alpha = base_colour(textures, on_face, values).a;
        opaque = opaque && (!here || is_opaque<Real>(textures, alpha));
    };
    const auto test_triangles = [&](const auto& lanes) {
        return for_each_triangle_part<Real>(scene, hit.primitive, lanes, test);
    };
    for_each_part<kinds, Real>(scene, hit.primitive, found, test_triangles, test);
    return opaque;
}

/// Where a vertex must be known more accurately than as a point of its ray, or with the side that it is seen from.
inline constexpr EffectMask effects_on_surfaces = bouncing_effects | effects_of_local_lobes | Effect::shadows |
                                                  Effect::area_lights | Effect::emission | Effect::environment_light |
                                                  Effect::normal_maps;
template <class Effects>
TANDEM_HD constexpr bool can_leave_surfaces() {
    return Effects::most.has_any(effects_on_surfaces);
}

namespace surface_detail {

/// A black opaque surface, as far as the effects define one.
template <class Effects, class Real>
TANDEM_HD void clear(Surface<Real>& surface) {
    using D = Double<Real>;
    surface.normal = {D(0.0), D(0.0), D(1.0)};
    surface.reflectance.ambient = black<Real>();
    tandem::clear<Effects>(surface.reflectance.lobes);
    surface.material = UInt<Real>(0U);
    if (Effects::has(Effect::emission)) surface.emission = black<Real>();
    if (Effects::has(Effect::anisotropy)) surface.tangent = surface.normal;
}

/// The lanes of `here`, which hit `part` of for_each_part(). The lambda is inlined by force: g++ leaves it as a call
/// otherwise, and renders take up to 2 % longer.
template <class Effects, std::uint32_t kinds, class Real, class From, class Part>
TANDEM_HD void find_part(const SceneView& scene, const Ray<Real>& ray, const From& source, const Closest<Real>& hit,
                         const Part& part, const Mask<Real>& here, Vertex<Real>& vertex, Mask<Real>& on_sphere) {
    using D = Double<Real>;
    const bool needs_point = Effects::has_any(effects_on_surfaces);
    Surface<Real>& surface = vertex.surface;
    SurfacePoint<Real>& point = vertex.point;

    // Normals
    Vec3<D> normal = surface.normal;
    const Mask<Real> exits = hits_far_side<kinds>(scene, part, ray, source, hit.t, here);
    bool on_face = false;
    FaceSides sides = FaceSides::single_sided;
    SurfacePoint<Real> own;
    HitRecord<Real> record;
    visit_primitive<kinds>(
        scene, part, [&](const auto& body) __attribute__((always_inline)) {
            using Body = std::decay_t<decltype(body)>;
            record = record_hit(body, ray, hit.t, exits, here);
            if (needs_point) own = surface_point(body, record, ray, hit.t);
            if (needs_point && !is_face<Body>) {
                normal = own.normal;
            } else {
                normal = normal_of<kinds, Real>(scene, part, body, record, ray, hit.t, here);
                if constexpr (std::is_same_v<Body, Sphere>) on_sphere = on_sphere || here;
            }
            if constexpr (is_face<Body>) {
                on_face = true;
                sides = body.attributes.sides;
            }
        });
    if (needs_point) {
        own.primitive = ids_of<Real>(part);
        keep(here, own, point);
    }

    // Textures
    const std::uint32_t number = material_of<kinds>(scene, part);
    const Optics& optics = scene.optics[number];
    const bool both_sides = sides == FaceSides::double_sided;
    MaterialTexels<Real> texels;
    if (has_pictures<Effects>() && has_textures(scene.textures)) {
        const MaterialTextures& textures = scene.textures.materials[number];
        CornerValues<kinds, Real, Part> values(scene, part, record, ray, hit.t, here);
        if (Effects::has(Effect::textures) || Effects::has(Effect::cutouts)) {
            texels.base_colour = base_colour(textures, on_face, values);
        }
        if (Effects::has(Effect::normal_maps) && textures.normal.texture != no_texture) {
            const Mask<Real> turned = Mask<Real>(both_sides) && own.from_inside;
            normal = bent_normal<Real>(scene, textures, values.in(textures.normal.slot), normalize(normal), turned);
        }
        if (Effects::has(Effect::emission) && Effects::has(Effect::textures)) {
            const bool lit = textures.emission.texture != no_texture;
            const Rgba<Real> at = lit ? values.texture(textures.emission) : texels.base_colour;
            if (lit || optics.unlit != 0) texels.emission = {at.r, at.g, at.b};
        }
        if (Effects::has(Effect::cutouts) && !has_no_masks(scene)) {
            surface.opaque = surface.opaque && (!here || is_opaque<Real>(textures, texels.base_colour.a));
        }
        if (Effects::has(Effect::microfacets) && Effects::has(Effect::textures) &&
            textures.metallic_roughness.texture != no_texture) {
            texels.metallic_roughness = values.texture(textures.metallic_roughness);
        }
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is)                            \
    if (Effects::has(needs) && Effects::has(Effect::textures) && scene.names##_count > 0 && \
        scene.names[number].texture != no_texture) {                                        \
        texels.name = values.texture(scene.names[number]);                                  \
    }
#include "tandem/kernel/bsdf/lobes.def"
    }

    // Brushed surfaces
    if (Effects::has(Effect::microfacets) && Effects::has(Effect::anisotropy) && scene.anisotropy_count > 0 &&
        scene.microfacets[number].anisotropy > 0.0F) {
        const Anisotropy& anisotropy = scene.anisotropies[number];
        CornerValues<kinds, Real, Part> values(scene, part, record, ray, hit.t, here);
        Rgba<Real> texel = default_anisotropy_texel<Real>();
        if (Effects::has(Effect::textures) && anisotropy.texture.texture != no_texture) {
            texel = values.texture(anisotropy.texture);
            texels.anisotropy = texel.b;
        }
        const auto tangent = brushed_tangent<Real>(anisotropy, values.in(anisotropy.slot), normal, texel);
        surface.tangent = select(here, tangent, surface.tangent);
        surface.anisotropic = surface.anisotropic || here;
    }

    // Reflectance and emission
    surface.normal = select(here, normal, surface.normal);
    const auto reflectance =
        reflectance_of<Effects, Real>(scene, number, {optics, texels, normal, ray.direction}, own.from_inside);
    surface.reflectance.ambient = select(here, reflectance.ambient, surface.reflectance.ambient);
    keep<Effects>(here, reflectance.lobes, surface.reflectance.lobes);
    if (has_bounces<Effects>()) surface.material = select(here, UInt<Real>(number), surface.material);
    if (Effects::has(Effect::emission) && norm1(optics.emission) > 0.0F) {
        const bool unlit = optics.unlit != 0;
        const Mask<Real> shines = here && (Mask<Real>(both_sides || unlit) || !own.from_inside);
        surface.emission = select(shines, broadcast<Real>(optics.emission) * texels.emission, surface.emission);
        surface.unlit = surface.unlit || (shines && Mask<Real>(unlit));
    }
}

/// No surface.
template <class Effects, class Real>
TANDEM_HD void begin(const Ray<Real>& ray, Vertex<Real>& vertex) {
    clear<Effects>(vertex.surface);
    if (Effects::has_any(effects_on_surfaces)) vertex.point = {ray.origin, widen(ray.direction)};
}

/// Of rays that hit several triangles, and the lanes that are left.
template <class Real>
struct VerticesOnTriangles {
    Vertex<Real> vertex;
    Mask<Real> left;
};
// A call with copies, so that its caller can keep these in registers.
template <class Effects, std::uint32_t kinds, class Real, class From>
TANDEM_HD_CALL VerticesOnTriangles<Real> find_on_triangles(const SceneView& scene, Ray<Real> ray, From source,
                                                           Closest<Real> hit, Mask<Real> triangles) {
    VerticesOnTriangles<Real> result;
    begin<Effects>(ray, result.vertex);
    Mask<Real> on_sphere(false);
    result.left =
        for_each_triangle_part<Real>(scene, hit.primitive, triangles, [&](const auto& part, const Mask<Real>& here) {
            find_part<Effects, kinds>(scene, ray, source, hit, part, here, result.vertex, on_sphere);
        });
    return result;
}

}  // namespace surface_detail

/// The vertex at `hit`, which `ray` from `source` found, in the lanes of `found`: for all rays of a packet that hit the
/// same primitive, or triangles of the same material, at once. `kinds`: the ones that may have been hit; `Effects`:
/// what their materials may need. vertex.point becomes the hit, if these have effects_on_surfaces. In other lanes the
/// surface is black.
template <class Effects, std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD void find_vertex(const SceneView& scene, const Ray<Real>& ray, const From& source, const Closest<Real>& hit,
                           const Mask<Real>& found, Vertex<Real>& vertex) {
    surface_detail::begin<Effects>(ray, vertex);
    const auto find_on_triangles = [&](const auto& lanes) {
        const auto several = surface_detail::find_on_triangles<Effects, kinds>(scene, ray, source, hit, lanes);
        vertex = several.vertex;
        return several.left;
    };
    Mask<Real> on_sphere(false);
    for_each_part<kinds, Real>(
        scene, hit.primitive, found, find_on_triangles, [&](OnePrimitive part, const Mask<Real>& here) {
            surface_detail::find_part<Effects, kinds>(scene, ray, source, hit, part, here, vertex, on_sphere);
        });
    Surface<Real>& surface = vertex.surface;
    // once for all lanes: the rays of a packet hit up to as many spheres as it has lanes
    if (any(on_sphere)) surface.normal = select(on_sphere, normalize(surface.normal), surface.normal);
}

}  // namespace tandem

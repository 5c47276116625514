/// The surface at a hit: normal and material, by kind of primitive.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/kernel/bsdf/metallic_roughness.h"
#include "tandem/kernel/corner_values.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/shapes/shading_normal.h"
#include "tandem/kernel/shapes/tangent_frame.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/texture/normal_map.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

template <class Real>
struct Surface {
    Vec3<Double<Real>> normal;  ///< shading normal: unit, outward, world space
    Vec3<Real> ambient, diffuse, specular;
    Real shininess;
    // only where the effects need them
    UInt<Real> material;
    Vec3<Real> mirror;
    Real transmission;
    Vec3<Real> emission;  ///< on the side that the ray comes from
    Mask<Real> opaque = Mask<Real>(true);
    Mask<Real> unlit = Mask<Real>(false);  ///< its emission lights nothing
    /// Then `specular` is black, and `diffuse` lies under the border of the microfacets (kernel/microfacets.h).
    Mask<Real> has_microfacets = Mask<Real>(false);
    Vec3<Real> f0{};       ///< reflectance of the microfacets at normal incidence
    Double<Real> alpha{};  ///< their roughness
    Real border{};         ///< reflectance of the border at normal incidence
};

/// How many alpha-masked hits a ray passes before it counts as blocked.
inline constexpr std::uint32_t most_holes = 255;

// The normal of each kind at parameter t of a ray that hits the primitive there, in the lanes of `here`: of a sphere of
// any length, else unit. `exits`: where the ray leaves the same solid that it left inward.
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Sphere& sphere, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&, const Mask<Real>&) {
    return sphere_offset(sphere, ray, t);  // see surface_at()
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Box& box, const Ray<Real>& ray, const Double<Real>&,
                                       const Mask<Real>&, const Mask<Real>& exits) {
    return face_normal<Real>(cross_box(box, ray), widen(ray.direction), exits);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Ellipsoid& body, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&, const Mask<Real>&) {
    return ellipsoid_normal(body, ray, t);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Parallelepiped& body, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>&, const Mask<Real>& exits) {
    return parallelepiped_normal(body, ray, exits);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Triangle& triangle, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>& here, const Mask<Real>&) {
    const Vec3f* normals = corner_normals(scene.normals, triangle.attributes);
    return shading_normal<Real>(triangle, normals, ray, here);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Quad& quad, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>& here, const Mask<Real>&) {
    const Vec3f* normals = corner_normals(scene.normals, quad.attributes);
    return shading_normal<Real>(quad, normals, ray, t, here);
}

/// Do materials depend on the position on the surface?
template <class Effects>
TANDEM_HD constexpr bool has_pictures() {
    return Effects::has(Effect::textures) || Effects::has(Effect::normal_maps) || Effects::has(Effect::cutouts);
}

/// `normal` perturbed by a normal map, unit. Where `turned`, on the back of a double-sided face, `normal` is reversed,
/// and so is the map's normal of the front.
template <class Real>
TANDEM_HD_STAGE Vec3<Double<Real>> bent_normal(const SceneView& scene, const MaterialTextures& textures,
                                               const Parametrisation<Real>& at, const Vec3<Double<Real>>& normal,
                                               const Mask<Real>& turned) {
    const auto texel = sample<Real>(scene.textures, textures.normal, at.u, at.v);
    const auto front = select(turned, -normal, normal);
    const auto bent = mapped_normal<Real>(tangent_frame(front, at.dp_du, at.dp_dv), texel, textures.normal_scale);
    return select(turned, -bent, bent);
}

/// Is the surface opaque at `hit`, or masked out, in the lanes of `found`?
template <std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD_STAGE Mask<Real> is_opaque_at(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                        const Closest<Real>& hit, const Mask<Real>& found) {
    Mask<Real> opaque(true);
    for_each_unique_lane(hit.primitive, found,
                         [&](std::uint32_t primitive, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
                             if (!has_textures(scene.textures)) return;
                             const MaterialTextures& textures = scene.textures.materials[scene.material_of[primitive]];
                             if (!(textures.alpha_cutoff > 0.0F)) return;
                             bool on_face = false;
                             visit_primitive<kinds>(scene, primitive, [&](const auto& body) TANDEM_INLINE_LAMBDA {
                                 on_face = is_face<std::decay_t<decltype(body)>>;
                             });
                             const Mask<Real> exits = hits_far_side<kinds>(scene, primitive, ray, source, hit.t, here);
                             CornerValues<kinds, Real> values(scene, primitive, ray, hit.t, here, exits);
                             const Real alpha = base_colour(textures, on_face, values).a;
                             opaque = opaque && (!here || is_opaque<Real>(textures, alpha));
                         });
    return opaque;
}

/// Where a vertex must be known more accurately than as a point of its ray.
inline constexpr EffectMask effects_on_surfaces = bouncing_effects | Effect::shadows | Effect::area_lights |
                                                  Effect::emission | Effect::environment_light | Effect::normal_maps;
template <class Effects>
TANDEM_HD constexpr bool can_leave_surfaces() {
    return Effects::most.has_any(effects_on_surfaces);
}

/// The surface at `hit`, which `ray` from `source` found, in the lanes of `found`. The rays of a packet hit few
/// different primitives, so each of these is looked up and its normal formed once, for all its rays. `kinds`: the ones
/// that may have been hit; `Effects`: what their materials may need. `point` becomes the hit, if these have
/// effects_on_surfaces.
template <class Effects, std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD Surface<Real> surface_at(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                   const Closest<Real>& hit, const Mask<Real>& found, SurfacePoint<Real>& point) {
    using D = Double<Real>;
    const bool needs_point = Effects::has_any(effects_on_surfaces);
    if (needs_point) point = {ray.origin, widen(ray.direction)};
    Mask<Real> on_sphere(false);
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Surface<Real> surface = {{D(0.0), D(0.0), D(1.0)}, black, black,      black, Real(1.0F),
                             UInt<Real>(0U),           black, Real(0.0F), black};
    for_each_unique_lane(
        hit.primitive, found, [&](std::uint32_t primitive, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
            Vec3<D> normal = surface.normal;
            const Mask<Real> exits = hits_far_side<kinds>(scene, primitive, ray, source, hit.t, here);
            const std::uint32_t number = scene.material_of[primitive];
            const Real one(1.0F);
            Rgba<Real> picture = {one, one, one, one};
            Vec3<Real> glow = {one, one, one};
            Rgba<Real> rough_metal = {one, one, one, one};
            bool on_face = false;
            FaceSides sides = FaceSides::single_sided;
            SurfacePoint<Real> own;
            visit_primitive<kinds>(scene, primitive, [&](const auto& body) TANDEM_INLINE_LAMBDA {
                using Body = std::decay_t<decltype(body)>;
                if (needs_point) own = surface_point(body, ray, hit.t, exits, here);
                if (needs_point && !is_face<Body>) {
                    normal = own.normal;
                } else {
                    normal = normal_at<Real>(scene, body, ray, hit.t, here, exits);
                    if constexpr (std::is_same_v<Body, Sphere>) on_sphere = on_sphere || here;
                }
                if constexpr (is_face<Body>) {
                    on_face = true;
                    sides = body.attributes.sides;
                }
            });
            if (needs_point) {
                own.primitive = UInt<Real>(primitive);
                keep(here, own, point);
            }
            const bool both_sides = sides == FaceSides::double_sided;
            const Optics& optics = scene.optics[number];
            if (has_pictures<Effects>() && has_textures(scene.textures)) {
                const MaterialTextures& textures = scene.textures.materials[number];
                CornerValues<kinds, Real> values(scene, primitive, ray, hit.t, here, exits);
                if (Effects::has(Effect::textures) || Effects::has(Effect::cutouts)) {
                    picture = base_colour(textures, on_face, values);
                }
                if (Effects::has(Effect::normal_maps) && textures.normal.texture != no_texture) {
                    const Mask<Real> turned = Mask<Real>(both_sides) && own.from_inside;
                    normal =
                        bent_normal<Real>(scene, textures, values.in(textures.normal.slot), normalize(normal), turned);
                }
                if (Effects::has(Effect::emission) && Effects::has(Effect::textures)) {
                    const bool lit = textures.emission.texture != no_texture;
                    const Rgba<Real> at = lit ? values.texture(textures.emission) : picture;
                    if (lit || optics.unlit != 0) glow = {at.r, at.g, at.b};
                }
                if (Effects::has(Effect::cutouts)) {
                    surface.opaque = surface.opaque && (!here || is_opaque<Real>(textures, picture.a));
                }
                if (Effects::has(Effect::microfacets) && Effects::has(Effect::textures) &&
                    textures.metallic_roughness.texture != no_texture) {
                    rough_metal = values.texture(textures.metallic_roughness);
                }
            }
            const PhongMaterial& material = scene.materials[number];
            Vec3<Real> ambient = broadcast<Real>(material.ambient);
            Vec3<Real> diffuse = broadcast<Real>(material.diffuse);
            if (Effects::has(Effect::textures) && has_textures(scene.textures)) {
                const Vec3<Real> factor = {picture.r, picture.g, picture.b};
                ambient = ambient * factor;
                diffuse = diffuse * factor;
            }
            Vec3<Real> specular = broadcast<Real>(material.specular);
            if (Effects::has(Effect::microfacets) && scene.microfacet_count > 0 &&
                scene.microfacets[number].is_there != 0) {
                const Microfacets& facets = scene.microfacets[number];
                const Real metallic = Real(facets.metallic) * rough_metal.b;
                const MetallicRoughnessLobes<Real> lobes =
                    lobes_of<Real>({diffuse, metallic, Real(facets.roughness) * rough_metal.g, Real(optics.ior)});
                ambient = ambient * (one - metallic);
                diffuse = lobes.diffuse.base.reflectance;
                specular = black;
                surface.has_microfacets = surface.has_microfacets || here;
                surface.f0 = select(here, lobes.specular.f0, surface.f0);
                surface.alpha = select(here, lobes.specular.facets.alpha_x, surface.alpha);
                surface.border = select(here, lobes.diffuse.f0, surface.border);
            }
            surface.normal = select(here, normal, surface.normal);
            surface.ambient = select(here, ambient, surface.ambient);
            surface.diffuse = select(here, diffuse, surface.diffuse);
            surface.specular = select(here, specular, surface.specular);
            surface.shininess = select(here, Real(material.shininess), surface.shininess);
            if (has_bounces<Effects>()) {
                surface.material = select(here, UInt<Real>(number), surface.material);
                if (Effects::has(Effect::reflection)) {
                    surface.mirror = select(here, broadcast<Real>(optics.mirror), surface.mirror);
                }
                if (Effects::has(Effect::refraction)) {
                    surface.transmission = select(here, Real(optics.transmission), surface.transmission);
                }
            }
            if (Effects::has(Effect::emission)) {
                if (norm1(optics.emission) > 0.0F) {
                    const bool unlit = optics.unlit != 0;
                    const Mask<Real> shines = here && (Mask<Real>(both_sides || unlit) || !own.from_inside);
                    surface.emission = select(shines, broadcast<Real>(optics.emission) * glow, surface.emission);
                    surface.unlit = surface.unlit || (shines && Mask<Real>(unlit));
                }
            }
        });
    // once for all lanes: the rays of a packet hit up to as many spheres as it has lanes
    if (any(on_sphere)) surface.normal = select(on_sphere, normalize(surface.normal), surface.normal);
    return surface;
}

}  // namespace tandem

#include "tandem/oracle/oracle_vertex.h"

#include <cmath>

namespace tandem::oracle {

namespace {

/// Where a surface has no coordinates: the x axis, carried along by the shortest turn from the nearer end of the z axis
/// to the normal.
Vector any_tangent(const Vector& n) {
    const Vector axis = {0, 0, n.z < 0 ? Real(-1) : Real(1)};
    return Vector{1, 0, 0} - (n + axis) * (n.x / (1 + std::abs(n.z)));
}

/// The direction of anisotropy by its angle, and its strength. `at`: the texture coordinates of a slot.
template <class At>
void brush(const SceneView& scene, const At& at, Vertex& vertex) {
    if (scene.anisotropy_count == 0) return;
    vertex.anisotropy = scene.microfacets[vertex.material].anisotropy;
    const Anisotropy& anisotropy = scene.anisotropies[vertex.material];
    Real angle = std::atan2(Real{anisotropy.y}, Real{anisotropy.x});
    if (anisotropy.texture.texture != no_texture) {
        const Texel texel = sample_texture(scene, anisotropy.texture, at(anisotropy.texture.slot));
        vertex.anisotropy *= texel.b;
        const Real x = 2 * texel.r - 1, y = 2 * texel.g - 1;
        if (std::hypot(x, y) > Real(0x1p-20)) angle += std::atan2(y, x);
    }
    if (!(vertex.anisotropy > 0)) return;
    const TexturePoint point = at(anisotropy.slot);
    const Vector n = vertex.normal;
    const Vector flat = point.along_u - n * inner(point.along_u, n);
    const bool usable = inner(flat, flat) > Real(0x1p-30) * inner(point.along_u, point.along_u);
    const Vector t = usable ? unit(flat) : any_tangent(n);
    Vector b = cross(n, t);
    if (inner(b, point.along_v) > 0) b = b * -1;
    vertex.along = unit(t * std::cos(angle) + b * std::sin(angle));
}

}  // namespace

NearestSurface nearest_surface(const BoundedView& scene, const Line& line, const RaySource& source,
                               std::uint32_t except, const Passed* passed) {
    NearestSurface nearest;
    const RoughLine rough(line);
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        if (id == except) continue;
        // rounding may move a line outside of the primitive that it leaves
        if (scene.balls != nullptr && id != source.primitive && is_outside(rough, scene.balls[id])) continue;
        const auto counts = [&](const SurfaceHit& hit) {
            if (passed == nullptr) return true;
            if (hit.sides == FaceSides::culled && inner(line.direction, hit.facet) > 0) return false;
            return hit.t > passed->t || (hit.t == passed->t && id > passed->primitive);
        };
        const Start start = id != source.primitive ? Start::anywhere
                            : source.inside        ? Start::leaving_inward
                                                   : Start::leaving_outward;
        auto hit = hit_primitive(scene, id, line, start);
        // a primitive that the path has already hit, a solid or a folded quad, may be hit a second time
        if (hit && !counts(*hit) && start == Start::anywhere) hit = hit_primitive(scene, id, line, Start::before_first);
        if (hit && !counts(*hit)) continue;
        // ids ascend, so at equal t the lower one stays
        if (hit && (nearest.primitive == no_primitive || hit->t < nearest.surface.t)) nearest = {*hit, id};
    }
    return nearest;
}

Vertex vertex_at(const SceneView& scene, const Line& ray, const NearestSurface& nearest) {
    Vertex vertex{};
    vertex.point = ray.origin + ray.direction * nearest.surface.t;
    vertex.direction = unit(ray.direction);
    vertex.facet = nearest.surface.facet;
    vertex.normal = nearest.surface.normal;
    vertex.primitive = nearest.primitive;
    vertex.material = scene.material_of[nearest.primitive];
    vertex.from_inside = inner(vertex.direction, vertex.facet) > 0;
    const bool double_sided = nearest.surface.sides == FaceSides::double_sided;
    const Optics& optics = scene.optics[vertex.material];
    vertex.shines = !vertex.from_inside || double_sided || optics.unlit != 0;
    vertex.emission = to_vector(optics.emission);
    if (scene.microfacets_count > 0) {
        vertex.roughness = scene.microfacets[vertex.material].roughness;
        vertex.metal = scene.microfacets[vertex.material].metallic;
    }
    const auto at = [&](std::uint32_t slot) {
        return texture_point(scene, nearest.primitive, vertex.point, nearest.surface, slot);
    };
    if (!has_textures(scene.textures)) {
        brush(scene, at, vertex);
        return vertex;
    }
    const MaterialTextures& textures = scene.textures.materials[vertex.material];
    vertex.picture = base_colour_at(scene, nearest.primitive, vertex.point, nearest.surface);
    vertex.is_masked_out = product_of_alphas(textures.alpha, vertex.picture.a) < Real{textures.alpha_cutoff};
    const Texel facets = sample_texture(scene, textures.metallic_roughness, at(textures.metallic_roughness.slot));
    vertex.roughness *= facets.g;
    vertex.metal *= facets.b;
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    if (scene.names##_count > 0) {                               \
        const TextureUse& use = scene.names[vertex.material];    \
        vertex.name = sample_texture(scene, use, at(use.slot));  \
    }
#include "tandem/kernel/bsdf/lobes.def"
    const Texel emission =
        optics.unlit != 0 ? vertex.picture : sample_texture(scene, textures.emission, at(textures.emission.slot));
    vertex.emission = times(vertex.emission, {emission.r, emission.g, emission.b});
    if (textures.normal.texture != no_texture) {
        const TexturePoint point = at(textures.normal.slot);
        const Texel texel = sample_texture(scene, textures.normal, point);
        const bool turned = double_sided && vertex.from_inside;
        const Vector n = vertex.normal * (turned ? -1 : 1);
        const Vector t = unit(point.along_u - n * inner(point.along_u, n));
        Vector b = cross(n, t);
        if (inner(b, point.along_v) > 0) b = b * -1;
        const Real scale = textures.normal_scale;
        const Vector bent =
            unit(t * ((2 * texel.r - 1) * scale) + b * ((2 * texel.g - 1) * scale) + n * (2 * texel.b - 1));
        vertex.normal = bent * (turned ? -1 : 1);
    }
    brush(scene, at, vertex);
    return vertex;
}

bool is_blocked(const BoundedView& scene, const Vertex& vertex, const Vector& way, Real to, std::uint32_t except) {
    const Line ray = {vertex.point, way};
    const RaySource source = {vertex.primitive, inner(way, vertex.facet) < 0};
    Passed passed;
    while (true) {
        const NearestSurface between = nearest_surface(scene, ray, source, except, &passed);
        if (between.primitive == no_primitive || between.surface.t >= to) return false;
        if (!vertex_at(scene, ray, between).is_masked_out) return true;
        passed = {between.surface.t, between.primitive};
    }
}

bool is_in_front(const Vertex& vertex, const Vector& l) {
    const Real side = vertex.from_inside ? -1 : 1;
    return inner(l, vertex.facet) * side > 0 && inner(l, vertex.normal) > 0;
}

}  // namespace tandem::oracle

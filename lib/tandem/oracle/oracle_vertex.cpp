#include "tandem/oracle/oracle_vertex.h"

namespace tandem::oracle {

NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source, std::uint32_t except,
                               const Passed* passed) {
    NearestSurface nearest;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        if (id == except) continue;
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
    if (scene.microfacet_count > 0) {
        vertex.roughness = scene.microfacets[vertex.material].roughness;
        vertex.metal = scene.microfacets[vertex.material].metallic;
    }
    if (!has_textures(scene.textures)) return vertex;
    const MaterialTextures& textures = scene.textures.materials[vertex.material];
    const auto at = [&](std::uint32_t slot) {
        return texture_point(scene, nearest.primitive, vertex.point, nearest.surface, slot);
    };
    vertex.picture = base_colour_at(scene, nearest.primitive, vertex.point, nearest.surface);
    vertex.is_masked_out = product_of_alphas(textures.alpha, vertex.picture.a) < Real{textures.alpha_cutoff};
    const Texel facets = sample_texture(scene, textures.metallic_roughness, at(textures.metallic_roughness.slot));
    vertex.roughness *= facets.g;
    vertex.metal *= facets.b;
    const Texel emission =
        optics.unlit != 0 ? vertex.picture : sample_texture(scene, textures.emission, at(textures.emission.slot));
    vertex.emission = times(vertex.emission, {emission.r, emission.g, emission.b});
    if (textures.normal.texture != no_texture) {
        const TexturePoint point = at(textures.normal.slot);
        const Texel texel = sample_texture(scene, textures.normal, point);
        const bool turned = double_sided && vertex.from_inside;
        const Vector n = vertex.normal * (turned ? -1 : 1);
        const Vector t = unit(point.along_u - n * inner(point.along_u, n));
        Vector b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
        if (inner(b, point.along_v) > 0) b = b * -1;
        const Real scale = textures.normal_scale;
        const Vector bent =
            unit(t * ((2 * texel.r - 1) * scale) + b * ((2 * texel.g - 1) * scale) + n * (2 * texel.b - 1));
        vertex.normal = bent * (turned ? -1 : 1);
    }
    return vertex;
}

bool is_blocked(const SceneView& scene, const Vertex& vertex, const Vector& way, Real to, std::uint32_t except) {
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

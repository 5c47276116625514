#include "tandem/oracle/oracle_reflection.h"

#include <cmath>

namespace tandem::oracle {

namespace {

bool is_of_facets(const SceneView& scene, const Vertex& vertex) {
    return scene.microfacets_count > 0 && scene.microfacets[vertex.material].is_there != 0;
}

Vector colour_of(const Vertex& vertex) { return {vertex.picture.r, vertex.picture.g, vertex.picture.b}; }

/// The reflectances of microfacets, on either side of the surface.
Reflectances facets_at(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Vector base = times(to_vector(material.diffuse), colour_of(vertex));
    const Real dielectric = 1 - vertex.metal;
    Reflectances facets{
        times(to_vector(material.ambient), colour_of(vertex)) * dielectric, base * dielectric, {0, 0, 0}, 1};
    const Real ior = scene.optics[vertex.material].ior;
    facets.border = std::pow((1 - ior) / (1 + ior), 2);
    facets.f0 = base * vertex.metal + Vector{1, 1, 1} * (facets.border * dielectric);
    const Real alpha = vertex.roughness * vertex.roughness, share = vertex.anisotropy * vertex.anisotropy;
    facets.alpha = std::clamp<Real>(alpha, Real(0x1p-13), 1);
    facets.alpha_along = std::clamp<Real>(alpha * (1 - share) + share, Real(0x1p-13), 1);
    facets.along = vertex.along;
    return facets;
}

/// Schlick's factor between the reflectance at normal incidence and 1, for the microfacets that mirror l to the viewer.
Real grazing(const Reflectances& material, const Vector& l) {
    return std::pow(std::max<Real>(0, 1 - inner(unit(l + material.to_viewer), l)), 5);
}

/// The angle of w around the normal n, from the direction in which the facets are rougher.
Real azimuth(const Reflectances& material, const Vector& n, const Vector& w) {
    return std::atan2(inner(cross(n, material.along), w), inner(material.along, w));
}

/// Smith's Lambda of GGX: facets that are hidden for each that is seen, from the direction w.
Real hidden(const Reflectances& material, const Vector& n, const Vector& w) {
    const Real cosine = inner(n, w), phi = azimuth(material, n, w);
    const Real tangent = std::sqrt(std::max<Real>(0, (1 - cosine) * (1 + cosine))) / cosine;
    const Real alpha = std::hypot(material.alpha_along * std::cos(phi), material.alpha * std::sin(phi));
    return (std::hypot(Real(1), alpha * tangent) - 1) / 2;
}

/// The share of facets that are seen from both the light and the viewer.
Real seen_from_both(const Reflectances& material, const Vector& n, const Vector& l) {
    return 1 / (1 + hidden(material, n, l) + hidden(material, n, material.to_viewer));
}

}  // namespace

Reflectances reflectances(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Real transmission = scene.optics[vertex.material].transmission;
    const Vector colour = colour_of(vertex);
    if (is_of_facets(scene, vertex)) {
        Reflectances facets = facets_at(scene, vertex);
        facets.to_viewer = vertex.direction * -1;
        const Real height = inner(facets.to_viewer, vertex.normal);
        facets.has_facets = true;
        facets.is_hidden = !(height > 0) && vertex.from_inside;
        if (height < 0) facets.to_viewer = facets.to_viewer - vertex.normal * (2 * height);
        return facets;
    }
    const Real highlight = transmission > 0 && vertex.from_inside ? 0 : 1;
    return {times(to_vector(material.ambient), colour) * (1 - transmission),
            times(to_vector(material.diffuse), colour) * (1 - transmission), to_vector(material.specular) * highlight,
            Real{material.shininess}};
}

Vector facets(const Reflectances& material, const Vertex& vertex, const Vector& l) {
    const Vector n = vertex.normal, v = material.to_viewer;
    const Real to_light = inner(n, l), to_viewer = inner(n, v);
    if (!material.has_facets || material.is_hidden || !(to_light > 0) || !(to_viewer > 0)) return {0, 0, 0};
    const Real cosine = std::min<Real>(1, inner(n, unit(l + v)));
    const Vector sine = unit(l + v) - n * cosine;
    const Real tangent2 = inner(sine, sine) / (cosine * cosine), phi = azimuth(material, n, sine);
    const Real slopes =
        tangent2 * (std::pow(std::cos(phi) / material.alpha_along, 2) + std::pow(std::sin(phi) / material.alpha, 2));
    const Real density =
        1 / (pi * material.alpha_along * material.alpha * std::pow(cosine, 4) * std::pow(1 + slopes, 2));
    const Real seen = seen_from_both(material, n, l);
    const Vector f = material.f0 + (Vector{1, 1, 1} - material.f0) * grazing(material, l);
    return f * (pi * density * seen / (4 * to_viewer));
}

Real uncovered(const Reflectances& material, const Vector& l) {
    return material.has_facets ? (1 - material.border) * (1 - grazing(material, l)) : 1;
}

Vector reflected(const Reflectances& material, const Vertex& vertex, const Vector& l, bool seen) {
    const Vector n = vertex.normal;
    if (material.is_hidden) return {0, 0, 0};
    if (material.has_facets) {
        const Vector base = material.diffuse * (std::max<Real>(0, inner(l, n)) * uncovered(material, l));
        return seen ? base + facets(material, vertex, l) : base;
    }
    const Vector r = n * (2 * inner(l, n)) - l;
    const Real mirror = -inner(r, vertex.direction);
    const Real specular = mirror > 0 ? std::pow(std::min<Real>(1, mirror), material.shininess) : 0;
    return material.diffuse * std::max<Real>(0, inner(l, n)) + material.specular * specular;
}

Vector reflect_at_facet(const Reflectances& material, const Vertex& vertex, Vector& onward, Chance& chance) {
    const Vector n = vertex.normal, v = material.to_viewer;
    const Vector side = std::abs(n.x) < Real(0.5) ? Vector{1, 0, 0} : Vector{0, 1, 0};
    const bool brushed = inner(material.along, material.along) > 0;
    const Vector t = brushed ? material.along : unit(side - n * inner(side, n));
    const Vector b = cross(n, t);
    const Real u = chance(), angle = 2 * pi * chance();
    const Real slope = std::sqrt(u / (1 - u));
    const Vector h =
        unit(t * (material.alpha_along * slope * std::cos(angle)) + b * (material.alpha * slope * std::sin(angle)) + n);
    onward = unit(h * (2 * inner(v, h)) - v);
    const Real to_light = inner(n, onward), to_viewer = inner(n, v);
    if (!(inner(v, h) > 0) || !(to_light > 0) || !(to_viewer > 0)) return {0, 0, 0};
    const Vector f = material.f0 + (Vector{1, 1, 1} - material.f0) * grazing(material, onward);
    const Real seen = seen_from_both(material, n, onward);
    return f * (seen * inner(v, h) / (to_viewer * inner(n, h)));
}

Vector albedo_of(const SceneView& scene, const Vertex& vertex) {
    const Optics& optics = scene.optics[vertex.material];
    const Real t = optics.transmission;
    const bool facets = is_of_facets(scene, vertex);
    const Reflectances material = facets ? facets_at(scene, vertex) : reflectances(scene, vertex);
    const Vector diffuse = material.diffuse * (facets ? 1 - t : Real(1));
    const Vector specular = facets ? material.f0 : to_vector(scene.materials[vertex.material].specular);
    const Vector sum = diffuse + specular + to_vector(optics.mirror) + Vector{t, t, t};
    return {std::min<Real>(sum.x, 1), std::min<Real>(sum.y, 1), std::min<Real>(sum.z, 1)};
}

}  // namespace tandem::oracle

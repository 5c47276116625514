#include "tandem/oracle/oracle_reflection.h"

#include <cmath>

#include "tandem/kernel/bsdf/sheen_lobe.h"

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

/// The reflectance of these microfacets.
Vector fresnel(const Reflectances& material, const Vector& l) {
    return material.f0 + (Vector{1, 1, 1} * material.f90 - material.f0) * grazing(material, l);
}

/// The angle of w around the normal n, from the direction in which the facets are rougher.
Real azimuth(const Reflectances& material, const Vector& n, const Vector& w) {
    return std::atan2(inner(cross(n, material.along), w), inner(material.along, w));
}

/// Smith's Lambda of GGX: the number of hidden facets per visible one, from the direction w.
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

/// Lambda of the fibres, at the angle whose cosine is given: the fit of Conty and Kulla, mirrored at 1/2.
Real hidden_fibres(Real alpha, Real cosine) {
    static constexpr Real rough[] = {21.5473L, 3.82987L, 0.19823L, -1.97760L, -4.32054L};
    static constexpr Real smooth[] = {25.3245L, 3.32435L, 0.16801L, -1.27393L, -4.85967L};
    const Real share = std::pow(1 - alpha, 2);
    Real p[5];
    for (int i = 0; i < 5; ++i) p[i] = rough[i] * (1 - share) + smooth[i] * share;
    const auto exponent = [&](Real x) { return p[0] / (1 + p[1] * std::pow(x, p[2])) + p[3] * x + p[4]; };
    const Real half = 1 / Real(2);
    return cosine < half ? std::exp(exponent(cosine)) : std::exp(2 * exponent(half)) / std::exp(exponent(1 - cosine));
}

/// The Charlie lobe, computed from angles, times pi. `least`: the lower limit of the cosines.
Real fibres(Real alpha, Real least, const Vector& n, const Vector& v, const Vector& l) {
    const Vector h = unit(l + v), across = h - n * inner(n, h);
    const Real sine = std::sqrt(inner(across, across));
    const Real density = (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * pi);
    const Real cos_o = std::clamp<Real>(inner(n, v), least, 1), cos_i = std::clamp<Real>(inner(n, l), least, 1);
    const Real seen = 1 + hidden_fibres(alpha, cos_o) + hidden_fibres(alpha, cos_i);
    return pi * density / (4 * seen * cos_o * cos_i);
}

/// Adds the sheen, and reduces the rest to the light that it leaves. The limits and the fitted albedo are part of the
/// model.
void cover_with_fibres(const SceneView& scene, const Vertex& vertex, Reflectances& material) {
    const Sheen& sheen = scene.sheens[vertex.material];
    if (sheen.is_there == 0) return;
    const Texel& texel = vertex.sheen_colour_texture;
    const Vector colour = times(to_vector(sheen.colour), {texel.r, texel.g, texel.b});
    const Real roughness = Real{sheen.roughness} * vertex.sheen_roughness_texture.a;
    const SheenLobe<double> fit{{}, static_cast<double>(roughness)};
    const Real albedo = fit.white_albedo(static_cast<double>(std::abs(inner(vertex.direction, vertex.normal))));
    const Real rest = std::max<Real>(0, 1 - largest(colour) * albedo);
    for (Vector* part : {&material.ambient, &material.diffuse, &material.specular, &material.f0}) *part = *part * rest;
    material.f90 = rest;
    const Real alpha = std::pow(std::max<Real>(roughness, Real{fit.least_roughness}), 2), least = fit.least_cosine;
    material.broad.push_back(
        {colour, [=, hidden = material.is_hidden, n = vertex.normal, v = material.to_viewer](const Vector& l) {
             return hidden ? Vector{0, 0, 0} : colour * fibres(alpha, least, n, v, l);
         }});
}

/// The share of light from l that passes the interface to the diffuse base and back to the viewer.
Real uncovered(const Reflectances& material, const Vector& l) {
    return material.has_facets ? (1 - material.border) * (1 - grazing(material, l)) : 1;
}

}  // namespace

Reflectances reflectances(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Real transmission = scene.optics[vertex.material].transmission;
    const Vector colour = colour_of(vertex);
    const Real highlight = transmission > 0 && vertex.from_inside ? 0 : 1;
    Reflectances result{times(to_vector(material.ambient), colour) * (1 - transmission),
                        times(to_vector(material.diffuse), colour) * (1 - transmission),
                        to_vector(material.specular) * highlight, Real{material.shininess}};
    if (is_of_facets(scene, vertex)) {
        result = facets_at(scene, vertex);
        result.has_facets = true;
    }
    result.to_viewer = vertex.direction * -1;
    const Real height = inner(result.to_viewer, vertex.normal);
    result.is_hidden = !(height > 0) && vertex.from_inside;
    if (height < 0) result.to_viewer = result.to_viewer - vertex.normal * (2 * height);
    if (scene.sheens_count > 0) cover_with_fibres(scene, vertex, result);
    return result;
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
    const Vector f = fresnel(material, l);
    return f * (pi * density * seen / (4 * to_viewer));
}

Vector scattered(const Reflectances& material, const Vector& l) {
    Vector sum = material.diffuse * uncovered(material, l);
    for (const BroadLobe& lobe : material.broad) sum = sum + lobe.value(l);
    return sum;
}

Real most_scattered(const Reflectances& material) {
    Real most = largest(material.diffuse);
    for (const BroadLobe& lobe : material.broad) most += largest(lobe.colour);
    return most;
}

Vector reflected(const Reflectances& material, const Vertex& vertex, const Vector& l, bool seen) {
    const Vector n = vertex.normal;
    if (material.has_facets && material.is_hidden) return {0, 0, 0};
    const Real cosine = inner(l, n);
    const Vector base = cosine > 0 ? scattered(material, l) * cosine : Vector{0, 0, 0};
    if (material.has_facets) {
        return seen ? base + facets(material, vertex, l) : base;
    }
    const Vector r = n * (2 * inner(l, n)) - l;
    const Real mirror = -inner(r, vertex.direction);
    const Real specular = mirror > 0 ? std::pow(std::min<Real>(1, mirror), material.shininess) : 0;
    return base + material.specular * specular;
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
    const Vector f = fresnel(material, onward);
    const Real seen = seen_from_both(material, n, onward);
    return f * (seen * inner(v, h) / (to_viewer * inner(n, h)));
}

Vector albedo_of(const SceneView& scene, const Vertex& vertex) {
    const Optics& optics = scene.optics[vertex.material];
    const Real t = optics.transmission;
    const Reflectances material = reflectances(scene, vertex);
    const Vector specular = material.has_facets ? material.f0 : material.specular;
    Vector sum = material.diffuse + specular + to_vector(optics.mirror) + Vector{t, t, t};
    for (const BroadLobe& lobe : material.broad) sum = sum + lobe.colour;
    return {std::min<Real>(sum.x, 1), std::min<Real>(sum.y, 1), std::min<Real>(sum.z, 1)};
}

}  // namespace tandem::oracle

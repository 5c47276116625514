/// Reflection by the formulas of the papers: Phong, and GGX and the sheen of cloth by angles.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "tandem/oracle/oracle_chance.h"
#include "tandem/oracle/oracle_vertex.h"

namespace tandem::oracle {

inline Real largest(const Vector& a) { return std::max({a.x, a.y, a.z}); }

/// A diffuse lobe over the base of a surface.
struct BroadLobe {
    Vector colour;
    std::function<Vector(const Vector& l)> value;  ///< pi f for light from l, above the surface
};

/// Phong's reflectances at a vertex; or those of microfacets, which have no specular one.
struct Reflectances {
    Vector ambient, diffuse, specular;
    Real shininess;
    bool has_facets = false;
    bool is_hidden = false;  ///< microfacets and fibres on the back of a single-sided surface reflect no light source
    Vector f0{0, 0, 0};      ///< of microfacets: reflectance at normal incidence
    Real f90 = 1;            ///< the same at grazing angles
    Real border = 0;         ///< the same of the layer over the diffuse base
    Real alpha = 0;          ///< of GGX: the least of all directions
    Real alpha_along = 0;    ///< the most, in the direction `along`, which is 0 where both are equal
    Vector along{0, 0, 0};
    std::vector<BroadLobe> broad{};  ///< beside the diffuse base
    Vector to_viewer{};              ///< on the side of the normal for shading
};

/// The reflectances at a vertex.
[[nodiscard]] Reflectances reflectances(const SceneView& scene, const Vertex& vertex);

/// GGX by angles, as Walter and others write it; times pi and the cosine of the light.
[[nodiscard]] Vector facets(const Reflectances& material, const Vertex& vertex, const Vector& l);

/// pi f of the diffuse lobes for light from l, on the side of the normal: the base, through what covers it, and others.
[[nodiscard]] Vector scattered(const Reflectances& material, const Vector& l);

/// The largest channel of their colours.
[[nodiscard]] Real most_scattered(const Reflectances& material);

/// Whether microfacets receive area lights by sampling points on them. Otherwise paths find the lights.
inline bool samples_lights(const Reflectances& material) { return material.alpha > Real(0.3); }

/// The reflection of light of unit intensity from the direction l: by the paper's formula, or by microfacets if `seen`.
[[nodiscard]] Vector reflected(const Reflectances& material, const Vertex& vertex, const Vector& l, bool seen = true);

/// Mirrors the path at a GGX normal that is sampled with the density D cos; returns the weight, empty if the path ends.
[[nodiscard]] Vector reflect_at_facet(const Reflectances& material, const Vertex& vertex, Vector& onward,
                                      Chance& chance);

/// The albedo: everything that a surface reflects and transmits.
[[nodiscard]] Vector albedo_of(const SceneView& scene, const Vertex& vertex);

}  // namespace tandem::oracle

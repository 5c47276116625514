#include "tandem/gltf/optics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tandem/gltf/materials.h"
#include "tandem/math/accurate_functions.h"

namespace tandem::gltf {

namespace {

/// The absorption coefficient (Beer's law) of a channel whose light is reduced to `colour` after `distance` metres.
float absorption(float colour, double distance) {
    const double kept = std::fmax(double{colour}, 1e-30);  // black must stay finite
    return static_cast<float>(-accurate_log(kept) / distance);
}

}  // namespace

Optics read_optics(const Json& material, const std::string& path, ImportReport& report) {
    Optics optics;
    const auto where = [&](const char* extension) { return path + ".extensions." + extension; };
    if (const Json* phong = find_extension(material, "TANDEM_materials_phong")) {
        optics.mirror = read_colour(*phong, "mirror", optics.mirror);
    }
    // Refraction, transmission and absorption
    if (const Json* ior = find_extension(material, "KHR_materials_ior")) {
        optics.ior = ior->value("ior", optics.ior);
        if (optics.ior == 0) {
            optics.ior = 1e3F;
            report.add(Treatment::approximated, "KHR_materials_ior", where("KHR_materials_ior"),
                       "an index of 0 means infinity; Tandem uses 1000");
        } else {
            report.add(Treatment::rendered, "KHR_materials_ior", where("KHR_materials_ior"),
                       "the refractive index of dielectrics, and of the dielectric part of metallic-roughness");
        }
    }
    const Json* volume = find_extension(material, "KHR_materials_volume");
    const double thickness = volume == nullptr ? 0 : volume->value("thicknessFactor", 0.0);
    if (const Json* transmission = find_extension(material, "KHR_materials_transmission")) {
        optics.transmission = transmission->value("transmissionFactor", 0.0F);
        const bool is_thin = optics.transmission > 0 && !(thickness > 0);
        report.add(is_thin ? Treatment::approximated : Treatment::rendered, "KHR_materials_transmission",
                   where("KHR_materials_transmission"),
                   is_thin ? "without a thickness in KHR_materials_volume it means a thin wall; Tandem renders a solid "
                             "dielectric"
                   : optics.transmission > 0 ? "a dielectric"
                                             : "its factor is 0, so no light is transmitted");
    }
    if (volume != nullptr) {
        const Vec3f colour = read_colour(*volume, "attenuationColor", {1, 1, 1});
        if (const Json* distance = find(*volume, "attenuationDistance")) {
            const auto metres = distance->get<double>();
            optics.absorption = {absorption(colour.x, metres), absorption(colour.y, metres),
                                 absorption(colour.z, metres)};
        }
        const bool is_glass = optics.transmission > 0;
        report.add(is_glass ? Treatment::rendered : Treatment::ignored, "KHR_materials_volume",
                   where("KHR_materials_volume"),
                   is_glass ? "absorption along the path; the thickness is that of the shape"
                            : "the material transmits no light that could be absorbed");
    }
    // Emission
    if (find(material, "emissiveFactor") != nullptr) {
        const Json* strength = find_extension(material, "KHR_materials_emissive_strength");
        const float factor = strength == nullptr ? 1.0F : strength->value("emissiveStrength", 1.0F);
        const Vec3f emission = read_colour(material, "emissiveFactor", {0, 0, 0}) * factor;
        constexpr float largest = std::numeric_limits<float>::max();
        optics.emission = {std::min(emission.x, largest), std::min(emission.y, largest), std::min(emission.z, largest)};
        if (optics.emission != emission) {
            report.add(Treatment::approximated, "emission", path + ".emissiveFactor",
                       "times the emissiveStrength it is above 3.4e38; Tandem uses that limit");
        }
        if (optics.emission != Vec3f{0, 0, 0}) {
            report.add(Treatment::rendered, "emission", path + ".emissiveFactor",
                       "the surface emits light and is an area light");
        }
    }
    if (find_extension(material, "KHR_materials_emissive_strength") != nullptr) {
        const bool emits = optics.emission != Vec3f{0, 0, 0};
        report.add(emits ? Treatment::rendered : Treatment::ignored, "KHR_materials_emissive_strength",
                   where("KHR_materials_emissive_strength"),
                   emits ? "a factor of the emission" : "the surface emits no light");
    }
    // Priority
    if (const Json* dielectric = find_extension(material, "TANDEM_materials_dielectric")) {
        optics.priority = dielectric->value("priority", 0U);
        report.add(Treatment::rendered, "TANDEM_materials_dielectric", where("TANDEM_materials_dielectric"),
                   "which dielectric fills the space where several overlap");
    }
    return optics;
}

}  // namespace tandem::gltf

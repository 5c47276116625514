#include "tandem/gltf/materials.h"

#include "tandem/gltf/optics.h"

#include <fmt/format.h>

namespace tandem::gltf {

namespace {

constexpr const char* unlit_name = "KHR_materials_unlit";
constexpr const char* anisotropy_name = "KHR_materials_anisotropy";
constexpr const char* sheen_name = "KHR_materials_sheen";

/// A diffuse surface of that colour with the highlight of a dielectric of index 1.5, which reflects 4 % at normal
/// incidence: approximates the opaque part of dielectrics, and microfacets that are not simulated.
PhongMaterial phong_from_base_colour(const Vec3f& base_colour) {
    return {base_colour * 0.1F, base_colour, {0.04F, 0.04F, 0.04F}, 32};
}

/// Notes the metallic-roughness properties that are not used.
void note_unused_factors(const Json& pbr, const std::string& path, const char* reason, ImportReport& report) {
    for (const auto& [member, feature] :
         {std::pair{"metallicRoughnessTexture", "metallic-roughness texture"},
          std::pair{"metallicFactor", "metallicFactor"}, std::pair{"roughnessFactor", "roughnessFactor"}}) {
        if (find(pbr, member) == nullptr) continue;
        report.add(Treatment::ignored, feature, fmt::format("{}.pbrMetallicRoughness.{}", path, member), reason);
    }
}

/// `material`: as far as it has been read.
void read_metallic_roughness(const Json* pbr, const std::string& path, Material& material, ImportReport& report) {
    const Vec3f white = {1, 1, 1};
    material.phong = phong_from_base_colour(pbr == nullptr ? white : read_colour(*pbr, "baseColorFactor", white));
    const bool is_glass = material.optics.transmission > 0;
    if (is_glass || material.unlit) {
        if (pbr != nullptr) {
            note_unused_factors(*pbr, path,
                                is_glass ? "dielectrics have smooth surfaces" : "an unlit material reflects no light",
                                report);
        }
        if (material.unlit) return;
        report.add(Treatment::approximated, "metallic-roughness material", path,
                   "a dielectric; the part that is not transmitted is Phong's model with the base colour");
        return;
    }
    const Microfacets absent;
    material.microfacets = pbr == nullptr ? absent
                                          : Microfacets{pbr->value("metallicFactor", absent.metallic),
                                                        pbr->value("roughnessFactor", absent.roughness)};
    report.add(Treatment::rendered, "metallic-roughness material", path, "reflection from GGX microfacets");
}

/// `material`: with the rest of what is read of it.
void read_anisotropy(const Json& read, const std::string& path, Material& material, ImportReport& report) {
    const Json* anisotropy = find_extension(read, anisotropy_name);
    if (anisotropy == nullptr) return;
    const std::string where = fmt::format("{}.extensions.{}", path, anisotropy_name);
    if (!material.microfacets) {
        report.add(Treatment::ignored, anisotropy_name, where, "the material has no microfacets");
        return;
    }
    material.microfacets->anisotropy = anisotropy->value("anisotropyStrength", 0.0F);
    material.microfacets->rotation = anisotropy->value("anisotropyRotation", 0.0F);
    report.add(Treatment::rendered, anisotropy_name, where,
               is_anisotropic(material) ? "the tangent is where u of the texture coordinates grows"
                                        : "its strength is 0, so the reflection is as without it");
}

/// `material`: with the rest of what is read of it.
void read_sheen(const Json& read, const std::string& path, Material& material, ImportReport& report) {
    const Json* sheen = find_extension(read, sheen_name);
    if (sheen == nullptr) return;
    const std::string where = fmt::format("{}.extensions.{}", path, sheen_name);
    const bool is_clear = material.optics.transmission > 0 || norm1(material.optics.mirror) > 0;
    if (material.unlit || is_clear) {
        report.add(Treatment::ignored, sheen_name, where,
                   is_clear ? "mirrors and dielectrics have none" : "an unlit material reflects no light");
        return;
    }
    const Sheen read_sheen = {read_colour(*sheen, "sheenColorFactor", {0, 0, 0}),
                              sheen->value("sheenRoughnessFactor", 0.0F)};
    const bool shows = norm1(read_sheen.colour) > 0;
    if (shows) material.sheen = read_sheen;
    report.add(Treatment::rendered, sheen_name, where, shows ? "a layer of fibres" : "its colour is black: no sheen");
}

}  // namespace

Vec3f read_colour(const Json& object, const char* member, const Vec3f& absent) {
    const Json* found = find(object, member);
    if (found == nullptr) return absent;
    return {(*found)[0].get<float>(), (*found)[1].get<float>(), (*found)[2].get<float>()};
}

std::vector<Material> read_materials(const Source& source, ImportReport& report) {
    std::vector<Material> materials;
    const Json* described = find(source.document.json, "materials");
    constexpr std::size_t most_materials = 100'000;
    if (described != nullptr && described->size() > most_materials) {
        source.document.refuse("materials",
                               fmt::format("has {} elements, but Tandem reads at most {}; leave out those that nothing "
                                           "uses",
                                           described->size(), most_materials));
    }
    for (std::size_t i = 0; described != nullptr && i < described->size(); ++i) {
        const Json& read = (*described)[i];
        const std::string path = fmt::format("materials[{}]", i);
        Material material{read.value("name", std::string()), {}};
        material.optics = read_optics(read, path, report);
        const Json* phong = find_extension(read, "TANDEM_materials_phong");
        const Json* pbr = find(read, "pbrMetallicRoughness");
        material.unlit = find_extension(read, unlit_name) != nullptr;
        if (phong != nullptr && !material.unlit) {
            const PhongMaterial absent;
            material.phong = {
                read_colour(*phong, "ambient", absent.ambient), read_colour(*phong, "diffuse", absent.diffuse),
                read_colour(*phong, "specular", absent.specular), phong->value("shininess", absent.shininess)};
            report.add(Treatment::rendered, "TANDEM_materials_phong", path + ".extensions.TANDEM_materials_phong",
                       "Phong's model");
            if (pbr != nullptr) note_unused_factors(*pbr, path, "TANDEM_materials_phong replaces them", report);
        } else {
            read_metallic_roughness(pbr, path, material, report);
        }
        read_anisotropy(read, path, material, report);
        read_sheen(read, path, material, report);
        // dielectrics need their far side, and Phong's model has ambient light for backs
        if (!(material.optics.transmission > 0) && phong == nullptr) material.sides = FaceSides::culled;
        if (material.unlit) {
            report.add(Treatment::rendered, unlit_name, fmt::format("{}.extensions.{}", path, unlit_name),
                       "the base colour is shown as it is; the surface neither receives nor emits light");
        }
        if (read.value("doubleSided", false)) {
            material.sides = FaceSides::double_sided;
            report.add(Treatment::rendered, "doubleSided", path + ".doubleSided",
                       "faces of meshes are shaded on both sides; closed shapes have one side");
        }
        materials.push_back(std::move(material));
    }
    return materials;
}

Material default_material() { return {"default", phong_from_base_colour({1, 1, 1}), FaceSides::culled}; }

}  // namespace tandem::gltf

#include "tandem/gltf/extensions.h"

#include <algorithm>
#include <array>

namespace tandem::gltf {

namespace {

constexpr std::string_view rendered[] = {
    "EXT_implicit_geometry",       "EXT_mesh_gpu_instancing",
    "KHR_implicit_shapes",         "KHR_lights_punctual",
    "KHR_materials_anisotropy",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",           "KHR_materials_sheen",
    "KHR_materials_transmission",  "KHR_materials_unlit",
    "KHR_materials_volume",        "KHR_mesh_quantization",
    "KHR_texture_transform",       "TANDEM_camera_lens",
    "TANDEM_camera_shutter",       "TANDEM_display",
    "TANDEM_environment",          "TANDEM_lights_phong",
    "TANDEM_materials_dielectric", "TANDEM_materials_phong",
};

struct Reason {
    std::string_view prefix;  ///< of the extension's name
    std::string_view reason;
};

constexpr std::string_view for_triangles = "Tandem does not read this form of triangle meshes";
constexpr std::string_view for_textures = "Tandem reads textures in PNG and JPEG only";
constexpr std::string_view for_animation = "Tandem animates translation, rotation and scale of nodes only";

constexpr std::array<Reason, 14> reasons = {{
    {"KHR_draco_mesh_compression", for_triangles},
    {"KHR_mesh_", for_triangles},
    {"EXT_mesh_", for_triangles},
    {"EXT_meshopt_", for_triangles},
    {"KHR_meshopt_", for_triangles},
    {"KHR_materials_variants", "materials stay as the primitives name them"},
    {"KHR_materials_",
     "Tandem renders base colour, metal and roughness, anisotropy, sheen, dielectrics and emission only"},
    {"KHR_texture_", for_textures},
    {"EXT_texture_", for_textures},
    {"MSFT_texture_", for_textures},
    {"KHR_animation_pointer", for_animation},
    {"KHR_physics_", "Tandem does not simulate motion"},
    {"KHR_xmp", "it does not affect the image"},
    {"EXT_lights_image_based", "the background is the gradient of TANDEM_environment"},
}};

}  // namespace

bool is_rendered_extension(std::string_view name) {
    return std::find(std::begin(rendered), std::end(rendered), name) != std::end(rendered);
}

std::string why_ignored(std::string_view name) {
    const auto found =
        std::find_if(reasons.begin(), reasons.end(), [&](const Reason& r) { return name.starts_with(r.prefix); });
    return std::string(found == reasons.end() ? "Tandem does not support it" : found->reason);
}

}  // namespace tandem::gltf

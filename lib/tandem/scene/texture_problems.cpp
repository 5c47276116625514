#include "tandem/scene/texture_problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tandem/scene/corner_slots.h"

namespace tandem {

namespace {

constexpr std::uint32_t most_edge = 16384;

std::string label(const char* kind, const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} '{}'", kind, name);
}

class Finder {
  public:
    explicit Finder(const Scene& scene) : scene_(scene) {}

    std::vector<std::string> run() {
        for (std::size_t i = 0; i < scene_.images.size(); ++i) check_image(i);
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            require(scene_.textures[i].image < scene_.images.size(), fmt::format("texture {}", i),
                    "shows an image that does not exist");
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) check_material(i);
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) check_node(i);
        return std::move(found_);
    }

  private:
    void require(bool condition, const std::string& where, const char* what) {
        if (!condition) found_.push_back(where + " " + what);
    }

    void check_image(std::size_t index) {
        const Image& image = scene_.images[index];
        const std::string where = label("image", image.name, index);
        const bool good =
            image.width >= 1 && image.width <= most_edge && image.height >= 1 && image.height <= most_edge;
        require(good, where, "has a width or height that is not from 1 to 16384");
        require(!good || image.texels.size() == std::size_t{image.width} * image.height, where,
                "does not have width times height texels");
    }

    void check_material(std::size_t index) {
        const Material& material = scene_.materials[index];
        const std::string where = label("material", material.name, index);
        if (material.diffuse_texture) check_reference(*material.diffuse_texture, where + ", diffuse texture,");
        if (material.normal_texture) check_reference(*material.normal_texture, where + ", normal texture,");
        if (material.emissive_texture) check_reference(*material.emissive_texture, where + ", emissive texture,");
        if (material.metallic_roughness_texture)
            check_reference(*material.metallic_roughness_texture, where + ", metallic-roughness texture,");
        if (material.anisotropy_texture) check_reference(*material.anisotropy_texture, where + ", anisotropy texture,");
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    if (material.name) check_reference(*material.name, where + ", " is ",");
#include "tandem/kernel/bsdf/lobes.def"
        require(std::isfinite(material.normal_scale), where, "has a normal scale that is not finite");
        require(material.alpha >= 0 && material.alpha <= 1, where, "has an alpha outside [0, 1]");
        require(material.alpha_cutoff >= 0 && std::isfinite(material.alpha_cutoff), where,
                "has an alpha cutoff that is not a finite number >= 0");
    }

    void check_reference(const TextureReference& reference, const std::string& where) {
        require(reference.texture < scene_.textures.size(), where, "uses a texture that does not exist");
        const float limit = 1e18F;
        const auto good = [&](float a) { return std::abs(a) <= limit; };
        require(good(reference.offset.x) && good(reference.offset.y) && good(reference.scale.x) &&
                    good(reference.scale.y) && good(reference.rotation),
                where, "has an offset, a rotation or a scale that is not finite or beyond 1e18");
    }

    /// Meshes need the texture coordinates that their materials use; other shapes have their own.
    void check_node(std::size_t index) {
        const Node& node = scene_.nodes[index];
        for (const Geometry& geometry : node.geometry) {
            const auto* shape = std::get_if<MeshShape>(&geometry.shape);
            if (shape == nullptr || shape->mesh >= scene_.meshes.size()) continue;
            if (geometry.material >= scene_.materials.size()) continue;
            const Material& material = scene_.materials[geometry.material];
            const Mesh& mesh = scene_.meshes[shape->mesh];
            const std::vector<std::uint32_t> sets = texcoord_sets(material);
            const auto lacks = [&](std::uint32_t set) {
                return set >= mesh.texcoords.size() || mesh.texcoords[set].empty();
            };
            const auto lacking = std::find_if(sets.begin(), sets.end(), lacks);
            if (lacking == sets.end() || mesh.positions.empty()) continue;
            if (!reported_.insert({shape->mesh, geometry.material}).second) continue;
            found_.push_back(fmt::format(
                "{} shows a mesh without set {} of texture coordinates under the textures of {}",
                label("node", node.name, index), *lacking, label("material", material.name, geometry.material)));
        }
    }

    const Scene& scene_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> reported_;  ///< mesh and material
    std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> find_texture_problems(const Scene& scene) { return Finder(scene).run(); }

}  // namespace tandem

#include "tandem/gltf/textures.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "tandem/gltf/images.h"
#include "tandem/gltf/triangles.h"

namespace tandem::gltf {

namespace {

constexpr const char* transform_name = "KHR_texture_transform";

/// Of all images of a file: 1 GiB of memory.
constexpr std::size_t most_texels = std::size_t{1} << 28;

Wrap wrap_mode(std::uint64_t mode) {
    if (mode == 33071) return Wrap::clamp_to_edge;
    return mode == 33648 ? Wrap::mirrored_repeat : Wrap::repeat;
}

Vec2f read_vec2(const Json& object, const char* member, const Vec2f& absent) {
    const Json* found = find(object, member);
    return found == nullptr ? absent : Vec2f{(*found)[0].get<float>(), (*found)[1].get<float>()};
}

class TextureReader {
  public:
    TextureReader(const Source& source, Scene& scene, ImportReport& report)
        : source_(source), json_(source.document.json), scene_(scene), report_(report) {}

    void run() {
        const std::size_t count = source_.document.length("materials");
        for (std::size_t i = 0; i < count; ++i) read_material(i);
        note_unused("images", "image", image_of_);
        note_unused("textures", "texture", texture_of_);
        note_unused("samplers", "texture sampler", samplers_);
    }

  private:
    using Indices = std::map<std::size_t, std::uint32_t>;  ///< from the file's to the scene's

    void read_material(std::size_t index) {
        const Json& read = json_["materials"][index];
        Material& material = scene_.materials[index];
        const std::string path = fmt::format("materials[{}]", index);
        if (const Json* pbr = find(read, "pbrMetallicRoughness")) {
            const std::string pbr_path = path + ".pbrMetallicRoughness";
            if (const Json* factor = find(*pbr, "baseColorFactor")) material.alpha = (*factor)[3].get<float>();
            if (const Json* info = find(*pbr, "baseColorTexture")) {
                material.diffuse_texture = read_use(*info, pbr_path + ".baseColorTexture", "base colour texture",
                                                    "sRGB; multiplies the diffuse and the ambient reflectance");
            }
        }
        if (const Json* info = find(read, "normalTexture")) {
            material.normal_texture = read_use(*info, path + ".normalTexture", "normal texture",
                                               "linear; in the frame of the texture coordinates");
            material.normal_scale = info->value("scale", 1.0F);
        }
        if (const Json* info = find(read, "emissiveTexture")) {
            if (norm1(material.optics.emission) > 0) {
                material.emissive_texture =
                    read_use(*info, path + ".emissiveTexture", "emissive texture", "sRGB; multiplies the emission");
            } else {
                report_.add(Treatment::ignored, "emissive texture", path + ".emissiveTexture",
                            "the emissiveFactor that multiplies it is 0");
            }
        }
        read_alpha(read, path, material);
    }

    void read_alpha(const Json& read, const std::string& path, Material& material) {
        const auto mode = read.value("alphaMode", std::string("OPAQUE"));
        const Json* cutoff = find(read, "alphaCutoff");
        if (mode != "OPAQUE") material.alpha_mode = AlphaMode::mask;
        if (mode == "MASK") {
            if (cutoff != nullptr) material.alpha_cutoff = cutoff->get<float>();
            report_.add(Treatment::rendered, "alphaMode MASK", path + ".alphaMode",
                        "there is no surface where alpha is below alphaCutoff");
        } else if (mode == "BLEND") {
            report_.add(Treatment::approximated, "alphaMode BLEND", path + ".alphaMode",
                        "surfaces do not blend; there is none where alpha is below 0.5");
        }
        if (cutoff != nullptr && mode != "MASK") {
            report_.add(Treatment::ignored, "alphaCutoff", path + ".alphaCutoff", "alphaMode is not MASK");
        }
    }

    std::optional<TextureReference> read_use(const Json& info, const std::string& path, const char* feature,
                                             const char* reason) {
        const Json* transform = find_extension(info, transform_name);
        std::uint64_t texcoord = info.value("texCoord", std::uint64_t{0});
        if (transform != nullptr) texcoord = transform->value("texCoord", texcoord);
        if (texcoord > last_texcoord) {
            report_.add(Treatment::ignored, feature, path,
                        fmt::format("it lies at TEXCOORD_{}; Tandem reads up to TEXCOORD_{}", texcoord, last_texcoord));
            return std::nullopt;
        }
        const auto index = info["index"].get<std::size_t>();
        const Json* image = find(json_["textures"][index], "source");
        if (image == nullptr) {
            report_.add(Treatment::ignored, feature, path, "its texture has no image in PNG or JPEG");
            return std::nullopt;
        }
        TextureReference use;
        use.texture = texture(index, image->get<std::size_t>());
        use.texcoord = static_cast<std::uint32_t>(texcoord);
        report_.add(Treatment::rendered, feature, path, reason);
        if (transform != nullptr) {
            use.offset = read_vec2(*transform, "offset", use.offset);
            use.rotation = transform->value("rotation", use.rotation);
            use.scale = read_vec2(*transform, "scale", use.scale);
            report_.add(Treatment::rendered, transform_name, fmt::format("{}.extensions.{}", path, transform_name),
                        "texture coordinates are scaled, turned and moved");
        }
        return use;
    }

    std::uint32_t texture(std::size_t index, std::size_t image) {
        const auto [known, is_new] = texture_of_.try_emplace(index, static_cast<std::uint32_t>(scene_.textures.size()));
        if (is_new) {
            Texture texture;
            texture.image = this->image(image);
            if (const Json* sampler = find(json_["textures"][index], "sampler")) {
                read_sampler(sampler->get<std::size_t>(), texture);
            }
            scene_.textures.push_back(texture);
        }
        return known->second;
    }

    void read_sampler(std::size_t index, Texture& texture) {
        const Json& sampler = json_["samplers"][index];
        constexpr std::uint64_t nearest = 9728, linear = 9729, repeat = 10497;
        const auto filter = sampler.value("magFilter", linear);
        texture.filter = filter == nearest ? Filter::nearest : Filter::linear;
        texture.wrap_s = wrap_mode(sampler.value("wrapS", repeat));
        texture.wrap_t = wrap_mode(sampler.value("wrapT", repeat));
        if (!samplers_.try_emplace(index, 0).second) return;
        const bool same = sampler.value("minFilter", filter) == filter;
        report_.add(same ? Treatment::rendered : Treatment::approximated, "texture sampler",
                    fmt::format("samplers[{}]", index),
                    same ? "its filter and wrap modes" : "there are no mipmaps; magFilter counts at any distance");
    }

    std::uint32_t image(std::size_t index) {
        const auto [known, is_new] = image_of_.try_emplace(index, static_cast<std::uint32_t>(scene_.images.size()));
        if (is_new) {
            const std::string path = fmt::format("images[{}]", index);
            scene_.images.push_back(read_image(source_, index));
            texels_ += scene_.images.back().texels.size();
            if (texels_ > most_texels) {
                source_.document.fail(path, "brings the images to more than 2^28 texels; make them smaller");
            }
            report_.add(Treatment::rendered, "image", path, "as 8 bits a channel");
        }
        return known->second;
    }

    void note_unused(const char* array, const char* feature, const Indices& used) {
        for (std::size_t i = 0; i < source_.document.length(array); ++i) {
            if (used.contains(i)) continue;
            report_.add(Treatment::ignored, feature, fmt::format("{}[{}]", array, i),
                        "no texture that Tandem renders uses it");
        }
    }

    const Source& source_;
    const Json& json_;
    Scene& scene_;
    ImportReport& report_;
    Indices image_of_, texture_of_, samplers_;
    std::size_t texels_ = 0;
};

}  // namespace

void read_textures(const Source& source, Scene& scene, ImportReport& report) {
    TextureReader(source, scene, report).run();
}

}  // namespace tandem::gltf

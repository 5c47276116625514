#include "tandem/gltf/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/gltf/images.h"
#include "tandem/gltf/triangles.h"

namespace tandem::gltf {

namespace {

constexpr const char* transform_name = "KHR_texture_transform";

/// Texel limits for all images of a file: 1 GiB of memory; for a small file 128 MiB, or 16 texels for each of its
/// bytes.
constexpr std::size_t most_texels = std::size_t{1} << 28, small_file_texels = std::size_t{1} << 25;
constexpr std::size_t texels_per_byte = 16;
/// Limit of halvings of an edge while an image is decoded.
constexpr unsigned most_halvings = 12;

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
    TextureReader(const Source& source, Scene& scene, ImportReport& report, FlawLog& flaws)
        : source_(source),
          json_(source.document.json),
          scene_(scene),
          report_(report),
          flaws_(flaws),
          bytes_(data_bytes(source)) {}

    void run() {
        const std::size_t count = source_.document.length("materials");
        for (std::size_t i = 0; i < count; ++i) read_material(i);
        note_halved();
        note_unused("images", "image", image_of_, images_left_out_);
        note_unused("textures", "texture", texture_of_, textures_left_out_);
        note_unused("samplers", "texture sampler", samplers_, Indices{});
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
            const Json* rough = find(*pbr, "metallicRoughnessTexture");
            if (rough != nullptr && material.microfacets) {
                material.metallic_roughness_texture =
                    read_use(*rough, pbr_path + ".metallicRoughnessTexture", "metallic-roughness texture",
                             "linear; green multiplies the roughness, blue the metalness");
            }
        }
        if (const Json* info = find(read, "normalTexture")) {
            material.normal_texture = read_use(*info, path + ".normalTexture", "normal texture",
                                               "linear; in the tangent frame of the texture coordinates");
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
        read_anisotropy(read, path, material);
        read_sheen(read, path, material);
        read_alpha(read, path, material);
    }

    void read_anisotropy(const Json& read, const std::string& path, Material& material) {
        const Json* anisotropy = find_extension(read, "KHR_materials_anisotropy");
        const Json* info = anisotropy == nullptr ? nullptr : find(*anisotropy, "anisotropyTexture");
        if (info == nullptr) return;
        const std::string where = path + ".extensions.KHR_materials_anisotropy.anisotropyTexture";
        if (is_anisotropic(material)) {
            material.anisotropy_texture =
                read_use(*info, where, "anisotropy texture",
                         "linear; red and green are the direction, blue multiplies the strength");
        } else {
            report_.add(Treatment::ignored, "anisotropy texture", where, "the material is not anisotropic");
        }
    }

    void read_sheen(const Json& read, const std::string& path, Material& material) {
        const Json* sheen = find_extension(read, "KHR_materials_sheen");
        if (sheen == nullptr) return;
        const auto read_one = [&](const char* member, const char* feature, const char* reason) {
            const Json* info = find(*sheen, member);
            const std::string where = fmt::format("{}.extensions.KHR_materials_sheen.{}", path, member);
            std::optional<TextureReference> use;
            if (info != nullptr && material.sheen) {
                use = read_use(*info, where, feature, reason);
            } else if (info != nullptr) {
                report_.add(Treatment::ignored, feature, where, "the material has no sheen");
            }
            return use;
        };
        material.sheen_colour_texture =
            read_one("sheenColorTexture", "sheen colour texture", "sRGB; multiplies the colour of the sheen");
        material.sheen_roughness_texture = read_one("sheenRoughnessTexture", "sheen roughness texture",
                                                    "linear; alpha multiplies the roughness of the sheen");
    }

    void read_alpha(const Json& read, const std::string& path, Material& material) {
        const auto mode = read.value("alphaMode", std::string("OPAQUE"));
        const Json* cutoff = find(read, "alphaCutoff");
        if (mode != "OPAQUE") material.alpha_mode = AlphaMode::mask;
        if (mode == "MASK") {
            if (cutoff != nullptr) material.alpha_cutoff = cutoff->get<float>();
            report_.add(Treatment::rendered, "alphaMode MASK", path + ".alphaMode",
                        "the surface is removed where alpha is below alphaCutoff");
        } else if (mode == "BLEND") {
            report_.add(Treatment::approximated, "alphaMode BLEND", path + ".alphaMode",
                        "surfaces do not blend; they are removed where alpha is below 0.5");
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
                        fmt::format("it uses TEXCOORD_{}; Tandem reads up to TEXCOORD_{}", texcoord, last_texcoord));
            return std::nullopt;
        }
        const auto index = info["index"].get<std::size_t>();
        const Json* image = find(json_["textures"][index], "source");
        if (image == nullptr) {
            report_.add(Treatment::ignored, feature, path, "its texture has no image in PNG or JPEG");
            return std::nullopt;
        }
        TextureReference use;
        try {
            use.texture = texture(index, image->get<std::size_t>());
        } catch (const Flaw& flaw) {
            flaws_.leave_out(feature, flaw);
            return std::nullopt;
        }
        use.texcoord = static_cast<std::uint32_t>(texcoord);
        report_.add(Treatment::rendered, feature, path, reason);
        if (transform != nullptr) {
            use.offset = read_vec2(*transform, "offset", use.offset);
            use.rotation = transform->value("rotation", use.rotation);
            use.scale = read_vec2(*transform, "scale", use.scale);
            report_.add(Treatment::rendered, transform_name, fmt::format("{}.extensions.{}", path, transform_name),
                        "texture coordinates are scaled, rotated and translated");
        }
        return use;
    }

    std::uint32_t texture(std::size_t index, std::size_t image) {
        if (const auto known = texture_of_.find(index); known != texture_of_.end()) return known->second;
        Texture texture;
        try {
            texture.image = this->image(image);
        } catch (const Flaw&) {
            textures_left_out_.emplace(index, 0);
            throw;
        }
        if (const Json* sampler = find(json_["textures"][index], "sampler")) {
            read_sampler(sampler->get<std::size_t>(), texture);
        }
        scene_.textures.push_back(texture);
        return texture_of_[index] = static_cast<std::uint32_t>(scene_.textures.size() - 1);
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
                    same ? "its filter and wrap modes" : "there are no mipmaps; magFilter is used at any distance");
    }

    /// Throws a Flaw, the same one at every call.
    std::uint32_t image(std::size_t index) {
        if (const auto known = image_of_.find(index); known != image_of_.end()) return known->second;
        if (const auto known = images_left_out_.find(index); known != images_left_out_.end()) throw known->second;
        try {
            const std::uint32_t number = decode(index);
            report_.add(Treatment::rendered, "image", fmt::format("images[{}]", index), "as 8 bits a channel");
            return image_of_[index] = number;
        } catch (const Flaw& flaw) {
            images_left_out_.emplace(index, flaw);
            throw;
        }
    }

    std::uint32_t decode(std::size_t index) {
        const EncodedImage encoded = read_image(source_, index);
        const auto known = number_of_place_.find(encoded.place);
        if (known != number_of_place_.end()) return known->second;
        bytes_ += encoded.storage.size();
        work_ += encoded.size.work;
        if (work_ > decoding_limit(bytes_)) {
            source_.document.fail(
                encoded.json_path,
                fmt::format(
                    "brings the work of decoding the images to {} pixels, but a file of {} bytes may cause only "
                    "{}; make the images smaller",
                    work_, bytes_, decoding_limit(bytes_)));
        }
        const unsigned shift = make_room(encoded.size);
        Image image = decode_image(source_, index, encoded, shift);
        texels_ += image.texels.size();
        scene_.images.push_back(std::move(image));
        origins_.push_back({index, encoded.size});
        const auto number = static_cast<std::uint32_t>(scene_.images.size() - 1);
        if (!encoded.place.empty()) number_of_place_[encoded.place] = number;
        return number;
    }

    [[nodiscard]] std::size_t texel_limit() const {
        return std::clamp(texels_per_byte * bytes_, small_file_texels, most_texels);
    }

    /// Halves loaded images, always the largest, until one more fits; returns how often the new one must be halved.
    unsigned make_room(const TexelSize& size) {
        unsigned shift = 0;
        const auto wanted = [&] {
            return std::size_t{shrunk_edge(size.width, shift)} * shrunk_edge(size.height, shift);
        };
        while (texels_ + wanted() > texel_limit()) {
            const auto largest =
                std::max_element(scene_.images.begin(), scene_.images.end(),
                                 [](const Image& a, const Image& b) { return a.texels.size() < b.texels.size(); });
            if (largest == scene_.images.end() || largest->texels.size() <= wanted()) {
                if (shift == most_halvings) break;  // a few texels
                ++shift;
                continue;
            }
            texels_ -= largest->texels.size();
            halve(*largest);
            texels_ += largest->texels.size();
        }
        return shift;
    }

    void note_halved() {
        for (std::size_t i = 0; i < origins_.size(); ++i) {
            const Image& image = scene_.images[i];
            const auto& [index, size] = origins_[i];
            if (image.width == size.width && image.height == size.height) continue;
            flaws_.replace(
                "large image", fmt::format("images[{}]", index),
                fmt::format("has {} x {} texels; Tandem reduces it to {} x {}, since all images of a file of {} bytes "
                            "may have {} texels",
                            size.width, size.height, image.width, image.height, bytes_, texel_limit()));
        }
    }

    template <class LeftOut>
    void note_unused(const char* array, const char* feature, const Indices& used, const LeftOut& left_out) {
        for (std::size_t i = 0; i < source_.document.length(array); ++i) {
            if (used.contains(i) || left_out.contains(i)) continue;
            report_.add(Treatment::ignored, feature, fmt::format("{}[{}]", array, i),
                        "no texture that Tandem renders uses it");
        }
    }

    const Source& source_;
    const Json& json_;
    Scene& scene_;
    ImportReport& report_;
    FlawLog& flaws_;
    Indices image_of_, texture_of_, samplers_;
    Indices textures_left_out_;
    std::map<std::size_t, Flaw> images_left_out_;
    std::map<std::string, std::uint32_t> number_of_place_;  ///< by EncodedImage::place
    /// For each image of the scene: its first index in the file, and its size there.
    std::vector<std::pair<std::size_t, TexelSize>> origins_;
    std::size_t texels_ = 0;
    std::size_t work_ = 0;  ///< of decoding the images
    std::size_t bytes_;     ///< of the buffers and the image files that were read
};

}  // namespace

void read_textures(const Source& source, Scene& scene, ImportReport& report, FlawLog& flaws) {
    TextureReader(source, scene, report, flaws).run();
}

}  // namespace tandem::gltf

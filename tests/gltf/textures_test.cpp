// Textures from glTF files: what arrives in the scene, and what is refused.
#include <gtest/gtest.h>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image_codecs.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;
using test::sentences;
using test::TestFile;

/// A PNG of 2 x 1 pixels: (255, 0, 0) and (0, 188, 255).
std::string small_png() {
    const Bytes bytes = encode_png(ByteImage{2, 1, {255, 0, 0, 0, 188, 255}}, {}, 1);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
const std::vector<std::uint32_t> small_texels = {0xFF0000FFU, 0xFFFFBC00U};

std::string png_uri() { return "data:image/png;base64," + test::base64(small_png()); }

/// small_file() whose ball shows a picture.
TestFile textured_file(const std::string& uri = png_uri()) {
    TestFile file = test::small_file();
    file.json["images"] = {{{"name", "wall"}, {"uri", uri}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    return file;
}

class Textures : public test::GltfFiles {
  protected:
    /// The file is drawn without a picture, and says why.
    void expect_no_picture(const TestFile& file, const std::string& sentence) const {
        const ImportResult result = import_gltf(write("inside/scene.gltf", file.text()));
        EXPECT_TRUE(result.scene.images.empty());
        EXPECT_FALSE(result.scene.materials[0].diffuse_texture);
        EXPECT_EQ(result.scene.nodes[1].geometry.size(), 1U);
        EXPECT_TRUE(contains(sentences(result.report), sentence));
        for (const char* wrong :
             {"rendered: image", "rendered: base colour texture", "no texture that Tandem renders"}) {
            EXPECT_EQ(sentences(result.report).find(wrong), std::string::npos) << wrong;
        }
    }
    void expect_image_left_out(const std::string& uri, const std::string& reason) const {
        expect_no_picture(textured_file(uri), "ignored: base colour texture at images[0].uri: " + reason);
    }
};

TEST_F(Textures, ComeFromDataUris) {
    const ImportResult result = import(textured_file());
    const Scene& scene = result.scene;
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].name, "wall");
    EXPECT_EQ(scene.images[0].width, 2U);
    EXPECT_EQ(scene.images[0].texels, small_texels);
    ASSERT_EQ(scene.textures.size(), 1U);
    EXPECT_EQ(scene.textures[0].wrap_s, Wrap::repeat) << "glTF's default";
    EXPECT_EQ(scene.textures[0].filter, Filter::linear);
    ASSERT_TRUE(scene.materials[0].diffuse_texture);
    EXPECT_FALSE(scene.materials[0].normal_texture);
    const std::string all = sentences(result.report);
    EXPECT_TRUE(contains(
        all, "rendered: base colour texture at materials[0].pbrMetallicRoughness.baseColorTexture: sRGB; multiplies"));
    EXPECT_TRUE(contains(all, "rendered: image at images[0]: "));
    const TextureSet set = view(prepare(scene).textures);
    EXPECT_EQ(set.materials == nullptr, false);
}

TEST_F(Textures, ComeFromFilesAndBufferViewsAlike) {
    write("pictures/a wall.png", small_png());
    EXPECT_EQ(import(textured_file("pictures/a%20wall.png")).scene.images[0].texels, small_texels);
    TestFile file = textured_file();
    const std::size_t accessor = file.add_bytes("SCALAR", 5121, small_png().size(), small_png());
    file.json["images"][0] = {{"mimeType", "image/png"},
                              {"bufferView", file.json["accessors"][accessor]["bufferView"]}};
    EXPECT_EQ(import(file).scene.images[0].texels, small_texels);
    EXPECT_EQ(import_gltf(write("scene.glb", file.glb())).scene.images[0].texels, small_texels);
}

TEST_F(Textures, KeepTheirSamplers) {
    TestFile file = textured_file();
    file.json["textures"][0]["sampler"] = 0;
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}}};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(result.scene.textures[0].wrap_t, Wrap::mirrored_repeat);
    EXPECT_EQ(result.scene.textures[0].filter, Filter::nearest);
    EXPECT_TRUE(
        contains(sentences(result.report), "approximated: texture sampler at samplers[0]: there are no mipmaps"));
    file.json["samplers"][0] = {{"wrapS", 10497}};
    EXPECT_TRUE(contains(sentences(import(file).report), "rendered: texture sampler at samplers[0]: "));
    file.json["samplers"][0] = {{"wrapS", 7}};
    const ImportResult odd = import(file);
    EXPECT_EQ(odd.scene.textures[0].wrap_s, Wrap::repeat);
    EXPECT_TRUE(contains(sentences(odd.report),
                         "ignored: wrapS at samplers[0].wrapS: must be one of 33071 33648 10497, but is 7"));
}

TEST_F(Textures, OfNormalsHaveAScale) {
    TestFile file = textured_file();
    file.json["materials"][0]["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.textures.size(), 1U) << "one for both uses";
    ASSERT_TRUE(result.scene.materials[0].normal_texture);
    EXPECT_EQ(result.scene.materials[0].normal_scale, 0.5F);
    EXPECT_TRUE(contains(sentences(result.report), "rendered: normal texture at materials[0].normalTexture: linear"));
}

TEST_F(Textures, OfAnisotropyHaveATransformAndASet) {
    TestFile file = textured_file();
    file.json["materials"][0].erase("extensions");  // Phong's model, which has no microfacets
    Json& anisotropy = file.json["materials"][0]["extensions"]["KHR_materials_anisotropy"];
    const Json transform = {{"KHR_texture_transform", {{"scale", {3, 4}}}}};
    anisotropy = {{"anisotropyStrength", 1},
                  {"anisotropyTexture", {{"index", 0}, {"texCoord", 1}, {"extensions", transform}}}};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.textures.size(), 1U) << "one for both uses";
    ASSERT_TRUE(result.scene.materials[0].anisotropy_texture);
    EXPECT_EQ(result.scene.materials[0].anisotropy_texture->scale, Vec2f(3, 4));
    EXPECT_EQ(result.scene.materials[0].anisotropy_texture->texcoord, 1U);
    const std::string path = "materials[0].extensions.KHR_materials_anisotropy.anisotropyTexture: ";
    EXPECT_TRUE(contains(sentences(result.report), "rendered: anisotropy texture at " + path + "linear"));
    anisotropy["anisotropyStrength"] = 0;
    const ImportResult none = import(file);
    EXPECT_FALSE(none.scene.materials[0].anisotropy_texture);
    EXPECT_TRUE(contains(sentences(none.report), "ignored: anisotropy texture at " + path));
}

TEST_F(Textures, OfSheenMultiplyItsColourAndRoughness) {
    TestFile file = textured_file();
    file.json["materials"][0].erase("extensions");
    Json& sheen = file.json["materials"][0]["extensions"]["KHR_materials_sheen"];
    sheen = {{"sheenColorFactor", {1, 1, 1}},
             {"sheenColorTexture", {{"index", 0}}},
             {"sheenRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}};
    const ImportResult result = import(file);
    ASSERT_TRUE(result.scene.materials[0].sheen_colour_texture);
    ASSERT_TRUE(result.scene.materials[0].sheen_roughness_texture);
    EXPECT_EQ(result.scene.materials[0].sheen_roughness_texture->texcoord, 1U);
    const std::string path = "materials[0].extensions.KHR_materials_sheen.";
    EXPECT_TRUE(contains(sentences(result.report), "rendered: sheen colour texture at " + path + "sheenColorTexture"));
    sheen["sheenColorFactor"] = {0, 0, 0};
    const ImportResult none = import(file);
    EXPECT_FALSE(none.scene.materials[0].sheen_colour_texture);
    EXPECT_TRUE(contains(sentences(none.report),
                         "ignored: sheen roughness texture at " + path + "sheenRoughnessTexture: the material has no"));
}

TEST_F(Textures, AreMovedByKhrTextureTransform) {
    TestFile file = textured_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_texture_transform"};
    Json& info = file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"]["KHR_texture_transform"] = {{"offset", {1, 2}}, {"rotation", 0.5}, {"scale", {3, 4}}};
    const ImportResult result = import(file);
    const TextureReference& use = *result.scene.materials[0].diffuse_texture;
    EXPECT_EQ(use.offset, Vec2f(1, 2));
    EXPECT_EQ(use.rotation, 0.5F);
    EXPECT_EQ(use.scale, Vec2f(3, 4));
    EXPECT_TRUE(contains(sentences(result.report), "rendered: KHR_texture_transform at materials[0]."));
    info["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
    EXPECT_EQ(import(file).scene.materials[0].diffuse_texture->texcoord, 1U) << "it goes before the texture's own";
    info["extensions"]["KHR_texture_transform"] = {{"scale", {3}}};
    EXPECT_TRUE(contains(sentences(import(file).report),
                         "KHR_texture_transform.scale: must be 2 numbers, but is an array of 1"));
}

TEST_F(Textures, ThatTandemDoesNotShowAreNotOpened) {
    TestFile file = textured_file("../secret.png");
    Json& info = file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["texCoord"] = 16;
    const ImportResult result = import(file);
    EXPECT_FALSE(result.scene.materials[0].diffuse_texture);
    const std::string all = sentences(result.report);
    EXPECT_TRUE(
        contains(all, "ignored: base colour texture at materials[0].pbrMetallicRoughness.baseColorTexture: it uses"));
    EXPECT_TRUE(contains(all, "ignored: image at images[0]: no texture that Tandem renders uses it"));
    info["texCoord"] = 0;
    file.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    EXPECT_TRUE(contains(sentences(import(file).report), "its texture has no image in PNG or JPEG"));
}

TEST_F(Textures, CutOutWhatAlphaMasks) {
    TestFile file = textured_file();
    Json& material = file.json["materials"][0];
    material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.75};
    EXPECT_EQ(import(file).scene.materials[0].alpha_mode, AlphaMode::opaque);
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = 0.25;
    const ImportResult masked = import(file);
    EXPECT_EQ(masked.scene.materials[0].alpha_mode, AlphaMode::mask);
    EXPECT_EQ(masked.scene.materials[0].alpha, 0.75F);
    EXPECT_EQ(masked.scene.materials[0].alpha_cutoff, 0.25F);
    EXPECT_TRUE(contains(sentences(masked.report), "rendered: alphaMode MASK at materials[0].alphaMode: "));
    material["alphaMode"] = "BLEND";
    const ImportResult blended = import(file);
    EXPECT_EQ(blended.scene.materials[0].alpha_cutoff, 0.5F);
    EXPECT_TRUE(contains(sentences(blended.report), "approximated: alphaMode BLEND at materials[0].alphaMode: "));
    EXPECT_TRUE(contains(sentences(blended.report), "ignored: alphaCutoff at materials[0].alphaCutoff: "));
}

TEST_F(Textures, OnMeshesWithoutCoordinatesShowTheirCorner) {
    TestFile file = test::mesh_file();
    const TestFile textured = textured_file();
    for (const char* array : {"images", "textures", "materials"}) file.json[array] = textured.json[array];
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.meshes[0].texcoords.at(0), std::vector<Vec2f>(6, Vec2f(0, 0)));
    EXPECT_TRUE(contains(sentences(result.report),
                         "approximated: texture without coordinates at meshes[0].primitives[0].attributes: "));
}

TEST_F(Textures, OutsideOfTheFolderAreLeftOut) {
    write("secret.png", small_png());
    for (const char* uri : {"../secret.png", "%2e%2e/secret.png", "pictures/../../secret.png"}) {
        expect_image_left_out(uri, "leads out of the folder");
    }
    expect_image_left_out((folder_ / "secret.png").string(), "is an absolute path");
    expect_image_left_out("file:///etc/passwd", "has a scheme");
    std::filesystem::create_directories(folder_ / "inside");
    std::filesystem::create_symlink(folder_ / "secret.png", folder_ / "inside/link.png");
    expect_image_left_out("link.png", "names 'link.png', a link that leads out");
}

TEST_F(Textures, ThatCannotBeReadAreLeftOut) {
    expect_image_left_out("none.png", "names 'none.png', which does not exist");
    write("inside/text.png", "hello");
    expect_image_left_out("text.png", "'text.png' is not a PNG or JPEG image, the formats of textures");
    write("inside/short.png", small_png().substr(0, 40));
    expect_image_left_out("short.png", "'short.png' is not a readable PNG image: the file is cut off");
    std::string huge = small_png();
    huge[18] = huge[22] = '\x7F';  // the width and height of the header, whose checksum is wrong now
    write("inside/huge.png", huge);
    expect_image_left_out("huge.png", "'huge.png' is not a readable PNG image: ");
    expect_image_left_out("data:image/gif;base64,AAAA", "'data URI' is not a PNG or JPEG image");
    expect_image_left_out("data:image/png,AAAA", "is a data URI that does not start with 'data:', a media type and");
    write("inside/pointer.png", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 4\n");
    expect_image_left_out("pointer.png", "'pointer.png' is a Git LFS pointer, not the file itself; run 'git lfs pull'");
    expect_image_left_out("data:image/png;base64,AAA*", "is a data URI whose base64 is broken");
    expect_image_left_out("data:image/png;base64,", "'data URI' is not a PNG or JPEG");
}

TEST_F(Textures, OfMalformedFilesAreLeftOut) {
    TestFile file = textured_file();
    file.json["images"][0] = Json::object();
    expect_no_picture(file, "images[0]: has neither a uri nor a bufferView; add one");
    file.json["images"][0] = {{"uri", "a.png"}, {"bufferView", 0}};
    file.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 4}}};
    file.data = "abcd";
    expect_no_picture(file, "images[0].uri: is given in addition to a bufferView; Tandem uses the bufferView");
    file.json["images"][0] = {{"bufferView", 0}};
    expect_no_picture(file, "images[0].bufferView: 'bufferView 0' is not a PNG or JPEG");
    file = textured_file();
    file.json["textures"][0]["source"] = 3;
    EXPECT_TRUE(
        contains(sentences(import(file).report), "textures[0].source: is 3, but the file's array 'images' has 1"));
    file = textured_file();
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
    EXPECT_TRUE(
        contains(sentences(import(file).report),
                 "ignored: baseColorTexture at materials[0].pbrMetallicRoughness.baseColorTexture.index: is 1, but"));
}

TEST_F(Textures, OfAnyMediaTypeAreTold) {
    const std::string data = test::base64(small_png());
    for (const char* type : {"image/jpg", "application/octet-stream", "image/png;name=a.png", ""}) {
        const std::string uri = "data:" + std::string(type) + ";base64," + data;
        EXPECT_EQ(import(textured_file(uri)).scene.images.at(0).texels, small_texels) << type;
    }
    std::string bare = data;
    while (bare.back() == '=') bare.pop_back();
    EXPECT_EQ(import(textured_file("data:image/png;base64," + bare)).scene.images.at(0).texels, small_texels);
}

TEST_F(Textures, MayHaveBytesBehindTheirEnd) {
    write("a.png", small_png() + "and something else");
    EXPECT_EQ(import(textured_file("a.png")).scene.images.at(0).texels, small_texels);
}

/// As web browsers have it.
TEST_F(Textures, MayBeNamedCarelessly) {
    write("pictures/100% wall.png", small_png());
    EXPECT_EQ(import(textured_file("pictures\\100% wall.png")).scene.images.at(0).texels, small_texels);
}

/// One picture for three images: a file by two names, and a buffer view.
TEST_F(Textures, OfTheSameBytesAreDecodedOnce) {
    TestFile file = textured_file("a.png");
    write("a.png", small_png());
    std::filesystem::create_symlink("a.png", folder_ / "b.png");
    file.json["images"].push_back({{"uri", "./b.png"}});
    file.json["textures"].push_back({{"source", 1}});
    file.json["materials"][0]["normalTexture"] = {{"index", 1}};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.images.size(), 1U);
    EXPECT_EQ(result.scene.textures.size(), 2U);
    EXPECT_TRUE(contains(sentences(result.report), "rendered: image at images[0] (2 uses)"));
}

/// A grey PNG of 8192 x 8192 in 65 KB, and others beside it.
TEST_F(Textures, ThatAreTooLargeForTheFileAreHalved) {
    const std::size_t edge = 8192;
    ByteImage image{static_cast<int>(edge), static_cast<int>(edge), std::vector<std::uint8_t>(3 * edge * edge, 40)};
    for (std::size_t i = 0; i < 3 * edge; ++i) image.values[i] = 240;  // the first row
    const Bytes png = encode_png(image, {}, 9);
    image = {};
    write("large.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    write("small.png", small_png());
    TestFile file = textured_file("small.png");
    file.json["images"].push_back({{"uri", "large.png"}});
    file.json["textures"].push_back({{"source", 1}});
    file.json["materials"][0]["normalTexture"] = {{"index", 1}};
    const ImportResult result = import(file);
    ASSERT_EQ(result.scene.images.size(), 2U);
    EXPECT_EQ(result.scene.images[0].texels, small_texels);
    EXPECT_EQ(result.scene.images[1].width, 4096U);
    EXPECT_EQ(result.scene.images[1].height, 4096U);
    EXPECT_EQ(result.scene.images[1].texels[0], 0xFF8C8C8CU) << "the mean of 240 and 40";
    EXPECT_EQ(result.scene.images[1].texels[4096], 0xFF282828U);
    EXPECT_TRUE(contains(
        sentences(result.report),
        "approximated: large image at images[1]: has 8192 x 8192 texels; Tandem reduces it to 4096 x 4096, since"));
}

}  // namespace
}  // namespace tandem

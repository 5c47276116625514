#include "gltf/files.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "tandem/images/image_codecs.h"

namespace tandem::test {

namespace {

std::string word(std::uint32_t value) { return bytes_of(std::vector<std::uint32_t>{value}); }

std::string chunk_of(std::uint32_t type, std::string bytes, char padding) {
    while (bytes.size() % 4 != 0) bytes += padding;
    return word(static_cast<std::uint32_t>(bytes.size())) + word(type) + bytes;
}

}  // namespace

std::size_t TestFile::add_bytes(const std::string& type, int component_type, std::size_t count,
                                const std::string& bytes) {
    while (data.size() % 4 != 0) data += '\0';
    const std::size_t view = json["bufferViews"].size();
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", count},
                                 {"type", type},
                                 {"normalized", component_type != 5126}});
    data += bytes;
    return json["accessors"].size() - 1;
}

std::size_t TestFile::add_floats(const std::string& type, const std::vector<float>& values) {
    const std::size_t size = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    const std::size_t width = type.starts_with("MAT") ? size * size : size;
    return add_bytes(type, 5126, values.size() / width, bytes_of(values));
}

std::size_t TestFile::add_indices(int component_type, const std::vector<std::uint32_t>& values) {
    const std::size_t width = component_type == 5121 ? 1 : component_type == 5123 ? 2 : 4;
    std::string bytes;
    for (const std::uint32_t value : values) bytes += word(value).substr(0, width);  // little endian
    const std::size_t accessor = add_bytes("SCALAR", component_type, values.size(), bytes);
    json["accessors"][accessor]["normalized"] = false;
    return accessor;
}

std::string TestFile::text() const {
    Json document = json;
    if (!data.empty() && !document.contains("buffers")) {
        const std::string uri = "data:application/octet-stream;base64," + base64(data);
        document["buffers"] = Json::array({{{"byteLength", data.size()}, {"uri", uri}}});
    }
    return document.dump(1);
}

std::string TestFile::glb() const {
    Json document = json;
    if (!data.empty()) document["buffers"] = Json::array({{{"byteLength", data.size()}}});
    return make_glb(document.dump(), data);
}

TestFile small_file() {
    return {Json::parse(R"({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"name": "small", "nodes": [0, 1]}],
        "nodes": [{"name": "eye", "camera": 0, "translation": [0, 0, 5]}, {"name": "ball", "mesh": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [
            {"material": 0, "extensions": {"EXT_implicit_geometry": {"sphere": {"radius": 1}}}}]}],
        "materials": [{"name": "clay", "extensions": {"TANDEM_materials_phong": {"diffuse": [0.5, 0.25, 0.125]}}}]
    })"),
            ""};
}

TestFile rich_file() {
    TestFile file = small_file();
    Json& json = file.json;
    json["extensions"] = Json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 2}]},
                                         "TANDEM_environment": {"ambient": [0.5, 0.5, 0.5]}})");
    json["meshes"].push_back(
        Json::parse(R"({"primitives": [{"extensions": {"EXT_implicit_geometry": {"box": {"size": [1, 2, 3]}}}}]})"));
    const std::size_t places = file.add_floats("VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0});
    const std::size_t turns = file.add_bytes(
        "VEC4", 5122, 3, bytes_of(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767}));
    const std::size_t times = file.add_floats("SCALAR", {0, 1, 2});
    const std::size_t values = file.add_floats("VEC3", {1, 1, 1, 2, 2, 2, 3, 3, 3});
    json["nodes"].push_back({{"name", "crowd"}, {"mesh", 1}});
    json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places},
                                                                               {"ROTATION", turns}};
    json["nodes"].push_back(
        {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 4, 0}}});
    json["nodes"][1]["children"] = {2};
    json["scenes"][0]["nodes"] = {0, 1, 3};
    json["animations"] = Json::array({{{"samplers", {{{"input", times}, {"output", values}}}},
                                       {"channels",
                                        {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}},
                                         {{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}});
    return file;
}

TestFile mesh_file() {
    TestFile file = small_file();
    file.json["nodes"][1]["name"] = "sheet";
    const std::size_t positions = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
    const std::size_t indices = file.add_indices(5123, {0, 1, 2, 2, 1, 3});
    file.json["meshes"][0] = {
        {"name", "sheet"},
        {"primitives", {{{"material", 0}, {"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}};
    return file;
}

TestFile pictured_mesh_file() {
    TestFile file = mesh_file();
    const Bytes bytes = encode_png(ByteImage{2, 1, {255, 0, 0, 0, 188, 255}}, {}, 1);
    const std::string png(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    file.json["images"] = {{{"uri", "data:image/png;base64," + base64(png)}}};
    file.json["textures"] = {{{"source", 0}}};
    return file;
}

std::string make_glb(std::string json, std::string chunk) {
    std::string chunks = chunk_of(0x4E4F534A, std::move(json), ' ');
    if (!chunk.empty()) chunks += chunk_of(0x004E4942, std::move(chunk), '\0');
    return word(0x46546C67) + word(2) + word(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string sentences(const ImportReport& report) {
    std::string all;
    for (const ImportNote& note : report.notes()) all += to_string(note) + "\n";
    return all;
}

GltfFiles::GltfFiles() {
    static std::atomic<int> count = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("tandem-gltf-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(folder_);
}

GltfFiles::~GltfFiles() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path GltfFiles::write(const std::string& name, const std::string& bytes) const {
    std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(file);  // some file systems wait for the disk when a file is written over
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

std::string GltfFiles::error_of(const std::filesystem::path& file) const {
    const std::string message = input_error([&] { (void)import_gltf(file); });
    const std::string lead = file.string() + ": ";
    EXPECT_EQ(message.substr(0, lead.size()), lead);
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(std::min(lead.size(), message.size()));
}

}  // namespace tandem::test

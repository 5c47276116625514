/// The JSON schemas of our extensions say the same as the importer.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "gltf/files.h"

namespace tandem {
namespace {

using test::Json;
using test::small_file;
using test::TestFile;

Json schema(const std::string& name) {
    return Json::parse(test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/docs/schemas/" + name));
}

/// The part of JSON Schema that our schemas use; any other keyword fails the test.
bool accepts(const Json& schema, const Json& value) {
    static const std::vector<std::string> ignored = {"$schema", "$id", "title", "description", "default"};
    for (const auto& [keyword, rule] : schema.items()) {
        if (std::find(ignored.begin(), ignored.end(), keyword) != ignored.end()) continue;
        bool good = true;
        if (keyword == "type") {
            good = rule == value.type_name() || (rule == "integer" && value.is_number_integer());
        } else if (keyword == "enum") {
            good = std::find(rule.begin(), rule.end(), value) != rule.end();
        } else if (keyword == "minimum") {
            good = !value.is_number() || value.get<double>() >= rule.get<double>();
        } else if (keyword == "maximum") {
            good = !value.is_number() || value.get<double>() <= rule.get<double>();
        } else if (keyword == "minItems") {
            good = !value.is_array() || value.size() >= rule.get<std::size_t>();
        } else if (keyword == "maxItems") {
            good = !value.is_array() || value.size() <= rule.get<std::size_t>();
        } else if (keyword == "items") {
            for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) good = good && accepts(rule, value[i]);
        } else if (keyword == "required") {
            for (const Json& name : rule)
                good = good && (!value.is_object() || value.contains(name.get<std::string>()));
        } else if (keyword == "properties") {
            for (const auto& [name, inner] : rule.items()) {
                if (value.is_object() && value.contains(name)) good = good && accepts(inner, value[name]);
            }
        } else {
            ADD_FAILURE() << "the test does not know the keyword " << keyword;
        }
        if (!good) return false;
    }
    return true;
}

class Schemas : public test::GltfFiles {
  protected:
    bool imports(const TestFile& file) const {
        try {
            (void)import(file);
            return true;
        } catch (const InputError&) {
            return false;
        }
    }

    /// Schema and importer agree on every value, and each says yes and no to something.
    void compare(const Json& schema, const std::vector<std::string>& values,
                 const std::function<void(Json&, const Json&)>& put) const {
        int accepted = 0;
        for (const std::string& text : values) {
            const Json value = Json::parse(text);
            TestFile file = small_file();
            put(file.json, value);
            EXPECT_EQ(accepts(schema, value), imports(file)) << text;
            accepted += accepts(schema, value) ? 1 : 0;
        }
        EXPECT_GT(accepted, 0);
        EXPECT_LT(accepted, static_cast<int>(values.size()));
    }
};

TEST_F(Schemas, Phong) {
    compare(schema("material.TANDEM_materials_phong.schema.json"),
            {"{}", "[]", "3", R"({"ambient": [0, 0.5, 1]})", R"({"ambient": [0, 0.5]})", R"({"ambient": [0, 0, 0, 0]})",
             R"({"diffuse": [0, 0, 1.01]})", R"({"diffuse": [0, 0, -0.01]})", R"({"diffuse": [0, 0, "1"]})",
             R"({"specular": 1})", R"({"specular": [1, 1, 1], "shininess": 0})", R"({"shininess": 1e8})",
             R"({"shininess": 1.1e8})", R"({"shininess": -1})", R"({"shininess": null})", R"({"extras": 7})",
             R"({"mirror": [0, 0.5, 1]})", R"({"mirror": 1})"},
            [](Json& d, const Json& v) { d["materials"][0]["extensions"]["TANDEM_materials_phong"] = v; });
}

TEST_F(Schemas, Environment) {
    compare(schema("scene.TANDEM_environment.schema.json"),
            {"{}", "true", R"({"ambient": [0, 0, 9]})", R"({"ambient": [0, 0, -9]})", R"({"ambient": []})",
             R"({"gradient": {}})", R"({"gradient": {"bottom": [0, 0, 0]}})",
             R"({"gradient": {"bottom": [0, 0, 0], "top": [1, 2, 3]}})", R"({"gradient": [1, 1, 1]})",
             R"({"gradient": {"bottom": [0, 0, 0], "top": [1, 2]}, "ambient": [1, 1, 1]})",
             R"({"illuminates": true, "indirect": false})", R"({"indirect": 1})", R"({"uri": 1})",
             R"({"rotation": -3.5, "intensity": 2})", R"({"rotation": 2e6})", R"({"intensity": -1})",
             R"({"intensity": 2e6})"},
            [](Json& d, const Json& v) { d["scenes"][0]["extensions"]["TANDEM_environment"] = v; });
}

TEST_F(Schemas, Displays) {
    compare(schema("scene.TANDEM_display.schema.json"),
            {"{}", "[]", R"({"transfer": "srgb"})", R"({"transfer": "linear", "exposure": -2.5})",
             R"({"transfer": "sRGB"})", R"({"transfer": 1})", R"({"exposure": 100})", R"({"exposure": 100.5})",
             R"({"exposure": -101})", R"({"exposure": "auto"})", R"({"extras": 7})"},
            [](Json& d, const Json& v) { d["scenes"][0]["extensions"]["TANDEM_display"] = v; });
}

TEST_F(Schemas, LightsOfPhong) {
    compare(schema("light.TANDEM_lights_phong.schema.json"),
            {"{}", "[]", R"({"falloff": false})", R"({"falloff": 0})", R"({"shadows": true, "falloff": true})",
             R"({"shadows": "no"})"},
            [](Json& d, const Json& v) {
                d["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
                d["extensions"]["KHR_lights_punctual"]["lights"][0]["extensions"]["TANDEM_lights_phong"] = v;
            });
}

TEST_F(Schemas, Lens) {
    compare(schema("camera.TANDEM_camera_lens.schema.json"),
            {"{}", R"({"apertureRadius": 0.1})", R"({"apertureRadius": 0, "focusDistance": 1})",
             R"({"apertureRadius": -1, "focusDistance": 1})", R"({"apertureRadius": 1, "focusDistance": 0})",
             R"({"apertureRadius": 1, "focusDistance": 2, "blades": 33})",
             R"({"apertureRadius": 1, "focusDistance": 2, "blades": 5, "rotation": -3})"},
            [](Json& d, const Json& v) { d["cameras"][0]["extensions"]["TANDEM_camera_lens"] = v; });
}

TEST_F(Schemas, Shutter) {
    compare(schema("camera.TANDEM_camera_shutter.schema.json"),
            {"{}", R"({"open": 0.1})", R"({"open": 0, "close": 0.02})", R"({"open": -0.01, "close": -0.01})",
             R"({"open": "now", "close": 1})", R"({"open": 0, "close": 1, "instants": 0})",
             R"({"open": 0, "close": 1, "instants": 1024})", R"({"open": 0, "close": 1, "instants": 1025})",
             R"({"open": 0, "close": 1, "instants": 2.5})"},
            [](Json& d, const Json& v) { d["cameras"][0]["extensions"]["TANDEM_camera_shutter"] = v; });
}

TEST_F(Schemas, Dielectric) {
    compare(schema("material.TANDEM_materials_dielectric.schema.json"),
            {"{}", "3", R"({"priority": 0})", R"({"priority": 127})", R"({"priority": 128})", R"({"priority": -1})"},
            [](Json& d, const Json& v) { d["materials"][0]["extensions"]["TANDEM_materials_dielectric"] = v; });
}

TEST(SchemasOfFiles, AcceptThePapersScene) {
    const Json paper = Json::parse(test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/assets/scenes/paper.gltf"));
    for (const Json& material : paper["materials"]) {
        EXPECT_TRUE(accepts(schema("material.TANDEM_materials_phong.schema.json"),
                            material["extensions"]["TANDEM_materials_phong"]));
    }
    EXPECT_TRUE(accepts(schema("scene.TANDEM_environment.schema.json"),
                        paper["scenes"][0]["extensions"]["TANDEM_environment"]));
    EXPECT_TRUE(
        accepts(schema("scene.TANDEM_display.schema.json"), paper["scenes"][0]["extensions"]["TANDEM_display"]));
}

}  // namespace
}  // namespace tandem

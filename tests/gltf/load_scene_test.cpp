/// What a picture needs and a file lacks: a camera and light.
#include "tandem/gltf/load_scene.h"

#include <gtest/gtest.h>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/framing.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;
using test::TestFile;

/// small_file() without its camera; it has no light either.
TestFile bare_file() {
    TestFile file = test::small_file();
    file.json["nodes"][0].erase("camera");
    file.json.erase("cameras");
    return file;
}

class LoadScene : public test::GltfFiles {
  protected:
    struct Loaded {
        Scene scene;
        std::string report;
    };

    Loaded load(const TestFile& file, const LoadOptions& options = {}) const {
        ImportReport report;
        Scene scene = load_scene(write("scene.gltf", file.text()).string(), &report, options);
        return {std::move(scene), test::sentences(report)};
    }

    /// Is what is drawn exactly what the file says?
    bool is_as_imported(const TestFile& file, const LoadOptions& options = {}) const {
        return scene_hash(prepare(load(file, options).scene)) == scene_hash(prepare(import(file).scene));
    }
};

TEST_F(LoadScene, FramesAFileWithoutACamera) {
    const Loaded loaded = load(bare_file());
    const std::size_t camera = camera_node(loaded.scene, "");
    EXPECT_EQ(loaded.scene.nodes[camera].name, "auto");
    EXPECT_GT(loaded.scene.nodes[camera].matrix->translation.z, 2) << "before the front of the ball";
    EXPECT_TRUE(contains(loaded.report,
                         "approximated: no camera at scenes[0]: framed from the front, 20 degrees above; --camera "));
    EXPECT_EQ(prepare(loaded.scene).spheres.size(), 1U);
}

TEST_F(LoadScene, FramesForTheShapeOfTheFilm) {
    TestFile file = bare_file();
    file.json["nodes"][1]["scale"] = {8, 1, 1};  // wide: it needs less distance in a wide picture
    const auto distance = [&](double aspect) {
        const Scene scene = load(file, {.aspect = aspect}).scene;
        return scene.nodes[camera_node(scene, "")].matrix->translation.z;
    };
    EXPECT_GT(distance(0.5), 1.8 * distance(1));
    EXPECT_GT(distance(1), 1.8 * distance(2));
}

TEST_F(LoadScene, SaysThatAMovingSceneIsFramedAsItIsAtFirst) {
    TestFile file = test::rich_file();
    file.json["nodes"][0].erase("camera");
    EXPECT_TRUE(contains(load(file).report, "as the scene is at frame 0"));
}

TEST_F(LoadScene, ShowsTheBackgroundWhereThereIsNothing) {
    TestFile file = bare_file();
    file.json["scenes"][0]["nodes"] = {0};
    const Loaded loaded = load(file);
    EXPECT_TRUE(contains(loaded.report, "approximated: no surfaces at scenes[0]: the image shows only the background"));
    EXPECT_EQ(primitive_count(prepare(loaded.scene)), 0U);
}

TEST_F(LoadScene, TakesViewsOfFilesThatHaveCameras) {
    TestFile file = test::small_file();
    file.json["extensions"]["TANDEM_environment"] = Json::object();
    const Loaded loaded = load(file, {.camera = "left"});
    EXPECT_LT(loaded.scene.nodes[camera_node(loaded.scene, "left")].matrix->translation.x, -2);
    EXPECT_FALSE(contains(loaded.report, "no camera")) << loaded.report;
    EXPECT_EQ(camera_node(loaded.scene, ""), 0U);
}

TEST_F(LoadScene, PrefersACameraOfTheFileToAViewOfItsName) {
    TestFile file = test::small_file();
    file.json["nodes"][0]["name"] = "left";
    const Scene scene = load(file, {.camera = "left"}).scene;
    EXPECT_EQ(camera_node(scene, "left"), 0U);
    EXPECT_TRUE(is_as_imported(file, {.camera = "left", .default_light = false}));
}

TEST_F(LoadScene, NamesTheCamerasAndViewsThereAre) {
    const std::string path = write("scene.gltf", test::small_file().text()).string();
    EXPECT_EQ(test::input_error([&] { (void)load_scene(path, nullptr, {.camera = "Left"}); }),
              "the scene has no camera 'Left'; it has 'eye', and can be seen from any of " + view_names());
}

TEST_F(LoadScene, LightsAFileWithoutLight) {
    const Loaded loaded = load(test::small_file());
    const PreparedScene prepared = prepare(loaded.scene);
    EXPECT_EQ(prepared.lights.size(), 2U);
    EXPECT_NE(prepared.environment.illuminates, 0U);
    EXPECT_TRUE(contains(loaded.report,
                         "approximated: no light at scenes[0]: lit by a uniform background and a light from the "));
    EXPECT_TRUE(contains(loaded.report, "--light none leaves it dark"));
}

TEST_F(LoadScene, LeavesAFileDarkIfAskedTo) {
    EXPECT_FALSE(is_as_imported(test::small_file()));
    EXPECT_TRUE(is_as_imported(test::small_file(), {.default_light = false}));
    EXPECT_FALSE(contains(load(test::small_file(), {.default_light = false}).report, "no light"));
}

TEST_F(LoadScene, AddsNoLightToWhatSaysHowItIsLit) {
    TestFile environment = test::small_file();
    environment.json["scenes"][0]["extensions"]["TANDEM_environment"] = Json::object();
    TestFile root = test::small_file();
    root.json["extensions"]["TANDEM_environment"] = Json::object();
    TestFile lamp = test::small_file();
    lamp.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    lamp.json["nodes"][1]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
    TestFile emissive = test::small_file();
    emissive.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    for (const TestFile& file : {environment, root, lamp, emissive}) {
        EXPECT_TRUE(is_as_imported(file));
        EXPECT_FALSE(contains(load(file).report, "no light"));
    }
    lamp.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 0;
    EXPECT_FALSE(is_as_imported(lamp)) << "a lamp that is off";
    EXPECT_EQ(scene_hash(prepare(load_scene("named:paper"))),
              scene_hash(prepare(load_scene("named:paper", nullptr, {}))));
}

}  // namespace
}  // namespace tandem

/// tandem-gltf as a user runs it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "gltf/files.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;

class App : public test::GltfFiles {
  protected:
    struct Run {
        int status;
        std::string out;
        std::string err;
    };

    Run run(const std::string& arguments) const {
        const std::string out = (folder_ / "out").string();
        const std::string err = (folder_ / "err").string();
        const int raw =
            std::system((std::string(TANDEM_GLTF_PROGRAM) + " " + arguments + " >" + out + " 2>" + err).c_str());
        return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, test::read_bytes(out), test::read_bytes(err)};
    }
    std::string rich() const { return write("rich.gltf", test::rich_file().text()).string(); }
};

TEST_F(App, InfoSaysWhatAFileHolds) {
    const Run info = run("info " + rich());
    EXPECT_EQ(info.status, 0);
    EXPECT_EQ(info.err, "");
    for (const char* line :
         {"scene \"small\"",
          "primitives: 4 (1 spheres, 3 boxes, 0 ellipsoids, 0 parallelepipeds, 0 triangles, 0 quads)",
          "\"crowd\", 3 boxes, animated", "\"eye\", perspective, 45.84 degrees high",
          "\"lamp\", point, colour (1, 1, 1), intensity 0.63662, falls off with distance, casts shadows",
          "shadows: light 'lamp' casts shadows", "\"clay\", ambient (0.08, 0.08, 0.08)", "8-bit images: sRGB\n",
          "animation: 2 channels, 6 keys, 48 frames at 24 per second",
          "  rendered: EXT_mesh_gpu_instancing at nodes[2]"}) {
        EXPECT_TRUE(contains(info.out, line));
    }
}

TEST_F(App, InfoKnowsNamedScenes) {
    const Run info = run("info named:spheres/50");
    EXPECT_EQ(info.status, 0);
    EXPECT_TRUE(contains(info.out, "primitives: 50 (50 spheres"));
}

TEST_F(App, AFileWithoutACameraIsFine) {
    test::TestFile file = test::rich_file();
    file.json["nodes"][0].erase("camera");
    const std::string path = write("blind.gltf", file.text()).string();
    const Run info = run("info " + path);
    EXPECT_EQ(info.status, 0);
    EXPECT_TRUE(contains(info.out, "primitives: 4 (1 spheres, 3 boxes"));
    EXPECT_TRUE(contains(info.out, "\"auto\", perspective, 40 degrees high"));
    const Run check = run("check " + path);
    EXPECT_EQ(check.status, 0);
    EXPECT_TRUE(contains(check.out, "  approximated: no camera at scenes[0]: framed from the front"));
}

TEST_F(App, JsonGoesToAFileOrToStandardOutput) {
    const Run info = run("info named:paper --json -");
    const Json described = Json::parse(info.out);
    EXPECT_EQ(described["animation"]["frames"], 120);
    EXPECT_EQ(described["primitives"]["spheres"], 3);
    EXPECT_EQ(described["display"], Json::parse(R"({"transfer": "linear", "exposure_stops": 0.0})"));
    const std::string target = (folder_ / "check.json").string();
    EXPECT_EQ(run("check " + rich() + " --json " + target).status, 0);
    EXPECT_EQ(Json::parse(test::read_bytes(target))["fine"], true);
    EXPECT_EQ(run("info named:paper --json " + (folder_ / "no/such/folder.json").string()).status, 2);
}

TEST_F(App, CheckFindsNothingInAGoodFile) {
    const Run check = run("check " + rich());
    EXPECT_EQ(check.status, 0);
    EXPECT_TRUE(contains(check.out, "rich.gltf: fine\n"));
    EXPECT_TRUE(contains(check.out, "  ignored: camera znear"));
}

TEST_F(App, CheckSaysWhatIsWrong) {
    const std::string bad = write("bad.gltf", "{\"asset\": {}}").string();
    const Run check = run("check " + bad + " --json -");
    EXPECT_EQ(check.status, 2);
    EXPECT_EQ(check.err, "tandem-gltf: " + bad + ": asset: lacks the required property 'version'\n");
    EXPECT_EQ(Json::parse(check.out)["fine"], false);
    EXPECT_EQ(run("info " + bad).status, 2);
}

TEST_F(App, CheckPreparesTheFramesOfAnAnimation) {
    test::TestFile file = test::rich_file();
    file.json["nodes"][1].erase("children");
    file.json["scenes"][0]["nodes"].push_back(2);
    const std::size_t times = file.add_floats("SCALAR", {0, 1});
    const std::size_t scales = file.add_floats("VEC3", {1, 1, 1, 1, 0, 1});  // the ball becomes flat
    file.json["animations"][0]["samplers"] = {{{"input", times}, {"output", scales}, {"interpolation", "STEP"}}};
    file.json["animations"][0]["channels"] = {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}};
    const std::size_t still = file.add_floats("VEC3", {1, 1, 1, 1, 1, 1});
    const std::size_t late = file.add_floats("SCALAR", {0, 2});
    file.json["animations"][0]["samplers"].push_back({{"input", late}, {"output", still}});
    file.json["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", {{"node", 3}, {"path", "scale"}}}});
    const Run check = run("check " + write("flat.gltf", file.text()).string());
    EXPECT_EQ(check.status, 2);
    EXPECT_TRUE(contains(check.err, "frame 24: node 1 'ball' has a sphere that its transform flattens"));
}

TEST_F(App, UsageErrorsHaveStatusTwo) {
    EXPECT_EQ(run("").status, 2);
    EXPECT_EQ(run("dance").status, 2);
    EXPECT_EQ(run("info").status, 2);
    EXPECT_EQ(run("info named:none").status, 2);
    const Run help = run("--help");
    EXPECT_EQ(help.status, 0);
    EXPECT_TRUE(contains(help.out, "check"));
}

}  // namespace
}  // namespace tandem

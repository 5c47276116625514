#include <gtest/gtest.h>

#include <cstdlib>

#include "gltf/files.h"
#include "tandem/scene/load_scene.h"
#include "tandem/scene/prepare.h"

namespace tandem {
namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIR) + "/assets/scenes/";

TEST(PaperFile, HoldsTheSceneOfTheSameName) {
    const Scene file = load_scene(scenes + "paper.gltf");
    const Scene named = load_scene("named:paper");
    EXPECT_EQ(file.name, named.name);
    ASSERT_EQ(file.nodes.size(), named.nodes.size());
    for (std::size_t i = 0; i < named.nodes.size(); ++i) EXPECT_EQ(file.nodes[i].name, named.nodes[i].name);
    for (std::size_t i = 0; i < named.materials.size(); ++i) {
        EXPECT_EQ(file.materials[i].name, named.materials[i].name);
    }
    EXPECT_EQ(frame_count(file), 120);
    for (int frame = 0; frame < 120; ++frame) {
        ASSERT_EQ(scene_hash(prepare(file, {frame, ""})), scene_hash(prepare(named, {frame, ""}))) << "frame " << frame;
    }
}

class PaperScript : public test::GltfFiles {};

TEST_F(PaperScript, WritesTheStoredFile) {
    const std::string python = TANDEM_PYTHON;
    if (python.empty()) GTEST_SKIP() << "no python3 was found when configuring";
    const auto target = folder_ / "paper.gltf";
    const std::string command = "'" + python + "' '" + scenes + "paper.py' '" + target.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(test::read_bytes(target) == test::read_bytes(scenes + "paper.gltf"))
        << "run assets/scenes/paper.py and commit what it writes";
}

}  // namespace
}  // namespace tandem

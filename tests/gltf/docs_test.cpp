/// What docs/scene-format.md shows is true.
#include <gtest/gtest.h>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/names.h"

namespace tandem {
namespace {

/// The fenced blocks of one language, in the order of the page.
std::vector<std::string> blocks(const std::string& language) {
    const std::string page = test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/docs/scene-format.md");
    std::vector<std::string> found;
    const std::string fence = "```" + language + "\n";
    for (std::size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
        at += fence.size();
        const std::size_t end = page.find("```", at);
        found.push_back(page.substr(at, end - at));
        at = end;
    }
    return found;
}

TEST(EffectsPage, ListsEveryEffectWithWhatItAdds) {
    const std::string page = test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/docs/effects.md");
    for (const EffectName& effect : effect_names()) {
        const std::size_t row = page.find(std::string("| `") + effect.name + "` | ");
        ASSERT_NE(row, std::string::npos) << effect.name;
        const std::string line = page.substr(row, page.find('\n', row) - row);
        EXPECT_TRUE(line.ends_with(std::string("| ") + effect.adds + " |")) << line;
    }
}

class SceneFormatPage : public test::GltfFiles {};

TEST_F(SceneFormatPage, ShowsACompleteFileThatImportsWithoutALeftover) {
    const auto shown = blocks("json");
    ASSERT_FALSE(shown.empty());
    const auto result = import_gltf(write("shown.gltf", shown[0]));
    const auto prepared = prepare(result.scene);
    EXPECT_EQ(prepared.spheres.size(), 1U);
    EXPECT_EQ(prepared.boxes.size(), 1U);
    EXPECT_EQ(prepared.lights.size(), 1U);
}

/// The other examples are members of a file: each is put into an object and parsed.
TEST_F(SceneFormatPage, ShowsWellFormedExamples) {
    const auto shown = blocks("json");
    EXPECT_GE(shown.size(), 4U);
    for (const std::string& block : shown) {
        const bool is_member = block[0] == '"';
        EXPECT_TRUE(test::Json::accept(is_member ? "{" + block + "}" : block)) << block;
    }
}

TEST_F(SceneFormatPage, ShowsTheExampleThatTestsCompile) {
    const std::string source = test::read_bytes(std::string(TANDEM_SOURCE_DIR) + "/tests/scene/example_test.cpp");
    const std::string mark = "// [example]\n";
    const std::size_t begin = source.find(mark) + mark.size();
    const auto shown = blocks("cpp");
    ASSERT_EQ(shown.size(), 1U);
    EXPECT_EQ(shown[0], source.substr(begin, source.find(mark, begin) - begin));
}

}  // namespace
}  // namespace tandem

// Films whose hashes are stored: the CPU proves its half of the identity in every run, a GPU run the other half.
// After a change that is meant to alter pictures: TANDEM_UPDATE_GOLDEN=1 agree_tests --gtest_filter='*Golden*'.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/backend_list.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using Json = nlohmann::ordered_json;

Json read_golden() {
    std::ifstream file(TANDEM_GOLDEN_FILE);
    return Json::parse(file);
}

/// By name, or a file beside the scripts of assets/scenes.
Scene scene_of(const std::string& name) {
    return name.ends_with(".gltf") ? load_scene(TANDEM_SCENES "/" + name) : named_scene(name);
}

class Golden : public test::ExactBackend {};

TEST_P(Golden, FilmsAreAsStored) {
    Json golden = read_golden();
    ASSERT_GE(golden["films"].size(), 5U);
    for (Json& entry : golden["films"]) {
        const char* field = GetParam().tier == Tier::precise ? "precise_sha256" : "strict_sha256";
        const auto frame = entry["frame"].get<std::uint32_t>();
        const PreparedScene scene = prepare(scene_of(entry["scene"].get<std::string>()),
                                            {.frame = static_cast<std::int32_t>(frame), .camera = ""});
        RenderJob job;
        job.width = entry["width"];
        job.height = entry["height"];
        job.samples = entry["samples"];
        job.seed = entry["seed"];
        job.frame = frame;
        job.tier = GetParam().tier;
        const std::string hash = film_hash(backend_->render(load(scene), job).film);
        if (std::getenv("TANDEM_UPDATE_GOLDEN") != nullptr) {
            entry[field] = hash;
        } else {
            EXPECT_EQ(hash, entry[field].get<std::string>()) << entry["scene"] << " frame " << frame;
        }
    }
    if (std::getenv("TANDEM_UPDATE_GOLDEN") != nullptr) std::ofstream(TANDEM_GOLDEN_FILE) << golden.dump(2) << "\n";
}

INSTANTIATE_TEST_SUITE_P(Backends, Golden, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem

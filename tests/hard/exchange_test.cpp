// The corpus as files: exported numbers read back as the same bits, correct answers pass, wrong ones are found, and
// malformed files give one message.
#include "hard/corpus/exchange.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "hard/corpus/gltf_text.h"
#include "hard/corpus/npy.h"
#include "support/input_error.h"
#include "support/temporary_folder.h"
#include "tandem/base/whole_file.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/import.h"

namespace tandem::hard {
namespace {

namespace fs = std::filesystem;

/// Answers that repeat the exact ones.
void answer_rightly(const test::TemporaryFolder& folder) {
    fs::create_directory(folder.file("answers"));
    for (const auto& entry : fs::directory_iterator(folder.file("exact"))) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".id.npy") || name.ends_with(".t.npy"))
            fs::copy(entry.path(), folder.file("answers/" + name));
    }
}

void export_to(const test::TemporaryFolder& folder, const std::vector<std::string>& ids, std::size_t rays = 40) {
    (void)export_cases(select_cases(ids), rays, folder.file(""));
}

TEST(Exchange, ScenesReadBackAsTheSameBits) {
    test::TemporaryFolder folder;
    std::size_t scenes = 0;
    for (const HardCase* hard_case : select_cases({})) {
        if (!hard_case->has_rays() || hard_case->id == "K11" || hard_case->id == "D9") continue;  // large, and alike
        for (const AnsweredBatch& batch : answered_batches(*hard_case, 48)) {
            if (!fits_gltf(batch.scene)) continue;
            write_file(folder.file("scene.gltf"), std::string_view(to_gltf(batch.scene)), Durability::written);
            const PreparedScene read =
                prepare(import_gltf(folder.file("scene.gltf")).scene, {.origin = Vec3d{0, 0, 0}});
            ASSERT_EQ(scene_hash(read), scene_hash(batch.prepared)) << hard_case->id;
            ++scenes;
        }
    }
    EXPECT_GT(scenes, 100U);
}

TEST(Exchange, RaysReadBackAsTheSameBits) {
    test::TemporaryFolder folder;
    export_to(folder, {"A11"});
    const auto batches = answered_batches(*select_cases({"A11"}).front(), 40);
    for (std::size_t batch = 0; batch < batches.size(); ++batch) {
        const auto numbers =
            read_npy<double>(folder.file("A11-" + std::to_string(batch) + ".rays.npy"), batches[batch].rays.size(), 6);
        for (std::size_t i = 0; i < batches[batch].rays.size(); ++i) {
            EXPECT_EQ(numbers[6 * i], double{batches[batch].rays[i].origin.x});
            EXPECT_EQ(numbers[6 * i + 5], double{batches[batch].rays[i].direction.z});
        }
    }
}

TEST(Exchange, RightAnswersPass) {
    test::TemporaryFolder folder;
    export_to(folder, {"A1", "B*"});
    answer_rightly(folder);
    const auto checked = check_answers(folder.file("answers"));
    EXPECT_EQ(checked.size(), 14U) << "A1 and the ray cases of B";
    for (const CheckedCase& c : checked) {
        EXPECT_EQ(c.missing, "");
        EXPECT_GT(c.score.tried, 0U) << c.id;
        EXPECT_EQ(c.score.wrong, 0U) << c.id << ": " << c.score.first_failure;
        EXPECT_LE(c.score.worst_ulps(), 0.5001) << c.id;
    }
}

TEST(Exchange, WrongAnswersAreFound) {
    test::TemporaryFolder folder;
    export_to(folder, {"B12"});
    answer_rightly(folder);
    const auto ids64 = read_npy<std::int64_t>(folder.file("exact/B12-0.id.npy"), 40);
    std::vector<std::int32_t> ids(ids64.begin(), ids64.end());
    ids[0] = -1;  // a leak
    ids[1] += 1;  // another box
    ids[2] = -2;  // refused
    write_npy(folder.file("answers/B12-0.id.npy"), ids);
    const auto t64 = read_npy<double>(folder.file("exact/B12-0.t.npy"), 40);
    std::vector<float> t(t64.begin(), t64.end());
    t[3] = std::nextafter(std::nextafter(std::nextafter(t[3], 9.0F), 9.0F), 9.0F);
    t[4] = std::nanf("");
    write_npy(folder.file("answers/B12-0.t.npy"), t);
    const Score score = check_answers(folder.file("answers/")).front().score;
    EXPECT_EQ(score.wrong, 3U);
    EXPECT_EQ(score.leaks, 1U);
    EXPECT_EQ(score.refused, 1U);
    EXPECT_EQ(score.nans, 1U);
    EXPECT_EQ(score.worst_ulps(), HUGE_VAL);
    EXPECT_TRUE(test::contains(score.first_failure, "a miss at t"));
}

TEST(Exchange, CasesWithoutAnswersAreSaidToBeSo) {
    test::TemporaryFolder folder;
    export_to(folder, {"A9", "B8"});
    answer_rightly(folder);
    fs::remove(folder.file("answers/B8-1.t.npy"));
    const auto checked = check_answers(folder.file("answers"));
    EXPECT_EQ(checked.at(0).missing, "");
    EXPECT_TRUE(test::contains(checked.at(1).missing, "B8-1.t.npy"));
}

TEST(Exchange, MalformedFilesGiveOneSentence) {
    test::TemporaryFolder folder;
    export_to(folder, {"A9"});
    answer_rightly(folder);
    const std::string id_file = folder.file("answers/A9-0.id.npy");
    const auto message = [&] { return test::input_error([&] { (void)check_answers(folder.file("answers")); }); };
    const auto broken = [&](std::string_view text, const std::string& part) {
        write_file(id_file, text, Durability::written);
        const std::string said = message();
        EXPECT_TRUE(test::contains(said, part));
        EXPECT_TRUE(test::contains(said, "A9-0.id.npy"));
        EXPECT_EQ(said.find('\n'), std::string::npos);
    };
    broken("", "is not an array");
    broken("hello, world", "is not an array");
    broken(std::string_view("\x93NUMPY\x01\x00\xff\xff{", 11), "ends within its header");
    broken(std::string_view("\x93NUMPY\x01\x00\x02\x00{}", 12), "has a header without");
    const std::size_t rays = answered_batches(*select_cases({"A9"}).front(), 40).front().rays.size();
    write_npy(id_file, std::vector<std::int32_t>(rays + 1, -1));
    EXPECT_TRUE(test::contains(message(), "is of shape"));
    write_npy(id_file, std::vector<float>(rays, 0));
    EXPECT_TRUE(test::contains(message(), "holds numbers of type '<f4'"));
    for (const std::int32_t id : {65, -3}) {
        write_npy(id_file, std::vector<std::int32_t>(rays, id));
        EXPECT_TRUE(test::contains(message(), "ray 0 hits primitive " + std::to_string(id)));
    }
    const Bytes whole = read_file(folder.file("exact/A9-0.id.npy"));
    write_file(id_file, std::span(whole).first(whole.size() - 1), Durability::written);
    EXPECT_TRUE(test::contains(message(), "bytes of numbers"));
    for (const char* text : {"", "{}", "[1, 2]", R"({"format": 1, "cases": []})",
                             R"({"format": 2, "cases": [{"id": "A9", "title": "", "watertight": false,
                                 "batches": [{"name": "../A9", "rays": 1, "primitives": 1}]}]})"}) {
        write_file(folder.file("manifest.json"), std::string_view(text), Durability::written);
        EXPECT_TRUE(test::contains(message(), "manifest.json: ")) << text;
    }
    fs::remove(folder.file("manifest.json"));
    EXPECT_TRUE(test::contains(message(), "manifest.json"));
}

TEST(Exchange, NoAnswersAtAllAreAnError) {
    test::TemporaryFolder folder;
    export_to(folder, {"A9"});
    const std::string said = test::input_error([&] { (void)check_answers(folder.file("answers")); });
    EXPECT_TRUE(test::contains(said, "no case is answered"));
}

}  // namespace
}  // namespace tandem::hard

#include "effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "loop_backend.h"
#include "support/input_error.h"
#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/images/image_codecs.h"
#include "tandem/report/html_writer.h"
#include "tandem/report/json_writer.h"

namespace tandem::bench {
namespace {

const std::string glass = std::string(TANDEM_SCENES) + "/glass.gltf";

EffectsOptions small_effects() {
    EffectsOptions options;
    options.scenes = {glass};
    options.backends = {"cpu"};
    options.size = {24, 20};
    options.samples = 2;
    options.repetitions = 2;
    return options;
}

const BenchmarkRow* row_named(const Report& report, const std::string& label) {
    const auto row = std::find_if(report.rows.begin(), report.rows.end(),
                                  [&](const BenchmarkRow& one) { return one.label == label; });
    return row == report.rows.end() ? nullptr : &*row;
}

TEST(EffectLedger, PlansEachEffectThatTheSceneNeeds) {
    const LedgerPlan plan = plan_ledger(load_scene(glass));
    const EffectMask called = Effect::shadows | Effect::refraction | Effect::absorption | Effect::nested_media;
    EXPECT_EQ(mask_of(plan.needs), called);
    std::vector<std::string> names;
    for (const LedgerArm& arm : plan.arms) names.push_back(arm.name());
    EXPECT_EQ(names, (std::vector<std::string>{"whole", "all effects carried", "without shadows", "without refraction",
                                               "without absorption", "without nested_media", "none", "shadows alone",
                                               "refraction alone"}));
    EXPECT_EQ(plan.dependent, (std::vector<Effect>{Effect::absorption, Effect::nested_media}));
}

TEST(EffectLedger, ASceneWithoutEffectsHasNothingToLeaveOut) {
    const LedgerPlan plan = plan_ledger(load_scene("named:paper"));
    EXPECT_TRUE(plan.needs.empty());
    EXPECT_EQ(plan.arms.size(), 2U);
    EffectsOptions options = small_effects();
    options.scenes = {"named:paper"};
    Report report;
    EXPECT_TRUE(run_effects(options, BackendSource{}, report)) << prose_of(report);
    EXPECT_NE(prose_of(report).find("nothing to leave out"), std::string::npos);
    EXPECT_EQ(report.rows.size(), 2U);
}

TEST(EffectLedger, SaysWhatEachEffectChangedAndWhatWasDrawn) {
    Report report;
    ASSERT_TRUE(run_effects(small_effects(), BackendSource{}, report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 9U);
    for (const char* effect : {"shadows", "refraction", "absorption", "nested_media"}) {
        const BenchmarkRow* row = row_named(report, std::string("cpu strict, without ") + effect);
        ASSERT_NE(row, nullptr) << effect;
        EXPECT_GT(figure(*row, "RMSE"), 0) << effect;
        EXPECT_GT(figure(*row, "mean FLIP"), 0) << effect;
        EXPECT_LT(figure(*row, "mean FLIP"), 1) << effect;
        EXPECT_FALSE(row->effects.has_any(parse_effects(std::string("+") + effect).on)) << effect;
        EXPECT_EQ(row->seconds.size(), 2U);
        ASSERT_TRUE(row->factor);
        EXPECT_EQ(row->factor->over, "cpu strict, whole");
    }
    const BenchmarkRow* carried = row_named(report, "cpu strict, all effects carried");
    ASSERT_NE(carried, nullptr);
    EXPECT_EQ(carried->effects, all_effects - host_effects);
    EXPECT_EQ(figure(*carried, "RMSE"), 0);
    EXPECT_EQ(figure(*carried, "mean FLIP"), 0);
    EXPECT_GT(figure(*carried, "price of not specialising"), 0);
    const BenchmarkRow* alone = row_named(report, "cpu strict, refraction alone");
    ASSERT_NE(alone, nullptr);
    EXPECT_TRUE(alone->effects.has(Effect::refraction));
    EXPECT_FALSE(alone->effects.has(Effect::shadows));
    EXPECT_EQ(alone->factor->over, "cpu strict, none");
    EXPECT_EQ(property_of(report, "equal"), "true");
    EXPECT_FALSE(property_of(report, "price of not specialising " + glass + " cpu strict").empty());
    EXPECT_NE(property_of(report, "reason " + glass + " refraction").find("transmission"), std::string::npos);
}

TEST(EffectLedger, JsonAndPageHoldIt) {
    Report report;
    ASSERT_TRUE(run_effects(small_effects(), BackendSource{}, report));
    const auto json = nlohmann::json::parse(to_json(report));
    const auto& row = json["rows"][2];
    EXPECT_EQ(row["label"], "cpu strict, without shadows");
    EXPECT_EQ(row["scene"], glass);
    EXPECT_EQ(row["tier"], "strict");
    EXPECT_EQ(row["effects"].get<std::string>().find("shadows"), std::string::npos);
    EXPECT_GT(row["figures"]["RMSE"].get<double>(), 0);
    EXPECT_TRUE(row["figures"].contains("mean FLIP"));
    EXPECT_TRUE(row["phases"].contains("first compile"));
    for (const char* field : {"rays", "registers", "occupancy", "variant", "summary", "factor"}) {
        EXPECT_TRUE(row.contains(field)) << field;
    }
    const std::string page = to_html(report);
    std::size_t pictures = 0;
    for (std::size_t at = 0; (at = page.find("<img ", at)) != std::string::npos; ++at) ++pictures;
    EXPECT_EQ(pictures, 3 * 6U) << "three for each of four effects left out and two added in";
    EXPECT_NE(page.find("FLIP between the two"), std::string::npos);
}

TEST(EffectLedger, PicturesAreAsTheSceneSaysAndMapsAsTheyAre) {
    Report report;
    ASSERT_TRUE(run_effects(small_effects(), BackendSource{}, report));
    std::size_t grids = 0;
    for (const Block& block : report.blocks) {
        const auto* grid = std::get_if<PictureGrid>(&block);
        if (grid == nullptr) continue;
        ++grids;
        ASSERT_EQ(grid->pictures.size(), 3U);
        std::vector<Display> displays;
        for (const Picture& picture : grid->pictures) {
            displays.push_back(decode_png(std::as_bytes(std::span(picture.png)), picture.caption).display);
        }
        const Display of_scene = load_scene(glass).display;
        EXPECT_EQ(of_scene.transfer, TransferFunction::srgb);
        EXPECT_EQ(displays, (std::vector<Display>{of_scene, of_scene, {TransferFunction::linear}}));
    }
    EXPECT_EQ(grids, 6U);
}

TEST(EffectLedger, AnotherFilmOfAnotherBackendIsAnError) {
    EffectsOptions options = small_effects();
    options.backends = {"cpu", "cuda"};
    Report equal, different;
    EXPECT_TRUE(run_effects(options, loop_source(), equal)) << prose_of(equal);
    EXPECT_FALSE(run_effects(options, loop_source(spoil_the_gpu), different));
    EXPECT_NE(prose_of(different).find("cpu strict, whole and cuda strict, whole differ"), std::string::npos)
        << prose_of(different);
    EXPECT_EQ(property_of(different, "equal"), "false");
}

TEST(EffectLedger, AnotherFilmOfTheKernelThatCarriesAllIsAnError) {
    EffectsOptions options = small_effects();
    options.backends = {"cuda"};
    const auto spoils = [](const std::string&, const BackendOptions& made) {
        return made.specialise == Specialise::never;
    };
    Report report;
    EXPECT_FALSE(run_effects(options, loop_source(spoils), report));
    EXPECT_NE(prose_of(report).find("cuda strict, whole and cuda strict, all effects carried"), std::string::npos)
        << prose_of(report);
    options.tiers = {"fast"};
    Report fast;
    EXPECT_TRUE(run_effects(options, loop_source(spoils), fast)) << "fast promises no bits";
}

TEST(EffectLedger, RefusesWhatItCannotMeasure) {
    EffectsOptions options = small_effects();
    Report report;
    options.scenes.clear();
    const auto refusal = [&] { return test::input_error([&] { (void)run_effects(options, loop_source(), report); }); };
    EXPECT_TRUE(test::contains(refusal(), "effects needs a scene: name glTF files"));
    options.scenes = {"named:nothing"};
    EXPECT_TRUE(test::contains(refusal(), "nothing"));
    options = small_effects();
    options.tiers = {"sloppy"};
    EXPECT_TRUE(test::contains(refusal(), "no accuracy tier 'sloppy'"));
    options = small_effects();
    EXPECT_THROW((void)run_effects(options, loop_source([](const auto&, const auto&) { return false; }, "cpu"), report),
                 EnvironmentError);
}

}  // namespace
}  // namespace tandem::bench

#include "beside_mitsuba.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.h"

namespace tandem::bench {

BesideMitsuba time_beside_mitsuba(const BesideMitsubaOptions& options) {
    BesideMitsuba result;
    if (!std::filesystem::exists(options.script)) {
        result.why_not = fmt::format("not run: there is no {} here", options.script);
        return result;
    }
    std::filesystem::create_directories(options.folder);
    const std::string times = options.folder + "/beside-mitsuba.json";
    const int status = run_program({"python3", options.script, "--render", options.renderer, "--variant",
                                    options.variant, "--threads", fmt::format("{}", options.threads), "--repetitions",
                                    fmt::format("{}", options.repetitions), "--json", times});
    if (status != 0) {
        result.why_not = fmt::format("not run: python3 with {} for {} ended with status {}; its message is above",
                                     options.script, options.variant, status);
        return result;
    }
    const nlohmann::json measured = nlohmann::json::parse(std::ifstream(times));
    std::filesystem::remove(times);
    const auto fill = [&](BenchmarkRow& row, const char* program) {
        row.scene = "assets/scenes/whitted.gltf";
        row.backend = "cpu";
        row.threads = options.threads;
        row.samples = measured.at("samples").get<double>();
        row.seconds = measured.at(program).get<std::vector<double>>();
        for (std::size_t i = 0; i < row.seconds.size(); ++i) row.rounds.push_back(static_cast<std::int32_t>(i));
    };
    auto& [theirs, ours] = result.rows;
    fill(theirs, "mitsuba");
    theirs.label = fmt::format("Mitsuba {}, {}", measured.at("version").get<std::string>(), options.variant);
    fill(ours, "tandem");
    ours.label = "Tandem, strict";
    ours.tier = "strict";
    ours.variant = measured.at("variant").get<std::string>();
    return result;
}

}  // namespace tandem::bench

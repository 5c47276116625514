#include "beside_mitsuba.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.h"
#include "tandem/base/error.h"

namespace tandem::bench {

namespace {

constexpr int not_there = 77;  ///< the script's status if Mitsuba or a library that it needs is missing

}  // namespace

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
    if (status == not_there) {
        result.why_not =
            fmt::format("not run: Mitsuba's {} is not there; the message above says what is missing", options.variant);
        return result;
    }
    if (status != 0) throw EnvironmentError(fmt::format("'python3 {}' failed with status {}", options.script, status));
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

#include "first_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "run_program.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"

namespace tandem::bench {

BenchmarkRow time_first_picture(const FirstPictureOptions& options) {
    std::filesystem::create_directories(options.folder);
    const std::string picture = options.folder + "/first-picture.png", times = options.folder + "/first-picture.json";
    BenchmarkRow row;
    row.scene = options.scene;
    row.backend = options.backend;
    for (int round = -1; round < options.repetitions; ++round) {
        const Stopwatch watch;
        const std::vector<std::string> words = {options.program, options.scene, "--backend", options.backend,
                                                "--output",      picture,       "--force",   "--quiet",
                                                "--json",        times};
        if (run_program(words) != 0) {
            throw EnvironmentError(fmt::format("'{}' failed; run it to see why", fmt::join(words, " ")));
        }
        if (round < 0) continue;
        row.seconds.push_back(watch.seconds());
        row.rounds.push_back(round);
        const nlohmann::json frame = nlohmann::json::parse(std::ifstream(times)).at("frames").at(0);
        row.variant = frame.at("variant").get<std::string>();
        for (const auto& [name, seconds] : frame.at("seconds").items()) {
            phase(row, name).seconds.push_back(seconds.get<double>());
        }
    }
    std::filesystem::remove(picture);
    std::filesystem::remove(times);
    return row;
}

}  // namespace tandem::bench

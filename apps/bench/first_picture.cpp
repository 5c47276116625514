#include "first_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"

namespace tandem::bench {

namespace {

/// Runs a program to its end, with no output but its errors.
void run_program(std::vector<std::string> words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    int status = 0;
    const int error = ::posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ);
    if (error != 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        throw EnvironmentError(fmt::format("'{}' failed; run it to see why", fmt::join(words, " ")));
    }
}

}  // namespace

std::string renderer_beside() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "tandem-render";
    return std::filesystem::exists(program, error) ? program.string() : "";
}

BenchmarkRow time_first_picture(const FirstPictureOptions& options) {
    std::filesystem::create_directories(options.folder);
    const std::string picture = options.folder + "/first-picture.png", times = options.folder + "/first-picture.json";
    BenchmarkRow row;
    row.scene = options.scene;
    row.backend = options.backend;
    for (int round = -1; round < options.repetitions; ++round) {
        const Stopwatch watch;
        run_program({options.program, options.scene, "--backend", options.backend, "--output", picture, "--force",
                     "--quiet", "--json", times});
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

/// tandem-gltf prints what a glTF file contains and what is wrong with it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "apps/common/command_line.h"
#include "apps/common/run_main.h"
#include "apps/gltf/describe.h"
#include "tandem/base/whole_file.h"
#include "tandem/gltf/load_scene.h"

namespace tandem {

namespace {

void write_json(const nlohmann::ordered_json& json, const std::string& target) {
    const std::string text = json.dump(2) + "\n";
    if (target == "-") {
        std::fputs(text.c_str(), stdout);
    } else {
        write_file(target, text);
    }
}

int run_info(const std::string& scene_name, const std::string& json_target) {
    ImportReport report;
    const Scene scene = load_scene(scene_name, &report);
    const auto description = describe(scene_name, scene, report);
    if (json_target != "-") std::fputs(to_text(description).c_str(), stdout);
    if (!json_target.empty()) write_json(description, json_target);
    return exit_done;
}

int run_check(const std::string& scene_name, const std::string& json_target) {
    std::vector<std::string> problems;
    ImportReport report;
    try {
        const Scene scene = load_scene(scene_name, &report);
        for (const std::string& problem : problems_of(scene))
            problems.push_back(fmt::format("{}: {}", scene_name, problem));
    } catch (const InputError& error) {
        problems.push_back(error.what());
    }
    std::vector<std::string> notes;
    for (const ImportNote& note : report.notes()) {
        if (note.treatment != Treatment::rendered) notes.push_back(to_string(note));
    }
    if (!json_target.empty()) {
        write_json({{"file", scene_name}, {"fine", problems.empty()}, {"problems", problems}, {"notes", notes}},
                   json_target);
    }
    if (!problems.empty()) throw InputError(fmt::format("{}", fmt::join(problems, "\n")));
    if (json_target == "-") return exit_done;
    fmt::print("{}: fine\n", scene_name);
    for (const std::string& note : notes) fmt::print("  {}\n", note);
    return exit_done;
}

int run(int argc, char** argv) {
    CommandLine app(
        "Prints what a glTF file contains and what is wrong with it.\n"
        "Exit status: 0 fine, 2 wrong usage or input, 3 the machine lacks something.",
        "tandem-gltf");
    std::string scene;
    std::string json_target;
    const auto add = [&](const char* name, const char* what) {
        CommandLine command = app.command(name, what);
        command.option("SCENE", &scene, ".gltf or .glb file, or named:NAME").required();
        command.option("--json", &json_target, "Write the result to a JSON file; - is standard output");
        return command;
    };
    const CommandLine info = add("info", "Print what the scene contains and how Tandem renders it");
    add("check", "Print what prevents the scene from being rendered, and what is approximated or ignored");
    if (const auto status = app.parse(argc, argv)) return *status;
    return info.is_given() ? run_info(scene, json_target) : run_check(scene, json_target);
}

}  // namespace

}  // namespace tandem

int main(int argc, char** argv) {
    return tandem::run_main("tandem-gltf", [&] { return tandem::run(argc, argv); });
}

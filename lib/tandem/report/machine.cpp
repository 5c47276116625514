#include "tandem/report/machine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "tandem/base/processor_level.h"
#include "tandem_build_info.h"
#include "tandem_git_commit.h"

namespace tandem {

namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\"");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\"") - first + 1);
}

std::string value_in_file(const char* path, const std::string& key) {
    std::ifstream file(path);
    return value_of(file, key);
}

std::string describe_system() {
    std::string name = value_in_file("/etc/os-release", "PRETTY_NAME");
    utsname kernel{};
    if (uname(&kernel) == 0) name += fmt::format("{}{} {}", name.empty() ? "" : ", ", kernel.sysname, kernel.release);
    return name;
}

std::optional<double> read_core_quota() {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    return parse_core_quota({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace

std::string value_of(std::istream& text, const std::string& key) {
    std::string line;
    while (std::getline(text, line)) {
        const auto separator = line.find_first_of(":=");
        if (separator != std::string::npos && trimmed(line.substr(0, separator)) == key) {
            return trimmed(line.substr(separator + 1));
        }
    }
    return {};
}

std::optional<double> parse_core_quota(const std::string& text) {
    std::istringstream words(text);
    double quota = 0, period = 0;
    if (!(words >> quota >> period) || quota <= 0 || period <= 0) return std::nullopt;
    return quota / period;
}

std::vector<std::string> supported_instruction_sets() {
    std::vector<std::string> sets;
    for (int level = 2; level <= x86_64_level(); ++level) sets.push_back(fmt::format("x86-64-v{}", level));
    return sets;
}

Machine describe_machine() {
    Machine machine;
    machine.processor = value_in_file("/proc/cpuinfo", "model name");
    machine.cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.core_quota = read_core_quota();
    machine.instruction_sets = supported_instruction_sets();
    machine.memory_bytes = 1024 * std::strtoull(value_in_file("/proc/meminfo", "MemTotal").c_str(), nullptr, 10);
    machine.system = describe_system();
    machine.compiler = TANDEM_BUILD_COMPILER;
    machine.flags = TANDEM_BUILD_FLAGS;
    machine.commit = TANDEM_GIT_COMMIT;
    if (getloadavg(machine.load.data(), 3) != 3) machine.load = {};
    return machine;
}

std::vector<std::pair<std::string, std::string>> facts(const Machine& machine) {
    std::string cores = fmt::format("{}", machine.cores);
    if (machine.core_quota) cores += fmt::format(", limited to the time of {:.3g}", *machine.core_quota);
    std::vector<std::pair<std::string, std::string>> all = {
        {"Processor", machine.processor},
        {"Cores", cores},
        {"Instruction sets", fmt::format("{}", fmt::join(machine.instruction_sets, ", "))},
        {"Memory", fmt::format("{:.1f} GiB", static_cast<double>(machine.memory_bytes) / (1 << 30))},
        {"System", machine.system},
    };
    all.insert(all.end(), machine.more.begin(), machine.more.end());
    all.insert(all.end(), {{"Compiler", machine.compiler},
                           {"Flags", machine.flags},
                           {"Source", machine.commit},
                           {"Load average at the start", fmt::format("{:.2f}", fmt::join(machine.load, ", "))}});
    return all;
}

}  // namespace tandem

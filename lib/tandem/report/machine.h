/// Describes the machine of a measurement.
#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tandem {

struct Machine {
    std::string processor;                      ///< model name
    int cores = 0;                              ///< logical cores that this process may run on
    std::optional<double> core_quota;           ///< CPU time, in cores, that the container allows, if it sets a limit
    std::vector<std::string> instruction_sets;  ///< "x86-64-v2", "x86-64-v3", "x86-64-v4": those it has
    std::uint64_t memory_bytes = 0;
    std::string system;  ///< distribution and kernel
    std::string compiler;
    std::string flags;                                      ///< of the host code except the CPU kernels
    std::string commit;                                     ///< of the source; "unknown" outside a git checkout
    std::array<double, 3> load{};                           ///< load averages over 1, 5 and 15 minutes at the start
    std::vector<std::pair<std::string, std::string>> more;  ///< devices and libraries, added by the caller
};

[[nodiscard]] Machine describe_machine();

/// Name and value, in the order of a page.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> facts(const Machine& machine);

/// "x86-64-v2", "-v3" and "-v4" as far as processor and system support them.
[[nodiscard]] std::vector<std::string> supported_instruction_sets();

/// The first value of `key` in a text of lines "key : value" (/proc/cpuinfo, /proc/meminfo); empty if the key is
/// missing.
[[nodiscard]] std::string value_of(std::istream& text, const std::string& key);

/// The limit, in cores, from the text of a cgroup's cpu.max ("400000 100000" is 4); empty if there is none.
[[nodiscard]] std::optional<double> parse_core_quota(const std::string& text);

}  // namespace tandem

#include "tandem/base/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "tandem/base/error.h"

namespace tandem {

namespace {

/// The number in a file; empty if the file holds anything else, such as "max".
std::optional<std::size_t> number_in(const char* path) {
    std::ifstream file(path);
    std::size_t number = 0;
    if (!(file >> number)) return std::nullopt;
    return number;
}

/// A line "NAME:  123 kB" of /proc/meminfo.
std::optional<std::size_t> meminfo(const std::string& name) {
    std::ifstream file("/proc/meminfo");
    std::string word;
    while (file >> word) {
        std::size_t kibibytes = 0;
        if (word == name + ":" && file >> kibibytes) return kibibytes * 1024;
        file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return std::nullopt;
}

/// The memory that is left within the control group's limit. Cached pages of files count as used, but can be reclaimed.
std::optional<std::size_t> left_in_group() {
    const auto limit = number_in("/sys/fs/cgroup/memory.max");
    const auto used = number_in("/sys/fs/cgroup/memory.current");
    if (!limit || !used) return std::nullopt;
    std::size_t of_files = 0;
    std::ifstream statistics("/sys/fs/cgroup/memory.stat");
    std::string name;
    std::size_t bytes = 0;
    while (statistics >> name >> bytes) {
        if (name == "active_file" || name == "inactive_file") of_files += bytes;
    }
    const std::size_t kept = *used - std::min(*used, of_files);
    return *limit - std::min(*limit, kept);
}

}  // namespace

std::optional<std::size_t> available_memory() {
    const auto of_system = meminfo("MemAvailable"), of_group = left_in_group();
    if (of_system && of_group) return std::min(*of_system, *of_group);
    return of_system ? of_system : of_group;
}

void require_memory(std::size_t needed, std::size_t available, const std::string& what, const std::string& where) {
    if (needed <= available) return;
    const auto text = [](std::size_t bytes) {
        constexpr std::size_t mebibyte = std::size_t{1} << 20, gibibyte = std::size_t{1} << 30;
        const bool is_small = bytes < gibibyte;
        return fmt::format("{:.1f} {}", static_cast<double>(bytes) / (is_small ? mebibyte : gibibyte),
                           is_small ? "MiB" : "GiB");
    };
    throw EnvironmentError(
        fmt::format("{} needs at least {} of {}, but {} are free; make it smaller, or use a machine with more", what,
                    text(needed), where, text(available)));
}

void require_memory(std::size_t needed, const std::string& what) {
    if (const auto available = available_memory()) require_memory(needed, *available, what, "memory");
}

}  // namespace tandem

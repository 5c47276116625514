#include "tandem/report/format_number.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace tandem {

namespace {

struct Unit {
    double size;
    const char* name;
};

/// Uses the largest unit that gives at least 1; smaller values get the last unit.
template <std::size_t count>
std::string in_units(double value, const std::array<Unit, count>& largest_first) {
    const Unit* fitting = &largest_first.back();
    for (const Unit& unit : largest_first) {
        if (std::abs(value) >= unit.size) {
            fitting = &unit;
            break;
        }
    }
    const std::string number = format_number(value / fitting->size);
    return *fitting->name == '\0' ? number : number + " " + fitting->name;
}

}  // namespace

std::string format_seconds(double seconds) {
    static constexpr std::array<Unit, 4> units = {{{1, "s"}, {1e-3, "ms"}, {1e-6, "µs"}, {1e-9, "ns"}}};
    return seconds == 0 ? "0" : in_units(seconds, units);
}

std::string format_count(double count) {
    static constexpr std::array<Unit, 4> units = {{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}}};
    return in_units(count, units);
}

std::string format_number(double value) {
    if (!std::isfinite(value)) return fmt::format("{}", value);
    if (std::abs(value) < 1000) return fmt::format("{:.3g}", value);
    std::string digits = fmt::format("{:.0f}", value);
    const std::size_t first = digits[0] == '-' ? 1 : 0;
    for (std::size_t at = digits.size(); at > first + 3;) digits.insert(at -= 3, 1, ',');
    return digits;
}

std::string format_share(double share) { return share == 0 ? "0" : fmt::format("{:.3g} %", 100 * share); }

std::string format_summary(const Summary& seconds) {
    if (seconds.count == 0) return "not measured";
    if (seconds.count == 1) return format_seconds(seconds.median);
    return format_seconds(seconds.median) + " ± " + format_seconds(seconds.deviation);
}

std::string format_ratio(const Ratio& ratio) {
    if (!ratio.interval) return format_number(ratio.value);
    return fmt::format("{} ({} to {})", format_number(ratio.value), format_number(ratio.interval->low),
                       format_number(ratio.interval->high));
}

}  // namespace tandem

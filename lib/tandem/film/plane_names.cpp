#include "tandem/film/plane_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tandem/base/error.h"

namespace tandem {

namespace {

/// The parts between commas; without a comma the whole text, which may be empty.
std::vector<std::string> split_at_commas(std::string_view text) {
    std::vector<std::string> parts;
    while (true) {
        const std::size_t end = std::min(text.find(','), text.size());
        parts.emplace_back(text.substr(0, end));
        if (end == text.size()) return parts;
        text.remove_prefix(end + 1);
    }
}

std::vector<std::string> names_of(PlaneMask planes) {
    std::vector<std::string> names;
    for (const PlaneInfo& info : plane_infos()) {
        if (planes.has(info.plane)) names.emplace_back(info.name);
    }
    return names;
}

PlaneMask all_planes() {
    PlaneMask all;
    for (const PlaneInfo& info : plane_infos()) all |= info.plane;
    return all;
}

}  // namespace

const std::vector<PlaneInfo>& plane_infos() {
    static const std::vector<PlaneInfo> infos = {
#define TANDEM_PLANE(name, Value, rule, channels, help) \
    {FilmPlane::name, #name, PlaneRule::rule, split_at_commas(channels), help},
#include "tandem/film/planes.def"
#undef TANDEM_PLANE
    };
    return infos;
}

const PlaneInfo& info_of(FilmPlane plane) { return plane_infos()[static_cast<std::size_t>(plane)]; }

std::string to_string(PlaneMask planes) { return fmt::format("{}", fmt::join(names_of(planes), ",")); }

PlaneMask parse_planes(std::string_view text) {
    PlaneMask planes;
    for (const std::string& word : split_at_commas(text)) {
        const auto& infos = plane_infos();
        const auto found =
            std::find_if(infos.begin(), infos.end(), [&](const PlaneInfo& info) { return word == info.name; });
        if (found != infos.end()) {
            planes |= found->plane;
        } else if (word == "all") {
            planes |= all_planes();
        } else {
            throw InputError(
                fmt::format("there is no plane '{}'; the planes are {}; separate them by commas, or use all", word,
                            fmt::join(names_of(all_planes()), ", ")));
        }
    }
    return planes;
}

}  // namespace tandem

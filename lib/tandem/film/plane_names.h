/// Planes of films by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/film/film_planes.h"

namespace tandem {

struct PlaneInfo {
    FilmPlane plane;
    const char* name;
    PlaneRule rule;
    std::vector<std::string> channels;  ///< their names in an EXR
    const char* help;
};

/// In the order of planes.def.
[[nodiscard]] const std::vector<PlaneInfo>& plane_infos();
[[nodiscard]] const PlaneInfo& info_of(FilmPlane plane);

/// "albedo,normal", in the order of planes.def; empty for none.
[[nodiscard]] std::string to_string(PlaneMask planes);

/// Parses names separated by commas, in any order, or "all". Throws InputError that lists the names.
[[nodiscard]] PlaneMask parse_planes(std::string_view text);

}  // namespace tandem

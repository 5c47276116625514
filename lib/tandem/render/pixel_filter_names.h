/// The names of the filters of the picture (kernel/sampler/pixel_filters.def).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/kernel/sampler/pixel_filter.h"

namespace tandem {

struct PixelFilterInfo {
    PixelFilter filter;
    const char* name;
    double radius;  ///< in pixels
    const char* help;
};

/// All filters, box first.
[[nodiscard]] const std::vector<PixelFilterInfo>& pixel_filter_infos();

[[nodiscard]] std::string to_string(PixelFilter filter);

/// Throws InputError that lists the filters there are.
[[nodiscard]] PixelFilter parse_pixel_filter(std::string_view name);

}  // namespace tandem

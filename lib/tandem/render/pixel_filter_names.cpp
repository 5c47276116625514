#include "tandem/render/pixel_filter_names.h"

#include "tandem/base/find_name.h"

namespace tandem {

const std::vector<PixelFilterInfo>& pixel_filter_infos() {
    static const std::vector<PixelFilterInfo> infos = {
#define TANDEM_PIXEL_FILTER(name, radius, help) {PixelFilter::name, #name, radius, help},
#include "tandem/kernel/sampler/pixel_filters.def"
#undef TANDEM_PIXEL_FILTER
    };
    return infos;
}

std::string to_string(PixelFilter filter) { return pixel_filter_infos()[static_cast<std::size_t>(filter)].name; }

PixelFilter parse_pixel_filter(std::string_view name) { return find_name(pixel_filter_infos(), name, "filter").filter; }

}  // namespace tandem

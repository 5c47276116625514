#include "tandem/gltf/budget.h"

#include <fmt/format.h>

#include <algorithm>

namespace tandem::gltf {

Budget::Budget(const Source& source) : whole_(std::max<std::size_t>(5'000'000, data_bytes(source))), left_(whole_) {}

void Budget::spend(const Document& document, const std::string& json_path, std::size_t amount) {
    if (amount > left_) {
        document.refuse(json_path,
                        fmt::format("brings the elements read from accessors to more than {}, the limit for a "
                                    "file of this size; repeat the data less often",
                                    whole_));
    }
    left_ -= amount;
}

}  // namespace tandem::gltf

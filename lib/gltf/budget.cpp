#include "tandem/gltf/budget.h"

#include <algorithm>

namespace tandem::gltf {

Budget::Budget(const Source& source) : left_(10'000'000) {
    std::size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : source.model.buffers) bytes += buffer.data.size();
    left_ = std::max(left_, bytes);
}

void Budget::spend(const Document& document, const std::string& json_path, std::size_t amount) {
    if (amount > left_) {
        document.fail(json_path, "repeats the data of the file more than ten million times over; split the file");
    }
    left_ -= amount;
}

}  // namespace tandem::gltf

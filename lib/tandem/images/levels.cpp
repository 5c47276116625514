#include "tandem/images/levels.h"

#include "tandem/math/srgb.h"

namespace tandem {

std::vector<float> texture_levels() {
    std::vector<float> levels;
    levels.reserve(512);
    for (int level = 0; level < 256; ++level) levels.push_back(narrow(linear_of_srgb(level / 255.0)));
    for (int level = 0; level < 256; ++level) levels.push_back(narrow(level / 255.0));
    return levels;
}

}  // namespace tandem

#include "tandem/texture/levels.h"

#include "tandem/math/exact_math.h"

namespace tandem {

std::vector<float> texture_levels() {
    std::vector<float> levels;
    levels.reserve(512);
    for (int level = 0; level < 256; ++level) {
        const double c = level / 255.0;
        levels.push_back(narrow(c <= 0.04045 ? c / 12.92 : power<float>((c + 0.055) / 1.055, 2.4)));
    }
    for (int level = 0; level < 256; ++level) levels.push_back(narrow(level / 255.0));
    return levels;
}

}  // namespace tandem

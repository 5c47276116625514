/// What people type for sizes and frames.
#pragma once

#include <cstdint>
#include <string_view>

#include "tandem/scene/scene.h"

namespace tandem {

struct FilmSize {
    int width = 0;
    int height = 0;
};

/// "WxH", in pixels. Throws InputError.
[[nodiscard]] FilmSize parse_size(std::string_view text);

/// Both included.
struct FrameRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

/// "K", "A-B" with A at most B, or "all": from 0 to the end of the scene's animation. Throws InputError.
[[nodiscard]] FrameRange parse_frames(std::string_view text, const Scene& scene);

}  // namespace tandem

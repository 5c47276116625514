/// The output of tandem-render for each frame: a line of text, or JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "render/render_sequence.h"

namespace tandem {

/// "frame 12  SHA-256  FILE", with "  kept" if the file was there before, and the counters that are not zero.
[[nodiscard]] std::string frame_line(const FrameRecord& record);

/// The fields of the metadata, then file, skipped, variant, effects, seconds by phase, and counters.
[[nodiscard]] nlohmann::ordered_json frame_json(const FrameRecord& record);

}  // namespace tandem

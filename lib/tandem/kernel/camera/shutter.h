/// The shutter of an authored camera.
#pragma once

namespace tandem {

/// Open between two times, in seconds after that of the frame; either may be negative. A shutter that closes as it
/// opens sees the scene as it is at the time of the frame.
struct Shutter {
    double open = 0;
    double close = 0;   ///< `open` or later
    int instants = 16;  ///< the most instants of the interval that make up a frame, 1 to 1024 (render/motion_blur.h)
};

[[nodiscard]] inline bool is_open(const Shutter& shutter) { return shutter.close > shutter.open; }

}  // namespace tandem

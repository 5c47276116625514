/// The shutter of a camera, as authored.
#pragma once

namespace tandem {

/// Open between two times, in seconds relative to the time of the frame; either may be negative. With `close` equal to
/// `open` there is no motion blur, and the camera sees the scene at the time of the frame.
struct Shutter {
    double open = 0;
    double close = 0;   ///< `open` or later
    int instants = 16;  ///< the maximum number of instants per frame, 1 to 1024 (render/motion_blur.h)
};

[[nodiscard]] inline bool is_open(const Shutter& shutter) { return shutter.close > shutter.open; }

}  // namespace tandem

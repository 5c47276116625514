/// The paper's figures (docs/paper.md), to compare with the measured ones.
#pragma once

namespace tandem::bench::paper {

inline constexpr double cpu_frame_seconds = 35.3294;
inline constexpr double gpu_frame_seconds = 0.2256;
inline constexpr double kernel_seconds = 0.00472;
inline constexpr double claimed_factor = 139;  ///< "at least 139 times"
inline constexpr double claimed_frames_per_second = 12711;
inline constexpr double residual_rate = 0.05;

// Derived from the paper's numbers.
inline constexpr double factor = cpu_frame_seconds / gpu_frame_seconds;
inline constexpr double frames_per_second = 1 / kernel_seconds;
inline constexpr double frames_per_minute = 60 / kernel_seconds;
inline constexpr double share_outside_kernel = (gpu_frame_seconds - kernel_seconds) / gpu_frame_seconds;

}  // namespace tandem::bench::paper

/// The paper's method, reimplemented plainly as a baseline: one scene in the code, floats, a random state per pixel, an
/// image as text. naive_core.h has the method, naive_cpu.cpp and naive_kernel.cu its loops.
#pragma once

#include <string>

namespace tandem::bench {

/// The moving parts of frame `number` of docs/paper.md: metres, world space.
struct NaiveFrame {
    float light[3];
    float cube[3];  ///< centre
};

[[nodiscard]] NaiveFrame naive_frame(int number);

struct NaiveJob {
    int width = 1000;
    int height = 900;
    int samples = 100;
    int frame = 0;
    unsigned int sequence = 0;  ///< of random numbers; 0 seeds 1984 + pixel as the paper did, in every frame
};

/// The same source, compiled in one of several ways.
struct NaiveBuild {
    const char* flags;  ///< "-O0" or "-O3"
    bool optimised;     ///< as the compiler's macros say
    /// Colours of row `y` from the top: 3 * width floats.
    void (*render_row)(const NaiveJob& job, const NaiveFrame& frame, int y, float* rgb);
    /// What the ray through the centre of a pixel hits: 0 to 2 a sphere, 3 the cube, -1 nothing.
    int (*object_at_centre)(const NaiveJob& job, const NaiveFrame& frame, int x, int y);
};

extern const NaiveBuild naive_o0;
extern const NaiveBuild naive_o3;

/// `rgb`: 3 * width * height floats, from the top left. One thread renders row after row; several share the rows.
void naive_render(const NaiveBuild& build, const NaiveJob& job, int threads, float* rgb);

/// P3 text, 0 to 255, as the paper wrote it: a number at a time. Throws EnvironmentError.
void naive_write_ppm(const std::string& path, int width, int height, const float* rgb);

/// Seconds of one frame as the paper timed it.
struct NaiveGpuTimes {
    double allocate = 0;
    double random_init = 0;  ///< kernel that seeds a state per pixel
    double kernel = 0;       ///< kernel that renders
    double download = 0;
    double release = 0;
};

/// Why the CUDA version cannot run, or empty if it can.
[[nodiscard]] std::string naive_gpu_why_unavailable();

/// One frame on the GPU: allocation, seeding, 16 x 16 blocks, copy back, release. Throws EnvironmentError.
[[nodiscard]] NaiveGpuTimes naive_gpu_render(const NaiveJob& job, float* rgb);

}  // namespace tandem::bench

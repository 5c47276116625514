// The loops of the host. Compiled twice (CMakeLists.txt): with -O0 as naive_o0 and with -O3 as naive_o3.
#if defined(NAIVE_BUILD_O0)
#define NAIVE_NAMESPACE naive_o0_code
#define NAIVE_BUILD naive_o0
#define NAIVE_FLAGS "-O0"
#else
#define NAIVE_NAMESPACE naive_o3_code
#define NAIVE_BUILD naive_o3
#define NAIVE_FLAGS "-O3"
#endif

#include "naive_core.h"

namespace NAIVE_NAMESPACE {

using tandem::bench::NaiveJob;

static void render_row(const NaiveJob& job, const NaiveFrame& frame, int y, float* rgb) {
    for (int x = 0; x < job.width; x++) {
        RandomState random = random_init(pixel_seed(y * job.width + x, job.sequence));
        const Vec3 colour = pixel_colour(frame, x, y, job.width, job.height, job.samples, random);
        rgb[3 * x] = colour.x;
        rgb[3 * x + 1] = colour.y;
        rgb[3 * x + 2] = colour.z;
    }
}

static int object_at_centre(const NaiveJob& job, const NaiveFrame& frame, int x, int y) {
    const Camera camera((float)job.width / (float)job.height);
    const float u = ((float)x + 0.5f) / (float)job.width;
    const float v = ((float)(job.height - 1 - y) + 0.5f) / (float)job.height;
    float t;
    return nearest(frame, camera.get_ray(u, v), t);
}

#if defined(__OPTIMIZE__)
static const bool optimised = true;
#else
static const bool optimised = false;
#endif

}  // namespace NAIVE_NAMESPACE

namespace tandem::bench {

const NaiveBuild NAIVE_BUILD = {NAIVE_FLAGS, NAIVE_NAMESPACE::optimised, NAIVE_NAMESPACE::render_row,
                                NAIVE_NAMESPACE::object_at_centre};

}  // namespace tandem::bench

// The paper's kernel: one thread a pixel, 16 x 16 blocks, a random state per pixel in global memory, and memory that
// is allocated for every frame. Compiled with nvcc's own defaults (contraction on), as the paper's was.
#include <cuda_runtime.h>

#include <chrono>
#include <string>

#define NAIVE_NAMESPACE naive_cuda_code
#include "naive_core.h"
#include "tandem/base/error.h"

namespace NAIVE_NAMESPACE {

__global__ void init_random(RandomState* states, int width, int height, unsigned int sequence) {
    const int x = (int)(threadIdx.x + blockIdx.x * blockDim.x);
    const int y = (int)(threadIdx.y + blockIdx.y * blockDim.y);
    if (x >= width || y >= height) return;
    const int pixel = y * width + x;
    states[pixel] = random_init(pixel_seed(pixel, sequence));
}

__global__ void render(float* rgb, RandomState* states, NaiveFrame frame, int width, int height, int samples) {
    const int x = (int)(threadIdx.x + blockIdx.x * blockDim.x);
    const int y = (int)(threadIdx.y + blockIdx.y * blockDim.y);
    if (x >= width || y >= height) return;
    const int pixel = y * width + x;
    RandomState random = states[pixel];
    const Vec3 colour = pixel_colour(frame, x, y, width, height, samples, random);
    states[pixel] = random;
    rgb[3 * pixel] = colour.x;
    rgb[3 * pixel + 1] = colour.y;
    rgb[3 * pixel + 2] = colour.z;
}

}  // namespace NAIVE_NAMESPACE

namespace tandem::bench {

namespace {

using Clock = std::chrono::steady_clock;

void check(cudaError_t status, const char* what) {
    if (status == cudaSuccess) return;
    throw EnvironmentError(std::string("the naive CUDA renderer cannot ") + what + ": " + cudaGetErrorString(status));
}

/// Seconds since `start`, which becomes now.
double lap(Clock::time_point& start) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    start = now;
    return seconds;
}

template <class T>
class DeviceArray {
  public:
    explicit DeviceArray(std::size_t count) { check(cudaMalloc(&data_, count * sizeof(T)), "allocate memory"); }
    ~DeviceArray() { cudaFree(data_); }
    DeviceArray(const DeviceArray&) = delete;
    DeviceArray& operator=(const DeviceArray&) = delete;
    T* data() const { return data_; }

  private:
    T* data_ = nullptr;
};

class Event {
  public:
    Event() { check(cudaEventCreate(&event_), "create an event"); }
    ~Event() { cudaEventDestroy(event_); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    void record() const { check(cudaEventRecord(event_), "record an event"); }
    /// Seconds from the event `start` to this one; waits for both.
    double seconds_since(const Event& start) const {
        check(cudaEventSynchronize(event_), "finish its kernels");
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "read an event");
        return 1e-3 * double{milliseconds};
    }

  private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace

std::string naive_gpu_why_unavailable() {
    int count = 0;
    const cudaError_t status = cudaGetDeviceCount(&count);
    if (status != cudaSuccess) return std::string("no CUDA device can be used: ") + cudaGetErrorString(status);
    return count == 0 ? "there is no CUDA device" : "";
}

NaiveGpuTimes naive_gpu_render(const NaiveJob& job, float* rgb) {
    using namespace naive_cuda_code;
    const auto pixels = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
    const NaiveFrame frame = naive_frame(job.frame);
    const dim3 block(16, 16);
    const dim3 grid((unsigned int)(job.width + 15) / 16, (unsigned int)(job.height + 15) / 16);
    const Event start, seeded, rendered;
    NaiveGpuTimes times;
    auto mark = Clock::now();
    {
        const DeviceArray<float> image(3 * pixels);
        const DeviceArray<RandomState> states(pixels);
        times.allocate = lap(mark);
        start.record();
        init_random<<<grid, block>>>(states.data(), job.width, job.height, job.sequence);
        seeded.record();
        render<<<grid, block>>>(image.data(), states.data(), frame, job.width, job.height, job.samples);
        check(cudaGetLastError(), "start its kernels");
        rendered.record();
        times.random_init = seeded.seconds_since(start);
        times.kernel = rendered.seconds_since(seeded);
        lap(mark);
        check(cudaMemcpy(rgb, image.data(), 3 * pixels * sizeof(float), cudaMemcpyDeviceToHost), "copy the picture");
        times.download = lap(mark);
    }
    times.release = lap(mark);
    return times;
}

}  // namespace tandem::bench

/// Streams and events, owned.
#pragma once

#include <utility>

#include "cuda/cuda_error.h"

namespace tandem::cuda {

/// A timed event in a stream.
class Event {
  public:
    Event() { check(cudaEventCreate(&handle_), "creating an event"); }
    ~Event() { (void)cudaEventDestroy(handle_); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;

    void record(cudaStream_t stream) { check(cudaEventRecord(handle_, stream), "recording an event"); }
    void wait() const { check(cudaEventSynchronize(handle_), "waiting for the GPU"); }
    [[nodiscard]] cudaEvent_t get() const { return handle_; }

  private:
    cudaEvent_t handle_ = nullptr;
};

/// Seconds between two events that have happened.
[[nodiscard]] inline double seconds_between(const Event& start, const Event& end) {
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, start.get(), end.get()), "reading the time of a kernel or copy");
    return 1e-3 * static_cast<double>(milliseconds);
}

class Stream {
  public:
    enum class Priority { usual, first };

    /// `first`: kernels start before those that wait in other streams.
    explicit Stream(Priority priority = Priority::usual) {
        int least = 0, greatest = 0;
        check(cudaDeviceGetStreamPriorityRange(&least, &greatest), "asking for the priorities of streams");
        const int number = priority == Priority::first ? greatest : least;
        check(cudaStreamCreateWithPriority(&handle_, cudaStreamNonBlocking, number), "creating a stream");
    }
    ~Stream() { (void)cudaStreamDestroy(handle_); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    /// Work that is queued from now on starts after the event.
    void wait_for(const Event& event) { check(cudaStreamWaitEvent(handle_, event.get(), 0), "ordering streams"); }
    [[nodiscard]] cudaStream_t get() const { return handle_; }

  private:
    cudaStream_t handle_ = nullptr;
};

}  // namespace tandem::cuda

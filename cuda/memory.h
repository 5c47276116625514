/// Owners of GPU memory and of page-locked host memory, which is reused for the next frame.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "cuda/cuda_error.h"

namespace tandem::cuda {

struct DeviceMemory {
    static void* allocate(std::size_t bytes) {
        void* address = nullptr;
        check(cudaMalloc(&address, bytes), "allocating GPU memory");
        return address;
    }
    // a failure to free cannot be handled, and happens only when the driver shuts down
    static void release(void* address) { (void)cudaFree(address); }
};

struct PinnedMemory {
    static void* allocate(std::size_t bytes) {
        void* address = nullptr;
        check(cudaHostAlloc(&address, bytes, cudaHostAllocDefault), "allocating page-locked memory");
        return address;
    }
    static void release(void* address) { (void)cudaFreeHost(address); }
};

/// A block of memory that grows and never shrinks.
template <class Kind>
class Buffer {
  public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept : address_(std::exchange(other.address_, nullptr)), bytes_(other.bytes_) {}
    Buffer& operator=(Buffer&& other) noexcept {
        std::swap(address_, other.address_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~Buffer() {
        if (address_ != nullptr) Kind::release(address_);
    }

    /// Ensures at least `bytes`; the contents are lost if the block grows.
    void reserve(std::size_t bytes) {
        if (bytes <= bytes_) return;
        if (address_ != nullptr) Kind::release(std::exchange(address_, nullptr));
        bytes_ = 0;
        address_ = Kind::allocate(bytes);
        bytes_ = bytes;
    }
    [[nodiscard]] std::byte* data() const { return static_cast<std::byte*>(address_); }
    [[nodiscard]] std::size_t capacity() const { return bytes_; }

  private:
    void* address_ = nullptr;
    std::size_t bytes_ = 0;
};

/// Objects that are expensive to make: returned ones are reused. A lease may outlive the pool's owner.
template <class T>
class Pool : public std::enable_shared_from_this<Pool<T>> {
  public:
    /// Exclusive use of one, until the pointer is released.
    [[nodiscard]] std::shared_ptr<T> lease() {
        std::unique_ptr<T> item;
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                item = std::move(free_.back());
                free_.pop_back();
            }
        }
        if (!item) item = std::make_unique<T>();
        return std::shared_ptr<T>(item.release(), [pool = this->shared_from_this()](T* returned) {
            const std::lock_guard lock(pool->mutex_);
            pool->free_.emplace_back(returned);
        });
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_;
};

}  // namespace tandem::cuda

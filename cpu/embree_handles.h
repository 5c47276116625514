/// Owners of Embree's objects, and Embree's errors as exceptions.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "cpu/embree_api.h"
#include "tandem/base/error.h"

namespace tandem {

/// Owns an Embree handle.
template <class Handle, void (*release)(Handle)>
class EmbreeHandle {
  public:
    explicit EmbreeHandle(Handle handle = nullptr) : handle_(handle) {}
    EmbreeHandle(EmbreeHandle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    EmbreeHandle& operator=(EmbreeHandle&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~EmbreeHandle() {
        if (handle_ != nullptr) release(handle_);
    }
    Handle get() const { return handle_; }

  private:
    Handle handle_;
};
using EmbreeDevice = EmbreeHandle<RTCDevice, rtcReleaseDevice>;
using EmbreeScene = EmbreeHandle<RTCScene, rtcReleaseScene>;
using EmbreeGeometry = EmbreeHandle<RTCGeometry, rtcReleaseGeometry>;
using EmbreeTree = EmbreeHandle<RTCBVH, rtcReleaseBVH>;

/// Throws the error that Embree last reported on this thread, if there is one.
inline void check_embree(RTCDevice device, const char* doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw EnvironmentError(fmt::format("out of memory while {}", doing));
    throw std::runtime_error(fmt::format("Embree failed while {} (error {})", doing, static_cast<int>(error)));
}

/// User geometry whose user data is `data`, without its functions. Throws if there is not enough memory.
inline EmbreeGeometry user_geometry(RTCDevice device, void* data, unsigned int count) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    check_embree(device, "making a scene");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), count);
    rtcSetGeometryUserData(geometry.get(), data);
    return geometry;
}

}  // namespace tandem

#include "cuda/cuda_error.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "tandem/base/error.h"

namespace tandem::cuda {

const char* advice(cudaError_t code) {
    switch (code) {
        case cudaErrorMemoryAllocation:
            return "GPU memory or page-locked memory is full; render a smaller film or scene, or end other programs";
        case cudaErrorInsufficientDriver:
            return "the driver is missing or older than this build's CUDA; install a newer one";
        case cudaErrorNoDevice:
            return "there is no CUDA GPU";
        case cudaErrorNoKernelImageForDevice:
            return "this build has no code for this GPU; configure with -DCMAKE_CUDA_ARCHITECTURES=native";
        case cudaErrorDevicesUnavailable:
            return "another program uses the GPU exclusively; end that program";
        case cudaErrorSystemDriverMismatch:
        case cudaErrorCompatNotSupportedOnDevice:
        case cudaErrorUnsupportedPtxVersion:
            return "the driver does not fit this build's CUDA; install a newer one";
        default:
            return nullptr;
    }
}

void check(cudaError_t code, const char* doing) {
    if (code == cudaSuccess) return;
    const char* help = advice(code);
    const std::string message =
        fmt::format("CUDA failed while {}: {} ({}){}{}", doing, cudaGetErrorString(code), cudaGetErrorName(code),
                    help != nullptr ? "; " : "", help != nullptr ? help : "");
    if (help != nullptr) throw EnvironmentError(message);
    throw std::runtime_error(message);
}

}  // namespace tandem::cuda

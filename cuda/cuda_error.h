/// Error checks for all calls of the CUDA runtime.
#pragma once

#include <cuda_runtime_api.h>

namespace tandem::cuda {

/// Throws EnvironmentError if the machine lacks something (device, driver, memory), else std::runtime_error. The
/// message says what was being done, CUDA's name of the error, and what to do.
void check(cudaError_t code, const char* doing);

/// The message of check() for a code; empty for success.
[[nodiscard]] const char* advice(cudaError_t code);

}  // namespace tandem::cuda

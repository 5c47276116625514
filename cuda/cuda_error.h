/// Every call of the CUDA runtime goes through check().
#pragma once

#include <cuda_runtime_api.h>

namespace tandem::cuda {

/// Throws EnvironmentError for what the machine lacks (device, driver, memory), std::runtime_error for the rest; the
/// message says what was being done, CUDA's name for the error and what to do.
void check(cudaError_t code, const char* doing);

/// The sentence of check() for a code, or empty for success.
[[nodiscard]] const char* advice(cudaError_t code);

}  // namespace tandem::cuda

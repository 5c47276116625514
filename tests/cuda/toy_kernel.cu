#include "cuda/toy_kernel.h"

extern "C" {

extern __device__ const tandem::test::ToyFacts toy_facts;

__global__ void toy_kernel(const float* __restrict__ in, float* __restrict__ out, std::uint32_t count) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < count) out[i] = tandem::test::toy_value(toy_facts, in[i]);
}

/// Another, to see that it is left out.
__global__ void unused_kernel(float* out) { out[threadIdx.x] = static_cast<float>(toy_facts.lights); }
}

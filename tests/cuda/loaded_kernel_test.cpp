// Specialised kernels on a GPU: the bits of the host.
#include "cuda/loaded_kernel.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "cuda/cubin_facts.h"
#include "cuda/cuda_backend.h"
#include "cuda/memory.h"
#include "cuda/toy_input.h"
#include "support/random.h"

namespace tandem::cuda {
namespace {

using namespace tandem::test;
using ToyKernel = LoadedCode;  // its parameters: const float*, float*, std::uint32_t

class LoadedKernelOn : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
        if (!why_jit_unavailable().empty()) GTEST_SKIP() << why_jit_unavailable();
        cudaDeviceProp properties{};
        check(cudaGetDeviceProperties(&properties, 0), "asking for the GPU's properties");
        architecture_ = 10 * properties.major + properties.minor;
    }
    [[nodiscard]] std::vector<std::byte> cubin(const ToyFacts& facts) const {
        JitInput input = toy_input(facts);
        input.architecture = architecture_;
        return link(input);
    }
    int architecture_ = 0;
};

TEST_F(LoadedKernelOn, TheGpuGivesTheBitsOfTheHostForEveryEffect) {
    constexpr std::uint32_t count = 10'000, threads = 128;
    Random random(1);
    std::vector<float> in(count), out(count);
    for (float& x : in) x = random.uniform(0.0F, 100.0F);
    Buffer<DeviceMemory> device_in, device_out;
    device_in.reserve(count * sizeof(float));
    device_out.reserve(count * sizeof(float));
    check(cudaMemcpy(device_in.data(), in.data(), count * sizeof(float), cudaMemcpyHostToDevice), "copying numbers");

    // all but toy_fused, which may be two operations on the host
    for (const std::uint32_t effects : {0U, 1U, 2U, 4U, 8U, 15U}) {
        const ToyFacts facts = {effects, 3};
        const ToyKernel kernel(cubin(facts), "toy_kernel");
        check(cudaMemset(device_out.data(), 0xFF, count * sizeof(float)), "clearing numbers");
        kernel.launch("running the toy kernel", {dim3((count + threads - 1) / threads), dim3(threads)}, nullptr,
                      reinterpret_cast<const float*>(device_in.data()), reinterpret_cast<float*>(device_out.data()),
                      count);
        check(cudaMemcpy(out.data(), device_out.data(), count * sizeof(float), cudaMemcpyDeviceToHost),
              "running the toy kernel");
        for (std::uint32_t i = 0; i < count; ++i) {
            ASSERT_EQ(std::bit_cast<std::uint32_t>(out[i]), std::bit_cast<std::uint32_t>(toy_value(facts, in[i])))
                << "toy_value({" << effects << ", 3}, " << in[i] << ")";
        }
    }
}

TEST_F(LoadedKernelOn, TheDriverSeesTheRegistersThatTheCubinStates) {
    const std::vector<std::byte> code = cubin({});
    const ToyKernel kernel(code, "toy_kernel");
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, kernel.function()), "asking for a kernel's registers");
    EXPECT_EQ(attributes.numRegs, cubin_facts(code, "toy_kernel").value().registers);
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel.function(), 128, 0), "asking for occupancy");
    EXPECT_GT(blocks, 0);
}

TEST_F(LoadedKernelOn, WhatIsNoCubinOrHasNoSuchKernelIsAnError) {
    std::vector<std::byte> code = cubin({});
    EXPECT_THROW(ToyKernel(code, "no_such_kernel"), std::runtime_error);
    std::memset(code.data(), 0, 64);
    EXPECT_THROW(ToyKernel(code, "toy_kernel"), std::runtime_error);
}

}  // namespace
}  // namespace tandem::cuda

/// Macros that let g++, clang and nvcc compile one source. Every kernel function is marked TANDEM_HD.
///
/// TANDEM_COMPILING_CUDA   1 when nvcc compiles this file, else 0; always defined, to be tested with #if
/// TANDEM_ON_DEVICE        1 inside nvcc's pass for the GPU, else 0
/// TANDEM_HD               host and device, always inline. Inlining is forced on the host because the CPU backend
///                         compiles kernels once per instruction set: an out-of-line copy built with AVX-512 could
///                         be the one that the linker keeps for a machine without it. Not forced in a build for one
///                         instruction set (TANDEM_ONE_INSTRUCTION_SET).
/// TANDEM_HD_COLD          host and device, never inline: for code that few rays need, so that it takes no registers
///                         from the common path. Pass arguments by value.
/// TANDEM_HD_CALL          host and device, never inline: for long functions. On the host each file has its own copy,
///                         for the reason above. Pass arguments by value.
/// TANDEM_HD_SHARED        on the device a single copy, called from many places: warps wait if the code is larger than
///                         the instruction caches (docs/performance.md). Inline on the host, and in kernels that fit
///                         into the caches (TANDEM_SHORT_PATHS, cuda/linked_kernel.cu).
/// TANDEM_HD_STAGE         a step of the path loop. On the host a call, as TANDEM_HD_CALL, so that compile time grows
///                         linearly with the code; inline on the device, where a call needs a stack.
/// TANDEM_KEEP_LOOP        before a loop that few threads reach: it is not unrolled on the device, which keeps code
/// short TANDEM_INLINE_LAMBDA    after a lambda's parameters: inline on the host, for the reason given with TANDEM_HD
/// TANDEM_KEEP_ROUNDING(x) hides the origin of x from the compiler. GCC 12 otherwise removes the two conversions of a
///                         vector of doubles, to float and back, and with them the rounding.
#pragma once

#if defined(__CUDACC__)
#define TANDEM_COMPILING_CUDA 1
#else
#define TANDEM_COMPILING_CUDA 0
#endif

#if defined(__CUDA_ARCH__)
#define TANDEM_ON_DEVICE 1
#else
#define TANDEM_ON_DEVICE 0
#endif

#if defined(__GNUC__) && !defined(__clang__) && !TANDEM_COMPILING_CUDA
#define TANDEM_KEEP_ROUNDING(x) __asm__("" : "+x"(x))
#else
#define TANDEM_KEEP_ROUNDING(x) static_cast<void>(0)
#endif

#if TANDEM_ON_DEVICE
#define TANDEM_KEEP_LOOP _Pragma("unroll 1")
#else
#define TANDEM_KEEP_LOOP
#endif

#if TANDEM_COMPILING_CUDA
#define TANDEM_HD __host__ __device__ __forceinline__
#define TANDEM_HD_COLD __host__ __device__ __noinline__
#define TANDEM_HD_CALL static __host__ __device__ __noinline__
#define TANDEM_HD_STAGE static __host__ __device__ __forceinline__
#if defined(TANDEM_SHORT_PATHS)
#define TANDEM_HD_SHARED TANDEM_HD
#else
#define TANDEM_HD_SHARED static __host__ __device__ __noinline__
#endif
#define TANDEM_INLINE_LAMBDA
#elif defined(TANDEM_ONE_INSTRUCTION_SET)
#define TANDEM_HD inline
#define TANDEM_HD_COLD TANDEM_HD_CALL
#define TANDEM_HD_SHARED TANDEM_HD
#define TANDEM_HD_CALL [[gnu::noinline]] static
#define TANDEM_HD_STAGE TANDEM_HD_CALL
#define TANDEM_INLINE_LAMBDA
#else
#define TANDEM_HD [[gnu::always_inline]] inline
#define TANDEM_HD_COLD TANDEM_HD_CALL
#define TANDEM_HD_SHARED TANDEM_HD
#define TANDEM_HD_CALL [[gnu::noinline]] static
#define TANDEM_HD_STAGE TANDEM_HD_CALL
#define TANDEM_INLINE_LAMBDA __attribute__((always_inline))
#endif

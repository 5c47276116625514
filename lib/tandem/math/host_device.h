/// Macros that let g++, clang and nvcc compile one source. Every kernel function is marked TANDEM_HD.
///
/// TANDEM_COMPILING_CUDA   1 when nvcc compiles this file, else 0; always defined, to be tested with #if
/// TANDEM_ON_DEVICE        1 inside nvcc's pass for the GPU, else 0
/// TANDEM_HD               host and device; always inline on the device, as the compiler decides on the host: for the
///                         functions of the path loop (lib/tandem/kernel/*.h), because forced inlining makes compile
///                         time grow with the depth of calls. The CPU backend compiles kernels once per instruction
///                         set and tier, so there the function's name carries both (TANDEM_ISA_TAG): otherwise the
///                         linker could keep the copy that an older machine cannot run.
/// TANDEM_HD_INLINE        host and device, always inline: for the parts of the path loop (math, shapes, lobes).
///                         Not for lights: kernels took a third longer to compile, and were no faster. Not forced on
///                         the host in a build with sanitizers (TANDEM_ONE_INSTRUCTION_SET), in kernels that are
///                         compiled quickly and in tests (TANDEM_QUICK_KERNELS).
/// TANDEM_HD_CALL          host and device, never inline: for long functions, and for code that few rays need, so that
///                         it takes no registers from the common path. Each file has its own copy. Pass arguments by
///                         value.
/// TANDEM_HD_CALL_ON(side) a call on one side, always inline on the other. `host`: a step of the path loop; the call
///                         keeps compile time linear in the code, and on the device it would need a stack. `device`:
///                         long code with many callers, because warps wait if the code is larger than the instruction
///                         caches (docs/performance/paths.md); inline in kernels that fit into the caches too
///                         (TANDEM_SHORT_PATHS, cuda/linked_kernel.cu).
/// TANDEM_KEEP_LOOP        before a loop that few threads reach: it is not unrolled on the device, which keeps code
///                         short. TANDEM_UNROLL: it is unrolled there
/// TANDEM_KEEP_ROUNDING    (x) hides the origin of x from the compiler. GCC 12 otherwise removes the two conversions of
///                         a vector of doubles, to float and back, and with them the rounding.
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
#define TANDEM_UNROLL _Pragma("unroll")
#else
#define TANDEM_KEEP_LOOP
#define TANDEM_UNROLL
#endif

#define TANDEM_HD_CALL_ON(side) TANDEM_HD_CALL_ON_##side

#if TANDEM_COMPILING_CUDA
#define TANDEM_HD __host__ __device__ __forceinline__
#define TANDEM_HD_INLINE TANDEM_HD
#define TANDEM_HD_CALL static __host__ __device__ __noinline__
#define TANDEM_HD_CALL_ON_host static __host__ __device__ __forceinline__
#if defined(TANDEM_SHORT_PATHS)
#define TANDEM_HD_CALL_ON_device TANDEM_HD
#else
#define TANDEM_HD_CALL_ON_device static __host__ __device__ __noinline__
#endif
#else
#if defined(TANDEM_ISA_TAG)
#define TANDEM_HD [[gnu::abi_tag(TANDEM_ISA_TAG)]] inline
#else
#define TANDEM_HD inline
#endif
#if defined(TANDEM_ONE_INSTRUCTION_SET) || defined(TANDEM_QUICK_KERNELS)
#define TANDEM_HD_INLINE TANDEM_HD
#else
#define TANDEM_HD_INLINE [[gnu::always_inline]] inline
#endif
#define TANDEM_HD_CALL [[gnu::noinline]] static
#define TANDEM_HD_CALL_ON_host TANDEM_HD_CALL
#define TANDEM_HD_CALL_ON_device TANDEM_HD_INLINE
#endif

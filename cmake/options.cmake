# The options of the build; docs/building.md lists them.
option(TANDEM_APPS "Build tandem-render, tandem-bench and tandem-gltf" ${PROJECT_IS_TOP_LEVEL})
option(TANDEM_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(TANDEM_INSTALL "Install the library, its headers and its CMake package" ${PROJECT_IS_TOP_LEVEL})
option(BUILD_SHARED_LIBS "Build a shared library" OFF)
option(TANDEM_WERROR "Treat warnings in Tandem's own code as errors" OFF)
set(TANDEM_EXACT_VARIANT "" CACHE STRING
    "Effects for which to compile a further CPU variant, e.g. shadows;reflection, to measure the price of carried effects")
set(TANDEM_INSTRUCTION_SETS "x86-64-v2;x86-64-v3;x86-64-v4" CACHE STRING
    "Instruction sets to compile the CPU kernels for; native is the best one of this machine")
option(TANDEM_QUICK_BASELINE "Compile kernels that tests hardly run quickly: the CPU's for x86-64-v2, and the GPU's of tiers \
outside TANDEM_COMPILED_TIERS" OFF)
set(TANDEM_COMPILED_TIERS "fast;strict;precise" CACHE STRING
    "Tiers whose CUDA render kernels are also compiled ahead of time; those of others need nvJitLink where they run")
option(TANDEM_HARD_CASES "Put the corpus of hard cases into tandem-bench; the tests have it in any case" ON)
option(TANDEM_UNITY "Compile files that read the same large headers together: faster full builds" OFF)
set(TANDEM_SANITIZE "" CACHE STRING "Sanitizers for the host code, e.g. address,undefined")

# TANDEM_CUDA: by default ON if there is an nvcc that works with this C++ compiler. Only ON is cached, so that an nvcc
# installed later is found.
include(${CMAKE_CURRENT_LIST_DIR}/find_nvcc.cmake)
if(NOT CMAKE_CUDA_COMPILER AND (NOT DEFINED TANDEM_CUDA OR TANDEM_CUDA))
  tandem_find_nvcc(nvcc)
  if(nvcc)
    set(ENV{CUDACXX} ${nvcc})
  endif()
endif()
if(NOT DEFINED TANDEM_CUDA)
  if(nvcc)
    include(CheckLanguage)
    unset(CMAKE_CUDA_COMPILER CACHE)
    check_language(CUDA)
  endif()
  if(CMAKE_CUDA_COMPILER)
    set(TANDEM_CUDA ON CACHE BOOL "Build the CUDA backend (needs nvcc ${TANDEM_NVCC_MINIMUM} or newer)")
  else()
    set(TANDEM_CUDA OFF)
    message(STATUS "Tandem: no nvcc ${TANDEM_NVCC_MINIMUM} or newer that works with ${CMAKE_CXX_COMPILER}; building "
                   "without the CUDA backend (put one on PATH, or run scripts/setup --with-cuda)")
  endif()
endif()
# Machine code for compute capability 8.0, which 8.6 and 8.9 run too, and 9.0. For 7.5 and for later GPUs PTX, which the
# driver assembles when a kernel is first used, and keeps. Kernels that are linked for a scene are for the GPU itself.
set(CMAKE_CUDA_ARCHITECTURES 75-virtual 80-real 90-real 90-virtual CACHE STRING "GPUs to compile for")

if(PROJECT_IS_TOP_LEVEL)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
  endif()
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  find_program(TANDEM_CCACHE ccache)
  if(TANDEM_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${TANDEM_CCACHE})
    set(CMAKE_CUDA_COMPILER_LAUNCHER ${TANDEM_CCACHE})
  endif()
endif()

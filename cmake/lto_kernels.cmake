# Kernels that are specialised for scenes (cuda/jit_link.h): compiled to LTO-IR that is embedded in a target. A custom
# command, because CMake 3.25 has no rule that compiles CUDA to a fat binary.

# The lowest of CMAKE_CUDA_ARCHITECTURES, as a number: its LTO-IR can be linked for all the later ones.
function(tandem_lowest_architecture result)
  set(list ${CMAKE_CUDA_ARCHITECTURES})
  if("${list}" MATCHES "^(native|all|all-major)$")
    string(TOUPPER ${list} which)
    string(REPLACE "-" "_" which ${which})
    set(list ${CMAKE_CUDA_ARCHITECTURES_${which}})
  endif()
  string(REGEX MATCHALL "[0-9]+" numbers "${list}")
  if(NOT numbers)
    message(FATAL_ERROR "Tandem: CMAKE_CUDA_ARCHITECTURES is '${CMAKE_CUDA_ARCHITECTURES}', which names no GPU")
  endif()
  list(SORT numbers COMPARE NATURAL)
  list(GET numbers 0 lowest)
  set(${result} ${lowest} PARENT_SCOPE)
endfunction()

# Optimised as far as possible without the facts, so that a link starts from there (docs/performance.md). Not every
# supported toolkit may have the option.
execute_process(
  COMMAND ${CMAKE_CUDA_COMPILER} --help
  OUTPUT_VARIABLE tandem_nvcc_help
  ERROR_QUIET
)
set(tandem_optimised_lto)
if(tandem_nvcc_help MATCHES "--gen-opt-lto")
  set(tandem_optimised_lto --gen-opt-lto)
endif()

# tandem_add_lto_kernels(TARGET NAME FUNCTION SOURCE FILE TIER TIER [NAMESPACE NAMESPACE] [INCLUDES DIRS...]
# [DEFINES NAME=VALUE...]): compiles FILE with the flags of TIER's other kernels (cuda/CMakeLists.txt) and adds to
# TARGET the function
#
#   std::span<const std::byte> NAMESPACE::FUNCTION()    // declare it where you use it; the namespace is tandem::cuda
#
# whose bytes are a fat binary for JitInput::code. TARGET must be defined in the calling folder; for the library itself
# it is an object library.
function(tandem_add_lto_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "NAME;SOURCE;TIER;NAMESPACE" "INCLUDES;DEFINES")
  list(TRANSFORM arg_DEFINES PREPEND -D)
  if(NOT arg_NAMESPACE)
    set(arg_NAMESPACE tandem::cuda)
  endif()
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  set(fatbin ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.fatbin)
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.cpp)
  tandem_lowest_architecture(lowest)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_CUDA_FLAGS} ${CMAKE_CUDA_FLAGS_${type}}")
  if(CMAKE_CUDA_HOST_COMPILER)
    list(APPEND flags -ccbin ${CMAKE_CUDA_HOST_COMPILER})
  endif()
  set(tier tandem_cuda_${arg_TIER})
  set(includes ${arg_INCLUDES} $<TARGET_PROPERTY:${tier},INCLUDE_DIRECTORIES>)
  file(RELATIVE_PATH shown ${PROJECT_SOURCE_DIR} ${source})
  add_custom_command(
    OUTPUT ${fatbin}
    COMMAND
      ${CMAKE_CUDA_COMPILER} ${flags} $<TARGET_PROPERTY:${tier},COMPILE_OPTIONS> "-I$<JOIN:${includes},;-I>" ${arg_DEFINES} -rdc=true
      ${tandem_optimised_lto}
      -gencode arch=compute_${lowest},code=lto_${lowest} -fatbin ${source} -o ${fatbin}
      -MD -MF ${fatbin}.d -MT ${fatbin}
    DEPENDS ${source}
    DEPFILE ${fatbin}.d
    COMMENT "Compiling ${shown} to LTO-IR, ${arg_TIER}"
    COMMAND_EXPAND_LISTS VERBATIM
  )
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_bytes.cmake)
  add_custom_command(
    OUTPUT ${embedded}
    COMMAND
      ${CMAKE_COMMAND} -DINPUT=${fatbin} -DOUTPUT=${embedded} -DNAMESPACE=${arg_NAMESPACE} -DNAME=${arg_NAME}
      -P ${script}
    DEPENDS ${fatbin} ${script}
    VERBATIM
  )
  target_sources(${target} PRIVATE ${embedded})
endfunction()

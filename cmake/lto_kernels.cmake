# Kernels that are linked with facts (cuda/jit_link.h): compiled to LTO-IR, whose bytes become part of a target, and
# also linked when Tandem is built, with facts that hold for many scenes. These are custom commands, because CMake 3.25
# can neither compile CUDA to a fat binary nor link a single kernel.

# CMAKE_CUDA_ARCHITECTURES without collective names: "80", "80-real" or "80-virtual".
function(tandem_cuda_architectures result)
  set(list ${CMAKE_CUDA_ARCHITECTURES})
  if("${list}" MATCHES "^(native|all|all-major)$")
    string(TOUPPER ${list} which)
    string(REPLACE "-" "_" which ${which})
    set(list ${CMAKE_CUDA_ARCHITECTURES_${which}})
  endif()
  if(NOT "${list}" MATCHES "[0-9]")
    message(FATAL_ERROR "Tandem: CMAKE_CUDA_ARCHITECTURES is '${CMAKE_CUDA_ARCHITECTURES}', which names no GPU")
  endif()
  set(${result} ${list} PARENT_SCOPE)
endfunction()

# The lowest of them, as a number: its LTO-IR can be linked for all the later ones.
function(tandem_lowest_architecture result)
  tandem_cuda_architectures(list)
  string(REGEX MATCHALL "[0-9]+" numbers "${list}")
  list(SORT numbers COMPARE NATURAL)
  list(GET numbers 0 lowest)
  set(${result} ${lowest} PARENT_SCOPE)
endfunction()

# tandem_share_optimiser(TARGET ALONE_FROM): runs the optimiser once for the GPUs before ALONE_FROM, for the lowest of
# them, and assembles machine code from its output; from ALONE_FROM on it runs for each. ALONE_FROM: a compute capability
# times 10; 0 for code that depends on the GPU, 1000 to run it once for all. From 90 on, the optimiser uses an instruction
# that makes traversal faster (docs/performance/build-time.md).
function(tandem_share_optimiser target alone_from)
  tandem_cuda_architectures(architectures)
  tandem_lowest_architecture(lowest)
  set(options)
  foreach(architecture IN LISTS architectures)
    string(REGEX REPLACE "-.*" "" number ${architecture}) # 75, 90a
    set(from ${number})
    string(REGEX MATCH "[0-9]+" capability ${number})
    if(capability LESS alone_from)
      set(from ${lowest})
    endif()
    if(NOT architecture MATCHES "-virtual$")
      list(APPEND options --generate-code=arch=compute_${from},code=sm_${number})
    endif()
    if(NOT architecture MATCHES "-real$")
      list(APPEND options --generate-code=arch=compute_${from},code=compute_${from})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES options)
  set_target_properties(${target} PROPERTIES CUDA_ARCHITECTURES OFF)
  target_compile_options(${target} PRIVATE ${options})
endfunction()

# Optimised as far as possible without the facts, so that a link starts from there (docs/performance/paths.md). Not every
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
# Fewer optimisations, for tests: half of the time to compile (docs/performance/build-time.md). It allows no approximation.
set(tandem_quick_device_code)
if(tandem_nvcc_help MATCHES "--Ofast-compile")
  set(tandem_quick_device_code --Ofast-compile=max)
endif()

# -O2 of the device compiler, for LTO-IR that compiles in three quarters of the time and whose kernels are as fast
# (docs/performance/build-time.md). nvcc does not document it, so ask nvcc.
execute_process(
  COMMAND ${CMAKE_CUDA_COMPILER} -Xcicc=-O2 --dryrun -x cu -c /dev/null -o /dev/null
  RESULT_VARIABLE tandem_result
  OUTPUT_QUIET ERROR_QUIET
)
set(tandem_device_o2)
if(tandem_result EQUAL 0)
  set(tandem_device_o2 -Xcicc=-O2)
endif()

# nvlink looks for libnvvm.so, NVIDIA's optimiser, in lib64 of the folder that it is given. A toolkit's installer and NVIDIA's
# Python packages put that file in different places.
find_path(
  TANDEM_NVVM_DIR lib64/libnvvm.so
  HINTS ${CMAKE_CUDA_COMPILER_TOOLKIT_ROOT}/nvvm ${CMAKE_CUDA_COMPILER_TOOLKIT_ROOT}
        ${CMAKE_CUDA_COMPILER_LIBRARY_ROOT}/nvvm ${CMAKE_CUDA_COMPILER_LIBRARY_ROOT}
  NO_DEFAULT_PATH
)
mark_as_advanced(TANDEM_NVVM_DIR)
if(NOT TANDEM_NVVM_DIR)
  message(FATAL_ERROR "Tandem: no lib64/libnvvm.so in ${CMAKE_CUDA_COMPILER_TOOLKIT_ROOT}/nvvm or "
                      "${CMAKE_CUDA_COMPILER_TOOLKIT_ROOT}; it links the kernels. Install NVVM of this CUDA release, or "
                      "configure with -DTANDEM_NVVM_DIR=... (the folder above lib64) or -DTANDEM_CUDA=OFF")
endif()

# tandem_compile_to_lto(FATBIN SOURCE FILE TIER TIER [O2] [INCLUDES DIRS...] [DEFINES NAME=VALUE...]): compiles FILE with the
# flags of TIER's other kernels (cuda/CMakeLists.txt). O2: with -O2 of the device compiler, if it has it.
function(tandem_compile_to_lto fatbin)
  cmake_parse_arguments(PARSE_ARGV 1 arg "O2" "SOURCE;TIER" "INCLUDES;DEFINES")
  list(TRANSFORM arg_DEFINES PREPEND -D)
  get_filename_component(source ${arg_SOURCE} ABSOLUTE)
  tandem_lowest_architecture(lowest)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_CUDA_FLAGS} ${CMAKE_CUDA_FLAGS_${type}}")
  if(CMAKE_CUDA_HOST_COMPILER)
    list(APPEND flags -ccbin ${CMAKE_CUDA_HOST_COMPILER})
  endif()
  set(tier tandem_cuda_${arg_TIER})
  set(includes ${arg_INCLUDES} $<TARGET_PROPERTY:${tier},INTERFACE_INCLUDE_DIRECTORIES>)
  # Optimising takes six sevenths of the time, and pays from the second link on (docs/performance/build-time.md).
  set(optimised ${tandem_optimised_lto})
  if(TANDEM_QUICK_BASELINE AND NOT arg_TIER IN_LIST TANDEM_COMPILED_TIERS)
    set(optimised)
  endif()
  if(arg_O2)
    list(APPEND optimised ${tandem_device_o2})
  endif()
  file(RELATIVE_PATH shown ${PROJECT_SOURCE_DIR} ${source})
  add_custom_command(
    OUTPUT ${fatbin}
    COMMAND
      ${CMAKE_CUDA_COMPILER} ${flags} $<TARGET_PROPERTY:${tier},INTERFACE_COMPILE_OPTIONS> "-I$<JOIN:${includes},;-I>" ${arg_DEFINES} -rdc=true
      ${optimised}
      -gencode arch=compute_${lowest},code=lto_${lowest} -fatbin ${source} -o ${fatbin}
      -MD -MF ${fatbin}.d -MT ${fatbin}
    DEPENDS ${source}
    DEPFILE ${fatbin}.d
    COMMENT "Compiling ${shown} to LTO-IR, ${arg_TIER}"
    COMMAND_EXPAND_LISTS VERBATIM
  )
endfunction()

# tandem_embed_fatbin(TARGET FATBIN NAMESPACE): adds to TARGET the function
#
#   std::span<const std::byte> NAMESPACE::NAME()    // declare it where you use it; "": the namespace is tandem::cuda
#
# with the bytes of FATBIN, which is called NAME.fatbin. TARGET has to be made in the folder that calls this; for code
# of the library itself, it is an object library.
function(tandem_embed_fatbin target fatbin namespace)
  if(NOT namespace)
    set(namespace tandem::cuda)
  endif()
  get_filename_component(name ${fatbin} NAME_WE)
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_bytes.cmake)
  add_custom_command(
    OUTPUT ${embedded}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${fatbin} -DOUTPUT=${embedded} -DNAMESPACE=${namespace} -DNAME=${name} -P ${script}
    DEPENDS ${fatbin} ${script}
    VERBATIM
  )
  target_sources(${target} PRIVATE ${embedded})
endfunction()

# tandem_add_lto_kernels(TARGET NAME FUNCTION SOURCE FILE TIER TIER [O2] [NAMESPACE NAMESPACE] [INCLUDES DIRS...] [DEFINES
# NAME=VALUE...]): tandem_compile_to_lto() of FILE, whose bytes FUNCTION of TARGET returns for JitInput::code
# (tandem_embed_fatbin()).
function(tandem_add_lto_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "O2" "NAME;SOURCE;TIER;NAMESPACE" "INCLUDES;DEFINES")
  set(fatbin ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.fatbin)
  set(o2)
  if(arg_O2)
    set(o2 O2)
  endif()
  tandem_compile_to_lto(
    ${fatbin}
    SOURCE ${arg_SOURCE}
    TIER ${arg_TIER}
    ${o2}
    INCLUDES ${arg_INCLUDES}
    DEFINES ${arg_DEFINES}
  )
  tandem_embed_fatbin(${target} ${fatbin} "${arg_NAMESPACE}")
endfunction()

# tandem_add_compiled_kernels(TARGET NAME FUNCTION LINKS FUNCTION KERNEL KERNEL TIER TIER FACTS FACTS [REGISTERS MOST]
# [NAMESPACE NAMESPACE] [PTX_ONLY]):
# links KERNEL from the LTO-IR of the function LINKS, which tandem_add_lto_kernels() added in this folder, and from
# FACTS.fatbin, which tandem_compile_to_lto() made in this folder and which defines the kernel's facts. For
# CMAKE_CUDA_ARCHITECTURES: FUNCTION of TARGET gives a fat binary of machine code and PTX (tandem_embed_fatbin()). MOST: the
# registers that a thread may have in the machine code; 0: as the launch bounds say. PTX_ONLY: no machine code; the driver
# assembles the kernel when it is first used, and keeps the result.
function(tandem_add_compiled_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PTX_ONLY" "NAME;LINKS;KERNEL;TIER;FACTS;REGISTERS;NAMESPACE" "")
  set(registers)
  if(arg_REGISTERS)
    set(registers -maxrregcount=${arg_REGISTERS})
  endif()
  set(name ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME})
  set(kernel ${CMAKE_CURRENT_BINARY_DIR}/${arg_LINKS}.fatbin)
  set(facts ${CMAKE_CURRENT_BINARY_DIR}/${arg_FACTS}.fatbin)
  # The link decides on contraction and flush-to-zero: without an option of its own, nvlink contracts, whatever nvcc's
  # options were. With one, it passes on all of these options, with nvcc's values for divisions and square roots.
  get_target_property(options tandem_cuda_${arg_TIER} TANDEM_LINK_OPTIONS)
  list(TRANSFORM options PREPEND -Xnvvm=)
  # One link for all GPUs, because the optimiser's output does not depend on the GPU (docs/performance/build-time.md): PTX of
  # the lowest, which is assembled for each.
  tandem_lowest_architecture(lowest)
  set(ptx ${name}.ptx)
  add_custom_command(
    OUTPUT ${ptx}
    COMMAND ${CMAKE_CUDA_DEVICE_LINKER} -dlto -arch=sm_${lowest} -emit-ptx -nvvmpath=${TANDEM_NVVM_DIR} ${options}
            -kernels-used=${arg_KERNEL} ${kernel} ${facts} -o ${ptx}
    DEPENDS ${kernel} ${facts}
    COMMENT "Linking ${arg_NAME}.ptx"
    COMMAND_EXPAND_LISTS VERBATIM
  )
  set(files ${ptx})
  set(images)
  tandem_cuda_architectures(architectures)
  foreach(architecture IN LISTS architectures)
    if(arg_PTX_ONLY OR NOT architecture MATCHES "-real$")
      set(images --image3=kind=ptx,sm=${lowest},file=${ptx})
    endif()
  endforeach()
  foreach(architecture IN LISTS architectures)
    if(NOT arg_PTX_ONLY AND NOT architecture MATCHES "-virtual$")
      string(REGEX REPLACE "-.*" "" number ${architecture}) # 75, 90a
      set(file ${name}_${number}.cubin)
      add_custom_command(
        OUTPUT ${file}
        COMMAND ${CMAKE_CUDA_COMPILER} -arch=sm_${number} ${registers} -cubin ${ptx} -o ${file}
        DEPENDS ${ptx}
        COMMENT "Assembling ${arg_NAME}_${number}.cubin"
        VERBATIM
      )
      list(APPEND files ${file})
      list(APPEND images --image3=kind=elf,sm=${number},file=${file})
    endif()
  endforeach()
  add_custom_command(
    OUTPUT ${name}.fatbin
    COMMAND ${CMAKE_CUDA_FATBINARY} -64 --compress-all --create=${name}.fatbin ${images}
    DEPENDS ${files}
    VERBATIM
  )
  tandem_embed_fatbin(${target} ${name}.fatbin "${arg_NAMESPACE}")
endfunction()

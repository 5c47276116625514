# The flags of our own code. Equal bits depend on them: no contraction of a * b + c unless fma is written, no fast-math,
# no flush-to-zero (docs/numerics.md). tests/lint checks the resulting code.

# The language and the arithmetic; all of our targets link this.
add_library(tandem_exact_flags INTERFACE)
target_compile_features(tandem_exact_flags INTERFACE cxx_std_20)
target_compile_options(
  tandem_exact_flags
  INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off;-fno-math-errno;-fno-trapping-math>
)

# The instruction set of every x86-64 machine of the last decade; cpu/CMakeLists.txt adds kernels for newer ones. With
# sanitizers g++ would take more than ten minutes to compile a function with forced inlining, so inlining is not forced;
# then all files must be compiled for one instruction set (lib/tandem/math/host_device.h).
add_library(tandem_baseline_isa INTERFACE)
if(TANDEM_SANITIZE)
  target_compile_definitions(tandem_baseline_isa INTERFACE TANDEM_ONE_INSTRUCTION_SET)
  target_compile_options(tandem_baseline_isa INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-march=x86-64-v3>)
else()
  target_compile_options(tandem_baseline_isa INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-march=x86-64-v2>)
endif()

# tandem_optimise(LEVEL): code that is not timed compiles faster with -O1, -Og or -O0. Called by folders whose code does not
# compute images.
macro(tandem_optimise level)
  string(REGEX REPLACE "-O[13]" "${level}" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
endmacro()

# Warnings and sanitizers; not exported.
add_library(tandem_diagnostics INTERFACE)
target_compile_options(
  tandem_diagnostics
  INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wconversion;-Wundef>
            $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${TANDEM_WERROR}>>:-Werror>
)
if(TANDEM_SANITIZE)
  # g++ 12 reports the sanitizers' own code in the standard library as uses of uninitialised variables
  target_compile_options(
    tandem_diagnostics
    INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${TANDEM_SANITIZE};-fno-sanitize-recover=all;-g1>
              $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized>
  )
  target_link_options(tandem_diagnostics INTERFACE -fsanitize=${TANDEM_SANITIZE})
endif()

add_library(tandem_private INTERFACE)
target_link_libraries(tandem_private INTERFACE tandem_exact_flags tandem_baseline_isa tandem_diagnostics)

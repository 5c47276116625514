# The libraries that Tandem depends on, for the build and for the installed package, whose users link the same libraries
# if Tandem is static.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(TBB)
find_dependency(fmt)
find_dependency(OpenSSL COMPONENTS Crypto)
find_dependency(PNG)

# Optional. Quiet, because Debian's package of Imath reports at each configuration that its Python module is missing.
block()
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  find_package(OpenEXR 3.1.3 CONFIG QUIET)
endblock()

# Embree 4 (Debian 13, Ubuntu 24.04) or 3.13 (Debian 12): the target `embree`.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_dependency(embree 3.13)
endif()

# By name, because FindCUDAToolkit of CMake 3.25 needs a library that CUDA 13 lacks.
# tandem_find_library(TARGET LIBRARIES... [HEADER FILE] [HINTS DIRS...]): an imported target, or nothing when a part is
# missing.
function(tandem_find_library target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "HEADER" "HINTS")
  if(TARGET ${target})
    return()
  endif()
  string(MAKE_C_IDENTIFIER "TANDEM_${target}" prefix)
  set(libraries "")
  foreach(name IN LISTS arg_UNPARSED_ARGUMENTS)
    find_library(${prefix}_${name} ${name} HINTS ${arg_HINTS})
    mark_as_advanced(${prefix}_${name})
    list(APPEND libraries ${${prefix}_${name}})
  endforeach()
  if(arg_HEADER)
    find_path(${prefix}_INCLUDE_DIR ${arg_HEADER})
    mark_as_advanced(${prefix}_INCLUDE_DIR)
  else()
    set(${prefix}_INCLUDE_DIR "")
  endif()
  if("${libraries};${${prefix}_INCLUDE_DIR}" MATCHES "-NOTFOUND")
    return()
  endif()
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${target} INTERFACE ${libraries})
  target_include_directories(${target} SYSTEM INTERFACE ${${prefix}_INCLUDE_DIR})
endfunction()

tandem_find_library(Tandem::jpeg jpeg HEADER jpeglib.h)
tandem_find_library(Tandem::isal isal HEADER isa-l/igzip_lib.h)

# Only if the CUDA backend is built; TANDEM_CUDA_LIBRARY_DIRS is the location of the toolkit.
macro(tandem_find_cudart)
  tandem_find_library(Tandem::cudart cudart_static HINTS ${TANDEM_CUDA_LIBRARY_DIRS} /usr/local/cuda/lib64)
  if(TARGET Tandem::cudart)
    target_link_libraries(Tandem::cudart INTERFACE Threads::Threads ${CMAKE_DL_LIBS} rt)
  endif()
endmacro()

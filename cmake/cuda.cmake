# The CUDA language, and Tandem::cudart, the static runtime that the backend links. The runtime opens the driver at run
# time, so that programs also start without one.
enable_language(CUDA)
if(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS TANDEM_NVCC_MINIMUM)
  message(FATAL_ERROR "Tandem: ${CMAKE_CUDA_COMPILER} is version ${CMAKE_CUDA_COMPILER_VERSION}, but the CUDA backend "
                      "needs ${TANDEM_NVCC_MINIMUM}; configure with -DCMAKE_CUDA_COMPILER=... or -DTANDEM_CUDA=OFF")
endif()
set(TANDEM_CUDA_LIBRARY_DIRS ${CMAKE_CUDA_IMPLICIT_LINK_DIRECTORIES})
tandem_find_cudart()
if(NOT TARGET Tandem::cudart)
  message(FATAL_ERROR "Tandem: no libcudart_static.a in ${TANDEM_CUDA_LIBRARY_DIRS}")
endif()
get_filename_component(TANDEM_CUDART_DIR ${TANDEM_Tandem__cudart_cudart_static} DIRECTORY)
include(${CMAKE_CURRENT_LIST_DIR}/lto_kernels.cmake)

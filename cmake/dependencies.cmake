# Libraries that Tandem stands on; scripts/setup installs their Debian and Ubuntu packages.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(PNG REQUIRED)
find_package(TinyGLTF REQUIRED)

# Embree 4 (Debian 13, Ubuntu 24.04) or 3.13 (Debian 12).
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()

# GLM is headers only; Debian 12 ships no CMake package for it.
find_path(TANDEM_GLM_INCLUDE_DIR glm/vec3.hpp REQUIRED)
add_library(tandem_glm INTERFACE)
target_include_directories(tandem_glm SYSTEM INTERFACE $<BUILD_INTERFACE:${TANDEM_GLM_INCLUDE_DIR}>)

# OpenImageIO brings EXR; without it there are PPM, PFM and PNG. Its CMake package on Debian demands the tools package,
# and with it Qt, so the library is found by name.
find_path(TANDEM_OIIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(TANDEM_OIIO_LIBRARY OpenImageIO)
find_library(TANDEM_OIIO_UTIL_LIBRARY OpenImageIO_Util)
if(TANDEM_OIIO_INCLUDE_DIR AND TANDEM_OIIO_LIBRARY AND TANDEM_OIIO_UTIL_LIBRARY)
  set(TANDEM_HAS_OIIO ON)
else()
  set(TANDEM_HAS_OIIO OFF)
  message(STATUS "Tandem: no OpenImageIO; building without EXR images")
endif()

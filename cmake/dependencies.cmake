# Libraries that Tandem stands on; scripts/setup installs their Debian and Ubuntu packages.
set(CMAKE_FIND_PACKAGE_NAME Tandem)
set(Tandem_FIND_REQUIRED ON)
include(${CMAKE_CURRENT_LIST_DIR}/TandemDependencies.cmake)
unset(CMAKE_FIND_PACKAGE_NAME)
find_package(nlohmann_json REQUIRED) # headers, seen by our sources only

if(NOT TARGET Tandem::glm)
  message(FATAL_ERROR "Tandem: no GLM headers (glm/vec3.hpp) found; on Debian and Ubuntu install libglm-dev")
endif()
if(TARGET Tandem::openimageio)
  set(TANDEM_HAS_OIIO ON)
else()
  set(TANDEM_HAS_OIIO OFF)
  message(STATUS "Tandem: no OpenImageIO; building without EXR images")
endif()

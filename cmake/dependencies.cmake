# The libraries that Tandem depends on; scripts/setup installs their Debian and Ubuntu packages.
set(CMAKE_FIND_PACKAGE_NAME Tandem)
set(Tandem_FIND_REQUIRED ON)
include(${CMAKE_CURRENT_LIST_DIR}/TandemDependencies.cmake)
unset(CMAKE_FIND_PACKAGE_NAME)
find_package(nlohmann_json REQUIRED) # headers, seen by our sources only

if(TARGET OpenEXR::OpenEXR)
  set(TANDEM_HAS_EXR ON)
else()
  set(TANDEM_HAS_EXR OFF)
  message(STATUS "Tandem: no OpenEXR 3.1.3 or newer; building without EXR images")
endif()
if(TARGET Tandem::jpeg)
  set(TANDEM_HAS_JPEG ON)
else()
  set(TANDEM_HAS_JPEG OFF)
  message(STATUS "Tandem: no libjpeg; building without JPEG textures")
endif()

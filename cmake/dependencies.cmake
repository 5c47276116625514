# The libraries that Tandem depends on; scripts/setup installs their Debian and Ubuntu packages.
set(CMAKE_FIND_PACKAGE_NAME Tandem)
set(Tandem_FIND_REQUIRED ON)
include(${CMAKE_CURRENT_LIST_DIR}/TandemDependencies.cmake)
unset(CMAKE_FIND_PACKAGE_NAME)
find_package(nlohmann_json REQUIRED) # headers, seen by our sources only

# tandem_optional(NAME TARGET MESSAGE): sets TANDEM_HAS_NAME; prints the message if the library is missing.
function(tandem_optional name target message)
  if(TARGET ${target})
    set(TANDEM_HAS_${name} ON PARENT_SCOPE)
  else()
    set(TANDEM_HAS_${name} OFF PARENT_SCOPE)
    message(STATUS "Tandem: ${message}")
  endif()
endfunction()
tandem_optional(EXR OpenEXR::OpenEXR "no OpenEXR 3.1.3 or newer; building without EXR images")
tandem_optional(JPEG Tandem::jpeg "no libjpeg; building without JPEG textures")
tandem_optional(ISAL Tandem::isal "no ISA-L; zlib compresses PNG files, which takes several times as long")

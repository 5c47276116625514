# cmake --install: the programs (component "programs"), and the library with its headers and its CMake package
# (component "library"). find_package(Tandem) runs the configured TandemConfig.cmake.in.
if(NOT TANDEM_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Tandem)

install(
  TARGETS tandem
  EXPORT TandemTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
)

# tandem_install_header(HEADER): installs a header under lib/, and our headers that it includes, except those of the
# lobes and of the environments: only kernels need them.
function(tandem_install_header header)
  get_property(known GLOBAL PROPERTY tandem_installed_headers)
  if(header IN_LIST known)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY tandem_installed_headers ${header})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS lib/${header})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES lib/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT library)
  file(STRINGS lib/${header} lines REGEX "^#include \"tandem/|^#ifdef TANDEM_(LOBE|ENVIRONMENT)_HEADERS$|^#endif")
  set(of_kernels OFF)
  foreach(line IN LISTS lines)
    if(line MATCHES "^#include \"([^\"]+)\"")
      if(NOT of_kernels)
        tandem_install_header(${CMAKE_MATCH_1})
      endif()
    elseif(line MATCHES "^#ifdef")
      set(of_kernels ON)
    else()
      set(of_kernels OFF)
    endif()
  endforeach()
endfunction()
tandem_install_header(tandem/tandem.h)

install(EXPORT TandemTargets NAMESPACE Tandem:: DESTINATION ${package_dir} COMPONENT library)

configure_package_config_file(
  cmake/TandemConfig.cmake.in ${PROJECT_BINARY_DIR}/TandemConfig.cmake INSTALL_DESTINATION ${package_dir}
)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TandemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(
  FILES ${PROJECT_BINARY_DIR}/TandemConfig.cmake ${PROJECT_BINARY_DIR}/TandemConfigVersion.cmake
        cmake/TandemDependencies.cmake
  DESTINATION ${package_dir}
  COMPONENT library
)

# Where installed programs find a shared library, and where both find libraries outside the system's folders.
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(tandem PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
foreach(program tandem-render tandem-bench tandem-gltf)
  if(TARGET ${program})
    set_target_properties(
      ${program} PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}" INSTALL_RPATH_USE_LINK_PATH ON
    )
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  endif()
endforeach()

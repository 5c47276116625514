# cmake --install: the programs (component "programs"), and the library with its headers and its CMake package
# (component "library"). What find_package(Tandem) runs is TandemConfig.cmake.in.
if(NOT TANDEM_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Tandem)

install(TARGETS tandem EXPORT TandemTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(
  DIRECTORY lib/tandem/
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tandem
  COMPONENT library
  FILES_MATCHING PATTERN "*.h" PATTERN "*.def"
)
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

foreach(program tandem-render tandem-bench tandem-gltf)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  endif()
endforeach()

# What cmake --install puts in place, below one prefix: both step programs, their
# scenes, the programs that verify and draw their results, the library with its headers,
# and what find_package(friction) needs. Other programs then link with friction::friction
# and include <common/...> as the steps do.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/friction)
set(_headers ${CMAKE_INSTALL_INCLUDEDIR}/friction)

# Programs find the library where they are installed, wherever that is.
file(RELATIVE_PATH _to_library
  ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(step-friction-2d step-friction-3d PROPERTIES
  INSTALL_RPATH "$ORIGIN/${_to_library}")
# And deal.II, where that is in a place of its own.
set_target_properties(step-friction-2d step-friction-3d friction PROPERTIES
  INSTALL_RPATH_USE_LINK_PATH TRUE)
set_target_properties(friction PROPERTIES
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

install(TARGETS step-friction-2d step-friction-3d)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(TARGETS friction EXPORT friction-targets
  INCLUDES DESTINATION ${_headers})
install(DIRECTORY common DESTINATION ${_headers}
  FILES_MATCHING PATTERN "*.h"
  PATTERN cmake EXCLUDE PATTERN plot EXCLUDE PATTERN precompiled.h EXCLUDE
  PATTERN dense_kernels_body.h EXCLUDE)
foreach(_step step-friction-2d step-friction-3d)
  install(DIRECTORY ${_step}/scenes
    DESTINATION ${CMAKE_INSTALL_DATADIR}/friction/${_step})
endforeach()

set(_verify ${CMAKE_INSTALL_DATADIR}/friction/verify)
file(RELATIVE_PATH _to_verify
  ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/friction/verify)
configure_file(common/cmake/friction-verify.in
  ${PROJECT_BINARY_DIR}/friction-verify @ONLY)
install(PROGRAMS ${PROJECT_BINARY_DIR}/friction-verify
  DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY tests/verify/ DESTINATION ${_verify}
  FILES_MATCHING PATTERN "*.py" PATTERN refute.py EXCLUDE PATTERN all_scenes.py EXCLUDE)

set(_plot ${CMAKE_INSTALL_DATADIR}/friction/plot)
file(RELATIVE_PATH _to_plot
  ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/friction/plot)
configure_file(common/cmake/friction-plot.in ${PROJECT_BINARY_DIR}/friction-plot @ONLY)
install(PROGRAMS ${PROJECT_BINARY_DIR}/friction-plot DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY common/plot/ DESTINATION ${_plot} FILES_MATCHING PATTERN "*.py")
# In the build tree it lies beside the programs, too.
set(_bin ${PROJECT_BINARY_DIR}/bin)
file(RELATIVE_PATH _to_plot ${_bin} ${PROJECT_SOURCE_DIR}/common/plot)
configure_file(common/cmake/friction-plot.in ${_bin}/friction-plot @ONLY)

install(EXPORT friction-targets NAMESPACE friction:: DESTINATION ${_package})
configure_package_config_file(common/cmake/friction-config.cmake.in
  ${PROJECT_BINARY_DIR}/friction-config.cmake
  INSTALL_DESTINATION ${_package})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/friction-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/friction-config.cmake
  ${PROJECT_BINARY_DIR}/friction-config-version.cmake
  DESTINATION ${_package})

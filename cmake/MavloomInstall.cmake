# Installs the files for find_package(mavloom) in an outside project: the export set of the modules, the config and
# version files. Also the guide. Each file belongs to a component: mavloom_runtime or mavloom_development. A plain
# `cmake --install` takes both. The component mavloom_python is for `pip install` alone (python/CMakeLists.txt).
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/mavloom")
set(dialects_folder "${CMAKE_INSTALL_DATADIR}/mavloom/dialects")
get_property(modules GLOBAL PROPERTY MAVLOOM_MODULES)
list(JOIN modules ", " MAVLOOM_MODULE_LIST)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/mavloomConfig.cmake.in"
                              "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfig.cmake"
                              INSTALL_DESTINATION "${package_folder}" PATH_VARS dialects_folder
                              NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/mavloomConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfigVersion.cmake"
        DESTINATION "${package_folder}" COMPONENT mavloom_development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/guide" "${PROJECT_SOURCE_DIR}/docs/formats"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT mavloom_runtime FILES_MATCHING PATTERN "*.md"
        PATTERN "python.md" EXCLUDE PATTERN "from-pymavlink.md" EXCLUDE)  # python3-mavloom has them
configure_file("${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${CMAKE_CURRENT_BINARY_DIR}/CHANGELOG.md" COPYONLY)
execute_process(COMMAND gzip -9nf "${CMAKE_CURRENT_BINARY_DIR}/CHANGELOG.md" COMMAND_ERROR_IS_FATAL ANY)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${CMAKE_CURRENT_BINARY_DIR}/CHANGELOG.md.gz"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT mavloom_runtime)
install(EXPORT mavloomTargets NAMESPACE mavloom:: DESTINATION "${package_folder}" COMPONENT mavloom_development)

# Removes the line numbers of release builds, which are for back traces, from what was installed: they are most of its
# size. `cmake --install --strip` would leave archives as they are.
function(mavloom_strip_installed component)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Release")
    return()
  endif()
  set(patterns "")
  foreach(pattern IN LISTS ARGN)
    if(NOT IS_ABSOLUTE "${pattern}")  # distributions may set absolute folders
      string(PREPEND pattern "\${CMAKE_INSTALL_PREFIX}/")
    endif()
    string(APPEND patterns " \"\$ENV{DESTDIR}${pattern}\"")
  endforeach()
  install(CODE "
    file(GLOB files ${patterns})
    if(files)
      execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug \${files} COMMAND_ERROR_IS_FATAL ANY)
    endif()"
    COMPONENT ${component})
endfunction()
mavloom_strip_installed(mavloom_development "${CMAKE_INSTALL_LIBDIR}/libmavloom_*.a"
                        "${CMAKE_INSTALL_BINDIR}/mavloom_dialectgen")

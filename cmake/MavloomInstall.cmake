# Installs the files for find_package(mavloom) in an outside project: the export set of the modules, the config and
# version files.
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/mavloom")
get_property(modules GLOBAL PROPERTY MAVLOOM_MODULES)
list(JOIN modules ", " MAVLOOM_MODULE_LIST)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/mavloomConfig.cmake.in"
                              "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfig.cmake"
                              INSTALL_DESTINATION "${package_folder}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/mavloomConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/mavloomConfigVersion.cmake"
        DESTINATION "${package_folder}" COMPONENT mavloom_development)
install(EXPORT mavloomTargets NAMESPACE mavloom:: DESTINATION "${package_folder}" COMPONENT mavloom_development)

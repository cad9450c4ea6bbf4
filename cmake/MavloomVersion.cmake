# Renews the version's text at every build; module base holds the one file that includes it.
set(version_folder "${CMAKE_CURRENT_BINARY_DIR}/generated/version")
add_custom_target(mavloom_version
  COMMAND "${CMAKE_COMMAND}" "-DVERSION=${PROJECT_VERSION}" "-DSOURCE=${PROJECT_SOURCE_DIR}"
          "-DOUTPUT=${version_folder}/mavloom_version_text.hpp"
          -P "${CMAKE_CURRENT_LIST_DIR}/WriteVersion.cmake"
  BYPRODUCTS "${version_folder}/mavloom_version_text.hpp"
  COMMENT "Version text"
  VERBATIM)
add_dependencies(mavloom_base mavloom_version)
target_include_directories(mavloom_base PRIVATE "${version_folder}")

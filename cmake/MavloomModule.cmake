# What nearly every file includes, compiled once (a third of a build's time). Only headers from outside, and every file still includes what it uses:
# the preset `tidy` compiles without.
set(mavloom_precompiled <algorithm> <array> <charconv> <chrono> <fmt/format.h> <functional> <memory> <optional> <span> <string> <string_view>
    <tl/expected.hpp> <utility> <vector>)

# mavloom_precompile(<target> <owner>): `owner` makes the headers, targets compiled with the same options share them.
function(mavloom_precompile target owner)
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${mavloom_precompiled} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# mavloom_module(<name> [DEPENDS <module>...] [LINK <target>...] [PRIVATE_LINK <target>...])
#
# One library per module: `mavloom_<name>`, alias `mavloom::<name>`, from src/<name>/*.cpp and include/mavloom/<name>/.
# A module without sources is an interface library.

# -Wno-...: GCC 12 is wrong about std::string and std::vector (GCC bugs 105329, 105651).
add_library(mavloom_warnings INTERFACE)
target_compile_options(mavloom_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wcast-align
                       $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual>
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow> $<$<BOOL:${MAVLOOM_WERROR}>:-Werror>)

function(mavloom_module name)
  cmake_parse_arguments(arg "" "" "DEPENDS;LINK;PRIVATE_LINK" ${ARGN})
  set(target mavloom_${name})
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/*.cpp")
  set(scope PUBLIC)
  if(NOT sources)
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  else()
    add_library(${target} ${sources})
    target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/src")
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:mavloom_warnings> ${arg_PRIVATE_LINK})
    mavloom_precompile(${target} mavloom_base)
  endif()
  add_library(mavloom::${name} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY MAVLOOM_MODULES ${name})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} ${scope} cxx_std_20)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/mavloom/${name}/*.hpp")
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include" FILES ${headers})
  list(TRANSFORM arg_DEPENDS PREPEND mavloom::)
  target_link_libraries(${target} ${scope} ${arg_DEPENDS} ${arg_LINK})
  if(MAVLOOM_INSTALL)
    install(TARGETS ${target} EXPORT mavloomTargets COMPONENT mavloom_development FILE_SET HEADERS COMPONENT mavloom_development)
  endif()
endfunction()

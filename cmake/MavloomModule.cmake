# Headers that nearly every file includes, compiled once, which saves a third of a build's time. Only headers from
# outside. Files still include what they use: `.ci/run --full` compiles each without.
set(mavloom_precompiled <algorithm> <array> <charconv> <chrono> <fmt/format.h> <functional> <memory> <optional> <span>
    <string> <string_view> <tl/expected.hpp> <utility> <vector>)

# mavloom_precompile(<target> <owner> [<header>...]): `owner` makes the headers, others share them. All must be
# optimised alike: GCC 12 takes the level from what was precompiled, or crashes.
function(mavloom_precompile target owner)
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${mavloom_precompiled} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# For code that runs once or beside the work. Higher optimisation would speed up nothing that counts. It would add half
# to the compile time, and more than that with a sanitizer. A fuzzer runs it all the time.
set(mavloom_unoptimised_debug $<$<AND:$<CONFIG:Debug>,$<NOT:$<BOOL:${MAVLOOM_FUZZ}>>>:-O0>)
set(mavloom_cold_flags $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-O1> ${mavloom_unoptimised_debug})

# -Wrestrict: GCC 12 is wrong about std::string (GCC bug 105329). In a unity build, names shadow those of other files,
# and GCC takes anonymous namespaces for those of a header.
add_library(mavloom_warnings INTERFACE)
set(mavloom_shadow -Wshadow)
if(CMAKE_UNITY_BUILD)
  set(mavloom_shadow $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()
target_compile_options(mavloom_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion ${mavloom_shadow}
                       -Wno-sign-conversion -Wcast-align
                       $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual>
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<BOOL:${MAVLOOM_WERROR}>:-Werror>)

# mavloom_module(<name> [DEPENDS <module>...] [LINK <target>...] [PRIVATE_LINK <target>...] [COLD <source>...]
#                [NO_SOURCES])
#
# One library per module: `mavloom_<name>`, alias `mavloom::<name>`, from src/<name>/*.cpp and include/mavloom/<name>/.
# A module without sources is an interface library. COLD: sources (names without .cpp) to compile with
# mavloom_cold_flags. NO_SOURCES: the sources belong to other targets, which the caller links.
# With MAVLOOM_MINIMAL, src/<name>/minimal/ replaces the other sources, if there is such a folder.
function(mavloom_module name)
  cmake_parse_arguments(arg "NO_SOURCES" "" "DEPENDS;LINK;PRIVATE_LINK;COLD" ${ARGN})
  if(name IN_LIST mavloom_modules_left_out)
    return()
  endif()
  set(target mavloom_${name})
  set(sources "")
  if(NOT arg_NO_SOURCES)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/*.cpp")
    set(minimal_sources ${sources})
    list(FILTER minimal_sources INCLUDE REGEX "/minimal/")
    list(FILTER sources EXCLUDE REGEX "/minimal/")
    if(MAVLOOM_MINIMAL AND minimal_sources)
      set(sources ${minimal_sources})
      set(arg_COLD "")
    endif()
  endif()
  set(scope PUBLIC)
  if(NOT sources)
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  else()
    list(TRANSFORM arg_COLD REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/src/${name}/\\1.cpp")
    list(REMOVE_ITEM sources ${arg_COLD} "")  # "", for it must be given something
    add_library(${target} ${sources})
    target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/src")
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:mavloom_warnings> ${arg_PRIVATE_LINK})
    mavloom_precompile(${target} mavloom_base)
  endif()
  add_library(mavloom::${name} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY MAVLOOM_MODULES ${name})
  # A DEFINE_SYMBOL of its own, in a shared library, would keep it from sharing precompiled headers.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_compile_features(${target} ${scope} cxx_std_20)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/mavloom/${name}/*.hpp")
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include" FILES ${headers})
  list(TRANSFORM arg_DEPENDS PREPEND mavloom::)
  target_link_libraries(${target} ${scope} ${arg_DEPENDS} ${arg_LINK})
  if(arg_COLD)
    add_library(${target}_cold OBJECT ${arg_COLD})
    set_target_properties(${target}_cold PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_features(${target}_cold PRIVATE cxx_std_20)
    target_compile_options(${target}_cold PRIVATE ${mavloom_cold_flags})
    target_include_directories(${target}_cold PRIVATE "${PROJECT_SOURCE_DIR}/include" "${PROJECT_SOURCE_DIR}/src")
    target_link_libraries(${target}_cold PRIVATE mavloom_warnings ${arg_DEPENDS} ${arg_LINK} ${arg_PRIVATE_LINK})
    # All share the precompiled headers of the first.
    get_property(first_cold GLOBAL PROPERTY MAVLOOM_FIRST_COLD)
    if(NOT first_cold)
      set(first_cold ${target}_cold)
      set_property(GLOBAL PROPERTY MAVLOOM_FIRST_COLD ${first_cold})
    endif()
    mavloom_precompile(${target}_cold ${first_cold})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_cold>)
  endif()
  if(MAVLOOM_INSTALL)
    install(TARGETS ${target} EXPORT mavloomTargets COMPONENT mavloom_development
            FILE_SET HEADERS COMPONENT mavloom_development)
  endif()
endfunction()

# Module dialect in its parts, and the default dialect made from dialects/all.xml.
#   mavloom::dialect_core     records, layout, XML reader; needs no tables, so that the generator can be built from it
#   mavloom::dialectgen       the generator, a program
#   mavloom::dialect_builtin  the tables behind default_dialect(), and the public files for includes
#   mavloom::messages         the headers mavloom/msg/*.hpp
# `mavloom::dialect` (mavloom_module) links the first and the third.
include(MavloomDialect)

file(GLOB core_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/dialect/core/*.cpp")
add_library(mavloom_dialect_core ${core_sources})
add_library(mavloom::dialect_core ALIAS mavloom_dialect_core)
set_target_properties(mavloom_dialect_core PROPERTIES EXPORT_NAME dialect_core POSITION_INDEPENDENT_CODE ON)
# Debug and sanitizer builds would spend more time on optimising it than on running it.
target_compile_options(mavloom_dialect_core PRIVATE ${mavloom_unoptimised_debug})
target_link_libraries(mavloom_dialect_core PUBLIC mavloom::wire PRIVATE pugixml::pugixml
                      $<BUILD_INTERFACE:mavloom_warnings>)

file(GLOB generator_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tools/dialectgen/*.cpp")
add_executable(mavloom_dialectgen ${generator_sources})
add_executable(mavloom::dialectgen ALIAS mavloom_dialectgen)
set_target_properties(mavloom_dialectgen PROPERTIES EXPORT_NAME dialectgen)
target_compile_options(mavloom_dialectgen PRIVATE ${mavloom_cold_flags})
target_include_directories(mavloom_dialectgen PRIVATE "${PROJECT_SOURCE_DIR}/src")
target_link_libraries(mavloom_dialectgen PRIVATE mavloom_dialect_core $<BUILD_INTERFACE:mavloom_warnings>)

set(generated "${PROJECT_BINARY_DIR}/generated")
set(options --builtin)
if(MAVLOOM_MINIMAL)
  list(APPEND options --lean)
endif()
_mavloom_generate_dialect("${PROJECT_SOURCE_DIR}/dialects/all.xml" mavloom::msg "${generated}" "${options}")
add_library(mavloom_dialect_builtin ${tables} "${PROJECT_SOURCE_DIR}/src/dialect/builtin/load.cpp")
add_library(mavloom::dialect_builtin ALIAS mavloom_dialect_builtin)
set_target_properties(mavloom_dialect_builtin PROPERTIES EXPORT_NAME dialect_builtin
                      POSITION_INDEPENDENT_CODE ON CXX_CLANG_TIDY "")
target_include_directories(mavloom_dialect_builtin PRIVATE "${PROJECT_SOURCE_DIR}/src")
target_link_libraries(mavloom_dialect_builtin PUBLIC mavloom_dialect_core)
target_link_libraries(mavloom_dialect INTERFACE mavloom_dialect_builtin mavloom_dialect_core)

add_custom_target(mavloom_message_headers DEPENDS "${headers_stamp}")
add_library(mavloom_messages INTERFACE)
add_library(mavloom::messages ALIAS mavloom_messages)
set_target_properties(mavloom_messages PROPERTIES EXPORT_NAME messages)
add_dependencies(mavloom_messages mavloom_message_headers)
target_include_directories(mavloom_messages INTERFACE "$<BUILD_INTERFACE:${generated}/include>"
                           "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
target_link_libraries(mavloom_messages INTERFACE mavloom::base)

if(MAVLOOM_INSTALL)
  install(TARGETS mavloom_dialect_core mavloom_dialect_builtin mavloom_messages mavloom_dialectgen EXPORT mavloomTargets
          COMPONENT mavloom_development)
  install(DIRECTORY "${generated}/include/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT mavloom_development)
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/MavloomDialect.cmake" DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/mavloom"
          COMPONENT mavloom_development)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/dialects/" DESTINATION "${CMAKE_INSTALL_DATADIR}/mavloom/dialects"
          COMPONENT mavloom_development FILES_MATCHING PATTERN "*.xml")
endif()

# The program with the commands `route`, `ctl` and `stat` alone, for small computers.
set(sources arguments.cpp events.cpp main.cpp open_control.cpp output.cpp progress.cpp signals.cpp wrapped.cpp
    minimal/web_beside.cpp page/page_hop.cpp)
file(GLOB command_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/route/*.cpp"
     "${CMAKE_CURRENT_SOURCE_DIR}/ctl/*.cpp")
add_executable(mavloom_app ${sources} ${command_sources})
set_target_properties(mavloom_app PROPERTIES OUTPUT_NAME mavloom)
target_include_directories(mavloom_app PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
target_link_libraries(mavloom_app PRIVATE mavloom::router CLI11::CLI11 nlohmann_json::nlohmann_json mavloom_warnings)
mavloom_precompile(mavloom_app mavloom_app <nlohmann/json.hpp>)
if(MAVLOOM_INSTALL)
  install(TARGETS mavloom_app COMPONENT mavloom_runtime)
  add_subdirectory("${PROJECT_SOURCE_DIR}/packaging/systemd" "${PROJECT_BINARY_DIR}/packaging/systemd")
endif()

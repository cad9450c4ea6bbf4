# Debian packages, by CPack: `./run package` builds them. mavloom has the component mavloom_runtime, libmavloom-dev the
# component mavloom_development, and python3-mavloom the component mavloom_python_debian.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Mavloom")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # which would precede the first line of each component's description
set(CPACK_COMPONENTS_ALL mavloom_runtime mavloom_development)
if(MAVLOOM_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL mavloom_python_debian)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
# Files are installed into DESTDIR, so that the unit contains the path that the program will have.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The Mavloom authors <authors@mavloom.invalid>")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_NAME mavloom)
set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_SECTION net)
set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_SHLIBDEPS ON)
if(MAVLOOM_CAN_PACK_RELOCATIONS)  # no symbol names the loader's version
  set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_DEPENDS "libc6 (>= 2.36)")
endif()
set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_SUGGESTS "python3-mavloom")
set(CPACK_COMPONENT_MAVLOOM_RUNTIME_DESCRIPTION "MAVLink router, recorder, simulator and viewer
Mavloom forwards MAVLink between serial lines, UDP, TCP and WebSocket, decodes
and shows every message, records and replays flights, hands telemetry to other
programs by shared memory, and simulates vehicles that answer like real ones.")
set(control_folder "${PROJECT_SOURCE_DIR}/packaging/debian")
set(CPACK_DEBIAN_MAVLOOM_RUNTIME_PACKAGE_CONTROL_EXTRA "${control_folder}/postinst" "${control_folder}/prerm"
    "${control_folder}/postrm")

set(CPACK_DEBIAN_MAVLOOM_DEVELOPMENT_PACKAGE_NAME libmavloom-dev)
set(CPACK_DEBIAN_MAVLOOM_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_MAVLOOM_DEVELOPMENT_PACKAGE_SHLIBDEPS ON)  # of the code generator
set(CPACK_DEBIAN_MAVLOOM_DEVELOPMENT_PACKAGE_DEPENDS
    "libfmt-dev, libexpected-dev, libpugixml-dev, libsodium-dev, libtomlplusplus-dev, \
liblzma-dev, pkg-config")
set(CPACK_COMPONENT_MAVLOOM_DEVELOPMENT_DESCRIPTION "MAVLink routing, framing and simulation: C++ library
The headers, static libraries and code generator behind the program mavloom,
for projects that use CMake: find_package(mavloom).")

set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_NAME python3-mavloom)
set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_SECTION python)
set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_SUGGESTS "python3-pandas, python3-serial")
set(CPACK_DEBIAN_MAVLOOM_PYTHON_DEBIAN_PACKAGE_CONTROL_EXTRA "${control_folder}/python3/postinst"
    "${control_folder}/python3/prerm")
set(CPACK_COMPONENT_MAVLOOM_PYTHON_DEBIAN_DESCRIPTION "MAVLink telemetry at C++ speed: Python package
Links, recordings, shared-memory rings and columns of telemetry in Python, and
mavloom.mavutil, which scripts for pymavlink's mavutil can import instead.")

# Debian wants a copyright file and a changelog from each package.
file(READ "${PROJECT_SOURCE_DIR}/LICENSE" license)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(documents "${PROJECT_BINARY_DIR}/packaging")
configure_file("${control_folder}/copyright.in" "${documents}/copyright" @ONLY)
configure_file("${control_folder}/changelog.in" "${documents}/changelog" @ONLY)
execute_process(COMMAND gzip -9nf "${documents}/changelog" COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" upper)
  install(FILES "${documents}/copyright" "${documents}/changelog.gz"
          DESTINATION "share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}" COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

include(CPack)

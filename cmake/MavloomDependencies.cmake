# Every dependency comes from Debian 12 (packaging/build.list); nothing is downloaded at configure time.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(pugixml REQUIRED)
find_package(tl-expected REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers only: Asio and Beast
pkg_check_modules(sodium REQUIRED IMPORTED_TARGET libsodium)
if(NOT MAVLOOM_MINIMAL)
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  pkg_check_modules(lzma REQUIRED IMPORTED_TARGET liblzma)
endif()

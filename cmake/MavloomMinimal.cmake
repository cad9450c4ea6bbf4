# -DMAVLOOM_MINIMAL=ON: the modules that the small router has, and flags for a small program.
include(CheckCXXSourceCompiles)

set(mavloom_modules_left_out feed flight hil sim simserve view web ws)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE MinSizeRel)
endif()
add_compile_definitions(MAVLOOM_MINIMAL)
add_link_options(LINKER:--strip-all)
set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)

# Packs the table of addresses that the loader adjusts: 90 kB. Older loaders cannot read it.
set(CMAKE_REQUIRED_LINK_OPTIONS "LINKER:-z,pack-relative-relocs")
check_cxx_source_compiles("#include <features.h>
#if !__GLIBC_PREREQ(2, 36)
#error
#endif
int main() {}" MAVLOOM_CAN_PACK_RELOCATIONS)
unset(CMAKE_REQUIRED_LINK_OPTIONS)
if(MAVLOOM_CAN_PACK_RELOCATIONS)
  add_link_options(LINKER:-z,pack-relative-relocs)
endif()

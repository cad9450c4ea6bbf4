# -DMAVLOOM_MINIMAL=ON: the modules that the small router has, and flags for a small program.

set(mavloom_modules_left_out feed flight hil sim simserve view web ws)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE MinSizeRel)
endif()
add_compile_definitions(MAVLOOM_MINIMAL)
add_link_options(LINKER:--strip-all)
set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)

include(MavloomRelocations)
if(MAVLOOM_CAN_PACK_RELOCATIONS)
  add_link_options(${mavloom_pack_relocations})
endif()

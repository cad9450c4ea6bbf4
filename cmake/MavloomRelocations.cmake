# mavloom_pack_relocations: the option that packs the table of addresses that the loader adjusts, half a megabyte of the
# program. Loaders before glibc 2.36 cannot read it, and linkers for some processors ignore it, with a warning.
include(CheckCXXSourceCompiles)
set(mavloom_pack_relocations LINKER:-z,pack-relative-relocs)
set(CMAKE_REQUIRED_LINK_OPTIONS "${mavloom_pack_relocations}")
check_cxx_source_compiles("#include <features.h>
#if !__GLIBC_PREREQ(2, 36)
#error
#endif
int main() {}" MAVLOOM_CAN_PACK_RELOCATIONS FAIL_REGEX "pack-relative-relocs ignored")
unset(CMAKE_REQUIRED_LINK_OPTIONS)

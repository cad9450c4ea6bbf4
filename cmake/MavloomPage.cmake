# The page of `mavloom web`, from web/dist, inside the module `web`: src/web/page_data.cpp embeds each file, compressed
# by gzip. `./run page` makes web/dist; a build needs neither Node.js nor npm.
set(page_folder "${PROJECT_BINARY_DIR}/generated/page")
file(MAKE_DIRECTORY "${page_folder}")
set(page_files "")
foreach(name index.html app.js app.css licences.txt)
  set(source "${PROJECT_SOURCE_DIR}/web/dist/${name}")
  add_custom_command(OUTPUT "${page_folder}/${name}.gz"
    COMMAND gzip -9 -n -c "${source}" > "${page_folder}/${name}.gz"
    DEPENDS "${source}" COMMENT "Compressing web/dist/${name}" VERBATIM)
  list(APPEND page_files "${page_folder}/${name}.gz")
endforeach()
target_sources(mavloom_web PRIVATE ${page_files})
set_source_files_properties("${PROJECT_SOURCE_DIR}/src/web/page_data.cpp" PROPERTIES
  OBJECT_DEPENDS "${page_files}" COMPILE_DEFINITIONS "MAVLOOM_PAGE_FOLDER=\"${page_folder}\""
  SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)

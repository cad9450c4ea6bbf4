# cmake -DVERSION=0.1.0 -DSOURCE=FOLDER -DOUTPUT=FILE -P WriteVersion.cmake
#
# Writes the header with the version's text: the number alone if SOURCE is no git checkout or is the clean commit tagged
# v<VERSION>, else with the commit behind it. The file is touched only when the text changes.
set(text "${VERSION}")
find_program(git git)
if(git AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND "${git}" -C "${SOURCE}" describe --tags --exact-match --match "v${VERSION}" --dirty
                  OUTPUT_VARIABLE tag OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND "${git}" -C "${SOURCE}" describe --always --exclude=* --abbrev=8 --dirty
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(commit AND NOT tag STREQUAL "v${VERSION}")
    string(APPEND text "+g${commit}")
  endif()
endif()

set(content "#define MAVLOOM_VERSION_TEXT \"${text}\"\n")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" present)
endif()
if(NOT present STREQUAL content)
  file(WRITE "${OUTPUT}" "${content}")
endif()

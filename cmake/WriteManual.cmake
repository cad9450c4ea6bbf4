# cmake -DPROGRAM=COMMAND -DOUTPUT=FOLDER -P WriteManual.cmake: the manual pages and the completion of shells, in the
# folders that they have below share/. The program prints them.
function(ask file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE "${OUTPUT}/${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${OUTPUT}")
file(MAKE_DIRECTORY "${OUTPUT}/man/man1" "${OUTPUT}/bash-completion/completions" "${OUTPUT}/zsh/vendor-completions"
     "${OUTPUT}/fish/vendor_completions.d")
ask(bash-completion/completions/mavloom completion bash)
ask(zsh/vendor-completions/_mavloom completion zsh)
ask(fish/vendor_completions.d/mavloom.fish completion fish)
ask(man/man1/mavloom.1 manual mdoc)
file(STRINGS "${OUTPUT}/man/man1/mavloom.1" commands REGEX "^\\.It Xr mavloom-")
foreach(line IN LISTS commands)
  string(REGEX REPLACE "^\\.It Xr mavloom-([a-z]+) 1$" "\\1" command "${line}")
  ask(man/man1/mavloom-${command}.1 manual mdoc ${command})
endforeach()
file(GLOB pages "${OUTPUT}/man/man1/*.1")
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)

# The manual and the completions, from the program itself.
#
#   cmake -D PROGRAM=<momenta> -D FOLDER=<where to> [-D GZIP=<gzip>] -P write_texts.cmake
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${PROGRAM} manual OUTPUT_FILE ${FOLDER}/momenta.1 COMMAND_ERROR_IS_FATAL ANY)
if(GZIP)
  execute_process(COMMAND ${GZIP} -9nkf ${FOLDER}/momenta.1 COMMAND_ERROR_IS_FATAL ANY)
endif()
foreach(shell bash zsh fish)
  execute_process(COMMAND ${PROGRAM} completion ${shell} OUTPUT_FILE ${FOLDER}/momenta.${shell}
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()

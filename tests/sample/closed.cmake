# Runs `alcove view` with closed standard output. It must render its frame and then fail with one
# sentence. Its output must not be sent to the display, whose connection may have taken the number of
# the closed file descriptor.
# ALCOVE: the program; FOLDER: the output folder.
file(REMOVE_RECURSE ${FOLDER})
execute_process(
  COMMAND sh -c "exec \"$@\" >&-" sh ${ALCOVE} view --frames 1 --size 320x180 --out ${FOLDER}
  TIMEOUT 300 RESULT_VARIABLE status ERROR_VARIABLE error)
if(NOT status EQUAL 1 OR NOT error MATCHES "^alcove: The output cannot be written[^\n]*\n$")
  message(FATAL_ERROR "The status is ${status}: ${error}")
endif()
if(NOT EXISTS ${FOLDER}/view.png)
  message(FATAL_ERROR "There is no picture.")
endif()

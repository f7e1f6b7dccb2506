# Checks that `alcove ARGUMENTS` fails with a message if the disk is full. ALCOVE: the program.
separate_arguments(ARGUMENTS)
execute_process(COMMAND ${ALCOVE} ${ARGUMENTS} RESULT_VARIABLE status OUTPUT_FILE /dev/full
  ERROR_VARIABLE error)
if(NOT status EQUAL 1 OR NOT error MATCHES "^alcove: The output cannot be written[^\n]*\n$")
  message(FATAL_ERROR "The status is ${status}: ${error}")
endif()

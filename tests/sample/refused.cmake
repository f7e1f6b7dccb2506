# Checks that `alcove ARGUMENTS` ends with status STATUS (default 1) and prints one sentence on stderr that
# begins with SENTENCE. ALCOVE: the program; LAUNCHER: an optional command that starts it.
if(NOT DEFINED STATUS)
  set(STATUS 1)
endif()
separate_arguments(ARGUMENTS)
execute_process(COMMAND ${LAUNCHER} ${ALCOVE} ${ARGUMENTS} RESULT_VARIABLE status
  OUTPUT_VARIABLE output ERROR_VARIABLE error)
if(NOT status EQUAL ${STATUS})
  message(FATAL_ERROR "The status is ${status}, not ${STATUS}.")
endif()
if(NOT error MATCHES "^alcove: ${SENTENCE}[^\n]*\n$" OR output)
  message(FATAL_ERROR "Not the sentence that was expected: ${output}${error}")
endif()

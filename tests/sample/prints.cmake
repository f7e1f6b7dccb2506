# Checks that `alcove ARGUMENTS` ends with status 0, that its output matches PATTERN, and that it prints
# one line that begins with NOTE, or nothing if there is no NOTE, on stderr. ALCOVE: the program.
separate_arguments(ARGUMENTS)
execute_process(COMMAND ${ALCOVE} ${ARGUMENTS} RESULT_VARIABLE status OUTPUT_VARIABLE output
  ERROR_VARIABLE error)
string(STRIP "${error}" error)
if(NOT status EQUAL 0 OR NOT error MATCHES "^${NOTE}[^\n]*$" OR (error AND NOT DEFINED NOTE))
  message(FATAL_ERROR "The status is ${status}: ${error}")
endif()
if(NOT output MATCHES "${PATTERN}")
  message(FATAL_ERROR "Not what was expected: ${output}")
endif()

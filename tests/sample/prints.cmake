# `alcove ARGUMENTS` ends with status 0, nothing on stderr and output that has PATTERN.
# ALCOVE: the program.
separate_arguments(ARGUMENTS)
execute_process(COMMAND ${ALCOVE} ${ARGUMENTS} RESULT_VARIABLE status OUTPUT_VARIABLE output
  ERROR_VARIABLE error)
if(NOT status EQUAL 0 OR error)
  message(FATAL_ERROR "The status is ${status}: ${error}")
endif()
if(NOT output MATCHES "${PATTERN}")
  message(FATAL_ERROR "Not what was expected: ${output}")
endif()

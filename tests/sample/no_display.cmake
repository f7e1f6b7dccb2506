# Without a display, `alcove view` ends with status 1 and one sentence that says so. ALCOVE: the
# program.
unset(ENV{DISPLAY})
unset(ENV{WAYLAND_DISPLAY})
execute_process(COMMAND ${ALCOVE} view RESULT_VARIABLE status OUTPUT_VARIABLE output
  ERROR_VARIABLE error)
if(NOT status EQUAL 1)
  message(FATAL_ERROR "The status is ${status}, not 1.")
endif()
if(NOT error MATCHES "^alcove: There is no display to open a window on[^\n]*\n$" OR output)
  message(FATAL_ERROR "Not the sentence that was expected: ${output}${error}")
endif()

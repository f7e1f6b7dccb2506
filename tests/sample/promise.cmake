# Checks that the line that `alcove recommend ARGUMENTS --out FILE` prints gives the standing error that
# was promised, and the same with the settings of the file instead. ALCOVE: the program.
separate_arguments(ARGUMENTS)
list(GET ARGUMENTS 0 scene)  # the tests run at the same time, each with files of its own
set(promise "promise_${scene}")
execute_process(COMMAND ${ALCOVE} recommend ${ARGUMENTS} --out ${promise}.txt OUTPUT_VARIABLE output
  ERROR_VARIABLE error)
string(REGEX MATCH "standing +RMSE ([0-9.]+)" found "${output}")
set(promised "${CMAKE_MATCH_1}")
string(REGEX MATCH "\nalcove compare [^\n]*" line "${output}")
if(NOT promised OR NOT line)
  message(FATAL_ERROR "No promise: ${output}${error}")
endif()
string(STRIP "${line} --out ${promise}" line)
string(REGEX REPLACE " --quality [a-z_]+( --set [^ ]+)*" " --settings ${promise}.txt" same "${line}")
foreach(command "${line}" "${same}")
  separate_arguments(words UNIX_COMMAND "${command}")
  list(POP_FRONT words)
  execute_process(COMMAND ${ALCOVE} ${words} OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT output MATCHES "against ray-traced scene truth +${promised}[^0-9]")
    message(FATAL_ERROR "${command}\n does not give ${promised}: ${output}${error}")
  endif()
endforeach()

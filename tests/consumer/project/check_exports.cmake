# Fails if a shared library exports a symbol that is not a function of alcove.h.
# Run with -DNM=... -DLIBRARY=...
execute_process(COMMAND ${NM} --dynamic --defined-only --extern-only ${LIBRARY}
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${symbols}")
set(others ${lines})
list(FILTER others EXCLUDE REGEX " T alcove[A-Z][A-Za-z]*$")
if(others)
  message(FATAL_ERROR "${LIBRARY} exports more than alcove.h declares: ${others}")
endif()
if(NOT symbols MATCHES "alcoveRecordFrame")
  message(FATAL_ERROR "${LIBRARY} does not export alcoveRecordFrame.")
endif()

# Fails if a shared library exports anything but the functions that HEADERS, a folder, declares, or not all of them.
# LIBRARY is what programs link with: on Windows the import library.
# cmake -D NM=... -D LIBRARY=... -D HEADERS=... -P check_exports.cmake
set(dynamic --dynamic)
if(LIBRARY MATCHES "\\.dll\\.a$")
  set(dynamic "")
endif()
execute_process(COMMAND ${NM} ${dynamic} --defined-only --extern-only ${LIBRARY}
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL " T [^\n]+" exported "${symbols}")
list(TRANSFORM exported REPLACE " T " "")
file(GLOB headers ${HEADERS}/*.h)
set(declared "")
foreach(header IN LISTS headers)
  file(READ ${header} text)
  string(REGEX MATCHALL "\n[A-Za-z][^\n/]*[ *]alcove[A-Z][A-Za-z]*\\(" functions "${text}")
  list(TRANSFORM functions REPLACE ".*[ *](alcove[A-Za-z]*)\\(" "\\1")
  list(APPEND declared ${functions})
endforeach()
list(SORT exported)
list(SORT declared)
if(NOT declared OR NOT exported STREQUAL declared)
  message(FATAL_ERROR "${LIBRARY} exports\n${exported}\nThe headers declare\n${declared}")
endif()

# Checks that `alcove view` renders some frames without a validation message, writes the last one and
# prints the command that renders it again. ALCOVE: the program; FOLDER: a folder that may be removed.
file(REMOVE_RECURSE ${FOLDER})
execute_process(
  COMMAND ${ALCOVE} view --frames 4 --orbit 1 --size 320x180 --validation --out ${FOLDER}
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE error)
if(NOT status EQUAL 0 OR error)
  message(FATAL_ERROR "The status is ${status}: ${error}")
endif()
if(NOT EXISTS ${FOLDER}/view.png OR NOT output MATCHES "alcove render .*--size 320x180")
  message(FATAL_ERROR "No picture or no command: ${output}")
endif()

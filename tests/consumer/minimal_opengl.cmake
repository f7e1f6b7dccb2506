# Runs the minimal programs of Vulkan and of OpenGL, and checks that no pixel of their pictures differs
# by more than 1 of 255.
file(MAKE_DIRECTORY ${FOLDER})
foreach(command "${MINIMAL_C};${FOLDER}/vulkan.pgm" "${MINIMAL_OPENGL};${SHADERS};${FOLDER}/opengl.pgm"
    "${COMPARE};${FOLDER}/vulkan.pgm;${FOLDER}/opengl.pgm;1")
  execute_process(COMMAND ${command} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${command} ended with ${status} and printed: ${output}")
  endif()
endforeach()
message("${output}")

# Runs the two programs that readers copy, under the validation layers where they are installed, and
# checks that both write the same picture and that nothing is printed: a validation message would be.
foreach(program C CPP)
  set(picture ${FOLDER}/${program}.pgm)
  file(MAKE_DIRECTORY ${FOLDER})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    ${MINIMAL_${program}} ${picture}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0 OR NOT output STREQUAL "")
    message(FATAL_ERROR "${MINIMAL_${program}} ended with ${status} and printed: ${output}")
  endif()
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${FOLDER}/C.pgm ${FOLDER}/CPP.pgm
  RESULT_VARIABLE different)
if(different)
  message(FATAL_ERROR "The C and the C++ program write different pictures.")
endif()

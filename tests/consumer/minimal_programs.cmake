# Runs the two minimal programs, under the validation layers if they are installed. Checks that both
# write the same image and that nothing is printed, such as a validation message.
foreach(program C CPP)
  set(picture ${FOLDER}/${program}.pgm)
  file(MAKE_DIRECTORY ${FOLDER})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
    ${EMULATOR} ${MINIMAL_${program}} ${picture}
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

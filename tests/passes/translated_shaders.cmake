# Compiles the translations of all shaders as far as glslang can: HLSL with its front end for HLSL, and
# GLSL. cmake -D GLSLANG=... -D FOLDER=... -P translated_shaders.cmake
file(GLOB shaders ${FOLDER}/*.spv)
list(LENGTH shaders count)
if(count LESS 20)
  message(FATAL_ERROR "only ${count} shaders in ${FOLDER}")
endif()
foreach(shader IN LISTS shaders)
  cmake_path(REPLACE_EXTENSION shader hlsl OUTPUT_VARIABLE hlsl)
  cmake_path(REPLACE_EXTENSION shader glsl OUTPUT_VARIABLE glsl)
  foreach(arguments "-D;-V;-e;main;-o;${CMAKE_CURRENT_BINARY_DIR}/hlsl.spv;${hlsl}" "${glsl}")
    execute_process(COMMAND ${GLSLANG} -S comp ${arguments} RESULT_VARIABLE status
      OUTPUT_VARIABLE output)
    if(NOT status EQUAL 0)
      message(SEND_ERROR "${arguments}: ${output}")
    endif()
  endforeach()
endforeach()

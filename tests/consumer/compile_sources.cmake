# Compiles every source of the two libraries, without making objects, with COMPILER and FLAGS (a list).
# cmake -D PROJECT_DIR=... -D BUILD_DIR=... -D COMPILER=... -D FLAGS=... -D INCLUDES=... -P compile_sources.cmake
#
# BUILD_DIR has the shaders and tables that the build makes for the passes. INCLUDES lists directories
# with the headers of Vulkan, tl::expected and GLM. A cross compiler must not see the other headers of the
# host, so only these subfolders are linked to.
# Several of these may run at the same time, so each compiler has a directory.
get_filename_component(compiler ${COMPILER} NAME)
set(headers ${CMAKE_CURRENT_BINARY_DIR}/compile_sources_include_${compiler})
file(MAKE_DIRECTORY ${headers})
foreach(include IN LISTS INCLUDES)
  foreach(folder vulkan vk_video tl glm)
    if(EXISTS ${include}/${folder})
      file(CREATE_LINK ${include}/${folder} ${headers}/${folder} SYMBOLIC)
    endif()
  endforeach()
endforeach()
file(GLOB sources ${PROJECT_DIR}/framegraph/src/*.cpp ${PROJECT_DIR}/framegraph/verifier/src/*.cpp
  ${PROJECT_DIR}/passes/src/*/*.cpp)
list(LENGTH sources count)
if(count LESS 40)
  message(FATAL_ERROR "only ${count} sources in ${PROJECT_DIR}")
endif()
foreach(source IN LISTS sources)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 -fsyntax-only ${FLAGS} -DVK_NO_PROTOTYPES
      -I${PROJECT_DIR}/framegraph/include -I${PROJECT_DIR}/framegraph/verifier/include
      -I${PROJECT_DIR}/framegraph/src -I${PROJECT_DIR}/passes/include -I${PROJECT_DIR}/passes/src
      -I${PROJECT_DIR}/shaders -I${BUILD_DIR}/passes -isystem ${headers} ${source}
    RESULT_VARIABLE result ERROR_VARIABLE messages)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "${source}\n${messages}")
  endif()
endforeach()

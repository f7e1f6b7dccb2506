# Compiles every source of the render graph, without making objects, with COMPILER and FLAGS (a list).
# cmake -D SOURCE_DIR=<framegraph> -D COMPILER=... -D FLAGS=... -D INCLUDES=... -P compile_sources.cmake
#
# INCLUDES: directories with the headers of Vulkan and tl::expected. A cross compiler must not see the
# host's other headers, so that only these subfolders are linked to.
# Several of these may run at the same time.
get_filename_component(compiler ${COMPILER} NAME)
set(headers ${CMAKE_CURRENT_BINARY_DIR}/compile_sources_include_${compiler})
file(MAKE_DIRECTORY ${headers})
foreach(include IN LISTS INCLUDES)
  foreach(folder vulkan vk_video tl)
    if(EXISTS ${include}/${folder})
      file(CREATE_LINK ${include}/${folder} ${headers}/${folder} SYMBOLIC)
    endif()
  endforeach()
endforeach()
file(GLOB sources ${SOURCE_DIR}/src/*.cpp ${SOURCE_DIR}/verifier/src/*.cpp)
list(LENGTH sources count)
if(count LESS 20)
  message(FATAL_ERROR "only ${count} sources in ${SOURCE_DIR}")
endif()
foreach(source IN LISTS sources)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 -fsyntax-only ${FLAGS} -DVK_NO_PROTOTYPES -I${SOURCE_DIR}/include
      -I${SOURCE_DIR}/verifier/include -I${SOURCE_DIR}/src -isystem ${headers} ${source}
    RESULT_VARIABLE result ERROR_VARIABLE messages)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "${source}\n${messages}")
  endif()
endforeach()

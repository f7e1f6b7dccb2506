# alcove_embed_shader(TARGET SHADER [NAME name] [DEFINES a b...])
#
# Compiles a GLSL file to SPIR-V with glslang while TARGET is built and makes it includable there as
# "spirv/NAME.h", which defines `const uint32_t kName[]`, the words of the module. NAME defaults to the
# file's stem. A different NAME, together with DEFINES, makes a variant of the same file.
find_program(ALCOVE_GLSLANG glslangValidator REQUIRED)

function(alcove_embed_shader target shader)
  cmake_parse_arguments(arg "" "NAME" "DEFINES" ${ARGN})
  cmake_path(ABSOLUTE_PATH shader OUTPUT_VARIABLE source)
  cmake_path(GET shader STEM name)
  if(arg_NAME)
    set(name ${arg_NAME})
  endif()
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  file(MAKE_DIRECTORY ${directory})
  # gtao_bitmask -> kGtaoBitmask
  string(REPLACE "_" ";" words ${name})
  set(variable k)
  foreach(word IN LISTS words)
    string(SUBSTRING ${word} 0 1 first)
    string(SUBSTRING ${word} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND variable ${first}${rest})
  endforeach()
  list(TRANSFORM arg_DEFINES PREPEND -D)
  add_custom_command(
    OUTPUT ${directory}/${name}.h
    COMMAND ${ALCOVE_GLSLANG} --quiet -V --target-env vulkan1.2 --vn ${variable}
      --depfile ${directory}/${name}.d -I${PROJECT_SOURCE_DIR}/shaders ${arg_DEFINES}
      -o ${directory}/${name}.h ${source}
    DEPENDS ${source}
    DEPFILE ${directory}/${name}.d
    COMMENT "Compiling ${shader} to SPIR-V"
    VERBATIM)
  target_sources(${target} PRIVATE ${directory}/${name}.h)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

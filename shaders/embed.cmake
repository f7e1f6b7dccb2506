# alcove_embed_shader(TARGET SHADER [NAME name] [DEFINES a b...])
#
# Compiles a GLSL file to SPIR-V with glslang and spirv-opt while TARGET is built and makes it includable
# there as "spirv/NAME.h", which defines `const uint32_t kName[]`, the words of the module without its
# debug names. shader_files/NAME.spv is the module with them. NAME defaults to the file's stem. A different
# NAME, together with DEFINES, makes a variant of the same file.
find_program(ALCOVE_GLSLANG glslangValidator REQUIRED)
find_program(ALCOVE_SPIRV_OPT spirv-opt REQUIRED)

function(alcove_embed_shader target shader)
  cmake_parse_arguments(arg "" "NAME" "DEFINES" ${ARGN})
  cmake_path(ABSOLUTE_PATH shader OUTPUT_VARIABLE source)
  cmake_path(GET shader STEM name)
  if(arg_NAME)
    set(name ${arg_NAME})
  endif()
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  set(module ${CMAKE_CURRENT_BINARY_DIR}/shader_files/${name}.spv)
  file(MAKE_DIRECTORY ${directory} ${CMAKE_CURRENT_BINARY_DIR}/shader_files)
  # gtao_bent -> kGtaoBent
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
    OUTPUT ${directory}/${name}.spv
    COMMAND ${ALCOVE_GLSLANG} --quiet -V --target-env vulkan1.1 --depfile ${directory}/${name}.d
      -I${PROJECT_SOURCE_DIR}/shaders ${arg_DEFINES} -o ${directory}/${name}.spv ${source}
    DEPENDS ${source}
    DEPFILE ${directory}/${name}.d
    COMMENT "Compiling ${shader} to SPIR-V"
    VERBATIM)
  add_custom_command(
    OUTPUT ${directory}/${name}.h ${module}
    COMMAND ${CMAKE_COMMAND} -DMODULE=${directory}/${name}.spv -DOPTIMISED=${module}
      -DNAME=${variable} -DHEADER=${directory}/${name}.h -DOPTIMISER=${ALCOVE_SPIRV_OPT}
      -P ${PROJECT_SOURCE_DIR}/shaders/embed_spirv.cmake
    DEPENDS ${directory}/${name}.spv ${PROJECT_SOURCE_DIR}/shaders/embed_spirv.cmake
    COMMENT "Optimising ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE ${directory}/${name}.h)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# alcove_add_shader_files(TARGET LIBRARY READER NAME...)
#
# Lets the program READER read the interfaces of the named shaders, which are embedded in LIBRARY: the
# library can include "spirv/interfaces.h". Adds a target that installs the shaders' SPIR-V and
# interfaces.json from the folder that ALCOVE_SHADER_FILES then names. With ALCOVE_TRANSLATE_SHADERS,
# spirv-cross translates each shader to HLSL of shader model 6 (.hlsl), MSL 2.1 (.metal) and GLSL 4.50
# (.glsl) too. Numbers of bindings are kept. In GLSL, specialisation constants become macros
# SPIRV_CROSS_CONSTANT_ID_<id>.
option(ALCOVE_TRANSLATE_SHADERS "Translate the shaders to HLSL, MSL and GLSL with spirv-cross" OFF)

function(alcove_add_shader_files target library reader)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/shader_files)
  set(ALCOVE_SHADER_FILES ${folder} CACHE INTERNAL "The folder of the shaders as files")
  list(TRANSFORM ARGN APPEND .spv OUTPUT_VARIABLE files)
  list(TRANSFORM files PREPEND ${folder}/)
  set(interfaces ${CMAKE_CURRENT_BINARY_DIR}/spirv/interfaces.h ${folder}/interfaces.json)
  add_custom_command(OUTPUT ${interfaces} COMMAND ${reader} ${interfaces} ${files}
    DEPENDS ${reader} ${files}
    COMMENT "Reading the interfaces of the shaders" VERBATIM)
  target_sources(${library} PRIVATE ${interfaces})
  list(APPEND files ${folder}/interfaces.json)
  if(ALCOVE_TRANSLATE_SHADERS)
    find_program(ALCOVE_SPIRV_CROSS spirv-cross REQUIRED)
    foreach(name IN LISTS ARGN)
      set(translated ${folder}/${name}.hlsl ${folder}/${name}.metal ${folder}/${name}.glsl)
      add_custom_command(OUTPUT ${translated}
        COMMAND ${ALCOVE_SPIRV_CROSS} ${name}.spv --output ${name}.hlsl --hlsl --shader-model 60
        COMMAND ${ALCOVE_SPIRV_CROSS} ${name}.spv --output ${name}.metal --msl --msl-version 20100
          --msl-decoration-binding
        COMMAND ${ALCOVE_SPIRV_CROSS} ${name}.spv --output ${name}.glsl --version 450 --no-es
          --combined-samplers-inherit-bindings
        DEPENDS ${folder}/${name}.spv
        WORKING_DIRECTORY ${folder}
        COMMENT "Translating ${name} to HLSL, MSL and GLSL" VERBATIM)
      list(APPEND files ${translated})
    endforeach()
  endif()
  add_custom_target(${target} ALL DEPENDS ${files})
  add_dependencies(${target} ${library})  # whose build makes the modules and their interfaces
  install(FILES ${files} DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/alcove/shaders)
endfunction()

# Writes the libraries as two files, for engines with a build system of their own: FOLDER/alcove.h has the
# HEADERS of the C interface, and FOLDER/alcove.cpp the code, which is SOURCES in their order with each header
# where it is first included. Headers in quotation marks and those of tl::expected come from DIRECTORIES. DEPFILE
# then lists what was read. Runs in the folder of the project.
# cmake -D FOLDER=... -D VERSION=... -D DIRECTORIES=... -D HEADERS=... -D SOURCES=... -D DEPFILE=... -P write_two_files.cmake
cmake_minimum_required(VERSION 3.23)

# Appends a file to OUT. The plan verifier, which an #ifdef names, is a library of its own.
function(add_file out path)
  set_property(GLOBAL APPEND PROPERTY read_files ${path})
  file(READ ${path} text)
  cmake_path(GET path PARENT_PATH folder)
  string(REPLACE "#pragma once\n" "" text "${text}")
  string(REGEX REPLACE "#ifdef ALCOVE_FRAMEGRAPH_VERIFIES\n[^#]*(#include[^#]*)?#endif\n" "" text "${text}")
  add_text(${out} ${folder} "${text}")
endfunction()

# Appends the text of a file in FOLDER, with the headers that are not written yet.
function(add_text out folder text)
  while(text MATCHES "(^|\n)#include ([<\"])([^>\"]+)[^\n]*\n")
    set(line "${CMAKE_MATCH_0}")
    set(before_line "${CMAKE_MATCH_1}")
    set(name ${CMAKE_MATCH_3})
    unset(found)
    if(CMAKE_MATCH_2 STREQUAL "\"" OR name MATCHES "^tl/")
      find_file(found ${name} PATHS ${folder} ${DIRECTORIES} NO_DEFAULT_PATH NO_CACHE REQUIRED)
    endif()
    string(FIND "${text}" "${line}" begin)
    string(LENGTH "${line}" length)
    math(EXPR end "${begin} + ${length}")
    string(SUBSTRING "${text}" 0 ${begin} before)
    string(SUBSTRING "${text}" ${end} -1 text)
    file(APPEND ${out} "${before}${before_line}")
    get_property(written GLOBAL PROPERTY written)
    if(found AND NOT found IN_LIST written)
      set_property(GLOBAL APPEND PROPERTY written ${found})
      add_file(${out} ${found})
    elseif(NOT found AND NOT name IN_LIST written)
      set_property(GLOBAL APPEND PROPERTY written ${name})
      file(APPEND ${out} "#include <${name}>\n")
    endif()
  endwhile()
  file(APPEND ${out} "${text}")
endfunction()

file(READ LICENSE licence)
string(REPLACE "\n" "\n// " licence "// ${licence}")
string(REGEX REPLACE "// (\n|$)" "//\\1" licence "${licence}")
file(WRITE ${FOLDER}/alcove.h
"// The C interface of Alcove ${VERSION}, ground-truth ambient occlusion for Vulkan. alcove.cpp has the code.
//
${licence}
")
foreach(header IN LISTS HEADERS)
  add_text(${FOLDER}/alcove.h . "#include \"${header}\"\n")
endforeach()
file(WRITE ${FOLDER}/alcove.cpp
"// All code of Alcove ${VERSION}, ground-truth ambient occlusion for Vulkan, with the SPIR-V of its shaders.
//
// Add this file to the build of an engine, and include alcove.h, which lies beside it. It takes a C++20 compiler,
// Vulkan's headers and GLM, and links nothing: Vulkan's functions come from AlcoveContextInfo. It needs no macro,
// no exceptions and no run-time type information. `cmake --build build/release --target two_files` writes it from
// the sources of Alcove.
//
${licence}
// tl::expected in this file has a licence of its own, CC0.
#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#ifdef __GNUC__
#pragma GCC diagnostic ignored \"-Wmissing-field-initializers\"  // a designated initialiser leaves the rest zero
#pragma GCC diagnostic ignored \"-Wunused-const-variable\"  // constants that only shaders use
#pragma GCC diagnostic ignored \"-Wunused-parameter\"       // in tl::expected without exceptions
#endif
#include \"alcove.h\"
")
foreach(source IN LISTS SOURCES)
  file(APPEND ${FOLDER}/alcove.cpp "\n// ---- ${source} ----\n")
  add_file(${FOLDER}/alcove.cpp ${CMAKE_CURRENT_SOURCE_DIR}/${source})
endforeach()
get_property(read_files GLOBAL PROPERTY read_files)
list(JOIN read_files " " read_files)
file(WRITE ${DEPFILE} "${FOLDER}/alcove.cpp: ${read_files}\n")

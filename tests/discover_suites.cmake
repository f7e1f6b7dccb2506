# Writes to FILE one test of ctest for each test suite of PROGRAM. The tests of a suite run in one
# process, which creates the device and each pipeline once.
cmake_minimum_required(VERSION 3.23)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\r\n" "\n" list "${list}")
list(REMOVE_ITEM PROGRAM "")
list(JOIN PROGRAM "]=] [=[" PROGRAM)
string(REGEX MATCHALL "\n[^ \n]+\\.\n" suites "\n${list}")
set(tests "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[\n.]" "" suite ${suite})
  string(APPEND tests "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
    "set_tests_properties([=[${suite}]=] PROPERTIES TIMEOUT 900 COST 20 LABELS gpu "
    "WORKING_DIRECTORY [=[${FOLDER}]=])\n")
endforeach()
file(WRITE ${FILE} "${tests}")

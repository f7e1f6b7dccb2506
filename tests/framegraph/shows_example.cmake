# Fails unless a code block of README is exactly the file EXAMPLE.
# cmake -D README=... -D EXAMPLE=... -P shows_example.cmake
file(READ ${README} readme)
file(READ ${EXAMPLE} example)
string(FIND "${readme}" "```cpp\n${example}```" at)
if(at EQUAL -1)
  message(FATAL_ERROR "No code block of ${README} is ${EXAMPLE}: copy the file into it.")
endif()

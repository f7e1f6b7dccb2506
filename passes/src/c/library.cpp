// The C library consists of the objects of the two C++ libraries. CMake derives the linker of its
// users, the one for C++, from the language of this source.
#include "alcove/alcove.h"

static_assert(ALCOVE_VERSION != 0);

// The C library is made of the objects of the two C++ libraries. A target needs a source of its own
// to tell its users that it is C++, and so what a C program has to be linked with.
#include "alcove/alcove.h"

static_assert(ALCOVE_VERSION != 0);

// Counts allocations. Linking allocation_counter.cpp replaces operator new.
#pragma once

#include <cstddef>

namespace alcove::framegraph {

// Returns the number of calls of operator new by this thread.
std::size_t allocations();

// Makes one of the next allocations of this thread throw std::bad_alloc: the one with number
// `which`, counted from 1, among those of the program's own code (not of shared libraries). 0 makes
// none fail. Works on Linux.
void fail_allocation(std::size_t which);
// Returns whether that allocation has failed.
bool allocation_failed();

}  // namespace alcove::framegraph

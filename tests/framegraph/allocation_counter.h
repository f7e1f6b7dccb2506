// Counts allocations. Linking allocation_counter.cpp replaces operator new.
#pragma once

#include <cstddef>

namespace alcove::framegraph {

// Returns the number of calls of operator new by this thread.
std::size_t allocations();

// Makes one later allocation of this thread throw std::bad_alloc: the allocation with the number
// `which`, counted from 1 from this call on. Only allocations by the program's own code count, and
// not those of shared libraries. 0 makes none fail. Works on Linux.
void fail_allocation(std::size_t which);
// Returns whether that allocation has failed.
bool allocation_failed();

}  // namespace alcove::framegraph

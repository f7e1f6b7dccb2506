// Counts allocations: linking allocation_counter.cpp replaces operator new.
#pragma once

#include <cstddef>

namespace alcove::framegraph {

// Calls of operator new by this thread so far.
std::size_t allocations();

// Has the allocation, counted from 1, that this program's own code (not a shared library's) asks
// for in this thread throw std::bad_alloc; 0: none. On Linux.
void fail_allocation(std::size_t which);
// Whether it has.
bool allocation_failed();

}  // namespace alcove::framegraph

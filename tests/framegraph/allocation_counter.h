// Counts allocations. Linking allocation_counter.cpp replaces operator new.
#pragma once

#include <cstddef>

namespace alcove::framegraph {

// Returns the number of calls of operator new by this thread.
std::size_t allocations();

// Makes one later allocation of the calling thread throw std::bad_alloc: allocation number `which`,
// where number 1 is the first allocation after this call. With 0, no allocation fails. Only
// allocations by the program's own code are counted, not those inside shared libraries. Has an
// effect on Linux only.
void fail_allocation(std::size_t which);
// Returns whether that allocation has failed.
bool allocation_failed();

}  // namespace alcove::framegraph

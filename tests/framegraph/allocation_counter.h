// Counts allocations: linking allocation_counter.cpp replaces operator new.
#pragma once

#include <cstddef>

namespace alcove::framegraph {

// Calls of operator new by this thread so far.
std::size_t allocations();

}  // namespace alcove::framegraph

// A second opinion on the ordering in a plan: for every pair of conflicting operations of two
// frames it searches for a path of barriers, events and semaphores from the one to the other. Slow
// and simple; it shares nothing with the verifier, which carries knowledge forward instead.
// Layouts, contents, owners and lifetimes are not its business.
#pragma once

#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// Empty when every pair is ordered, else the first that is not.
std::string find_unordered_pair(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph

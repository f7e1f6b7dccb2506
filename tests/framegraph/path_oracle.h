// An independent check of the ordering in a plan. For every pair of conflicting operations in two
// frames it searches for a path of barriers and semaphores from one to the other. It is slow and
// simple, and shares no code with the verifier. It does not check layouts, contents, owners and
// lifetimes.
#pragma once

#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// Returns the first pair that is not ordered, as a text, or an empty text if all are.
std::string find_unordered_pair(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph

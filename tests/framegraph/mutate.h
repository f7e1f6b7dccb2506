// Makes all mutants of a valid plan. A mutant is the plan with one harmful change, which the
// verifier must find.
#pragma once

#include <functional>
#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// Calls `visit` with each mutant and the kind of its change, for example "narrow source stage".
void for_each_mutant(const GraphDescription& graph, const Plan& plan,
                     const std::function<void(const std::string& kind, const Plan& mutant)>& visit);

}  // namespace alcove::framegraph

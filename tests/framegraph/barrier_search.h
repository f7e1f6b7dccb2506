// Searches for valid plans with fewer barrier commands than the compiler's plan.
#pragma once

#include <cstdint>

#include "alcove/framegraph/compile.h"

namespace alcove::framegraph {

// Fails the running test if the plan would still be valid with one barrier command fewer, wherever
// the remaining commands are. Plans with still fewer commands need no search: if one of them were
// valid, it would also be valid with additional commands. Each barrier is as strong as possible: it
// covers all stages and accesses, and each layout change of the plan moves to the last command that
// is not after the pass that needs it. The plan must have one queue and at most 30 passes. Returns
// the number of placements tried.
std::uint32_t expect_no_command_too_many(const GraphDescription& graph, const Limits& limits,
                                         const Plan& plan);

}  // namespace alcove::framegraph

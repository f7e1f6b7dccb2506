// Searches for valid plans with fewer barrier commands than the compiler's plan. A test fails if
// one is found.
#pragma once

#include <cstdint>

#include "alcove/framegraph/compile.h"

namespace alcove::framegraph {

// Returns the plan with barriers only before the positions whose bits are set in `mask`. Each
// barrier is as strong as possible: it covers all stages and accesses, and each layout change of
// the plan moves to the last of those positions that is not after the pass that needs it. The plan
// must have one queue and at most 30 passes.
Plan with_barriers_at(const Plan& plan, std::uint32_t mask);

// Fails the running test if the plan would still be valid with one barrier command fewer, wherever
// the remaining commands are. Prints the number of commands and the number of placements tried.
// Plans with still fewer commands need no search: if one of them were valid, it would also be valid
// with additional commands.
void expect_no_command_too_many(const char* name, const GraphDescription& graph,
                                const Limits& limits, const Plan& plan);

}  // namespace alcove::framegraph

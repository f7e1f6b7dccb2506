// Plans with fewer barrier commands than compile gave them: none of them may be right.
#pragma once

#include <cstdint>

#include "alcove/framegraph/compile.h"

namespace alcove::framegraph {

// The plan, of one queue and at most 30 passes, with barriers before the positions of a mask only,
// each as strong as can be: everything waits for everything, and each layout change of the plan is
// moved to the latest of those positions that the change's own pass allows.
Plan with_barriers_at(const Plan& plan, std::uint32_t mask);

// Fails the running test if the plan would be right with a command fewer at any places; prints how
// many commands it has and how many places were tried. With a command more a right plan stays
// right, so that this covers all smaller numbers.
void expect_no_command_too_many(const char* name, const GraphDescription& graph,
                                const Limits& limits, const Plan& plan);

}  // namespace alcove::framegraph

// Checks a plan against the declaration by replaying it access by access. Shares no code with
// compile.
//
// Two frames of the plan are replayed, so that what the second does to the memory of the first is
// seen. For every pair of conflicting accesses (to one subresource, or to the same bytes) it asks
// for a happens-before with availability and visibility, over queues; it follows the layout and
// owner of every subresource, what each byte last held, and the final_states of imports.
#pragma once

#include <tl/expected.hpp>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/description.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// The limits are those that the plan was made for. Errors have code `verification`.
[[nodiscard]] tl::expected<void, Errors> verify(const GraphDescription& graph, const Limits& limits,
                                                const Plan& plan);

}  // namespace alcove::framegraph

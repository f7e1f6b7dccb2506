// Checks a plan against the declaration by replaying it access by access. It shares no code with
// the compiler.
//
// The plan is replayed for two frames, because a frame also has to wait for the uses of its memory
// in the previous frame. Every access must happen after the earlier conflicting accesses to its
// subresource or to its bytes of memory, and their writes must be available and visible to it, on
// all queues. The verifier also follows the layout, the owning queue family and the contents of
// every subresource, and the final states of imports. The time of a check is proportional to the
// number of barriers between the two accesses.
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

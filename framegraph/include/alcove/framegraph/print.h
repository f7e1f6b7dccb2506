// Prints plans as text and for Graphviz.
#pragma once

#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// The passes in order with their barriers and the reasons why they run, the culled passes with
// theirs, and a chart of the transients' lifetimes by their offsets in memory.
std::string print_text(const GraphDescription& graph, const Plan& plan);
// Graphviz: a box for each pass, coloured by queue, with its number of barriers, and an edge for
// the resource versions that one pass writes and another uses. Culled passes are dashed.
std::string print_dot(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph

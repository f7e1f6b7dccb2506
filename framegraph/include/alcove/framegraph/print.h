// Prints plans as text and for Graphviz.
#pragma once

#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// Returns a text with the passes in order, their barriers and the reasons why they run, the culled
// passes with the reasons why not, and a chart of the transients' lifetimes and memory offsets.
std::string print_text(const GraphDescription& graph, const Plan& plan);
// Returns a graph for Graphviz: a box for each pass, coloured by queue, with its number of
// barriers, and an edge for each resource version that one pass writes and another uses. Culled
// passes are dashed.
std::string print_dot(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph

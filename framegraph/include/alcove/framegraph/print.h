// A plan for people and for programs.
#pragma once

#include <string>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

// Passes in order with their barriers and why they are there, what was culled and why, and
// lifetimes against memory as a picture of characters.
std::string print_text(const GraphDescription& graph, const Plan& plan);
// Everything in the plan as one JSON object.
std::string print_json(const GraphDescription& graph, const Plan& plan);
// Graphviz: passes as boxes coloured by queue with their number of barriers, the versions that one
// hands to another as an edge; culled passes dashed.
std::string print_dot(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph

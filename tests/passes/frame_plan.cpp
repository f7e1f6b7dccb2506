#include "kept.h"

#include <gtest/gtest.h>

#include "alcove/framegraph/compile.h"

namespace alcove::passes {

Kept kept_of(const framegraph::Graph& graph) {
  Kept kept;
  const auto plan = framegraph::compile(graph);
  if (!plan) {
    ADD_FAILURE() << framegraph::to_string(plan.error());
    return kept;
  }
  const framegraph::GraphDescription& declared = graph.description();
  for (const framegraph::PlannedPass& pass : plan->passes) {
    const std::string name(declared.pass_name(pass.pass));
    if (name == "upload")
      ++kept.uploads;
    else if (name != "read back")
      kept.passes.push_back(name);
  }
  for (std::uint32_t i = 0; i < declared.resources.size(); ++i) {
    const std::string name(declared.resource_name(i));
    if (declared.resources[i].origin == framegraph::Origin::history) {
      kept.histories.push_back(name);
    } else if (plan->placements[i].heap != framegraph::kNone && name != "uploaded") {
      kept.transients.push_back(name);
      kept.bytes += plan->placements[i].size;
    }
  }
  return kept;
}

}  // namespace alcove::passes

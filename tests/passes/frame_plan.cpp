#include "frame_plan.h"

#include <gtest/gtest.h>

#include "alcove/framegraph/compile.h"

namespace alcove::passes {

FramePlan plan_frame(const framegraph::Graph& graph) {
  FramePlan frame;
  const auto plan = framegraph::compile(graph);
  if (!plan) {
    ADD_FAILURE() << framegraph::to_string(plan.error());
    return frame;
  }
  const framegraph::GraphDescription& declared = graph.description();
  for (const framegraph::PlannedPass& pass : plan->passes) {
    const std::string name(declared.pass_name(pass.pass));
    if (name == "upload")
      ++frame.uploads;
    else if (name != "read back")
      frame.passes.push_back(name);
  }
  for (std::uint32_t i = 0; i < declared.resources.size(); ++i) {
    const std::string name(declared.resource_name(i));
    if (declared.resources[i].origin == framegraph::Origin::history) {
      frame.histories.push_back(name);
    } else if (plan->placements[i].heap != framegraph::kNone && name != "uploaded") {
      frame.transients.push_back(name);
      frame.bytes += plan->placements[i].size;
    }
  }
  return frame;
}

}  // namespace alcove::passes

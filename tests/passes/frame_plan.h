// The passes and resources that a frame's plan keeps after culling.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// Names of the passes and resources, without uploads and read-backs.
struct FramePlan {
  std::vector<std::string> passes;
  std::vector<std::string> transients;
  std::vector<std::string> histories;
  std::size_t uploads = 0;  // uploads that a pass reads
  std::uint64_t bytes = 0;  // memory of the transients
};

// Compiles the graph. Fails the test if its declaration is invalid.
FramePlan plan_frame(const framegraph::Graph& graph);

}  // namespace alcove::passes

// What of a frame's declaration its plan keeps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// By name; uploads and read-backs are left out.
struct Kept {
  std::vector<std::string> passes;
  std::vector<std::string> transients;
  std::vector<std::string> histories;
  std::size_t uploads = 0;  // that something reads
  std::uint64_t bytes = 0;  // of the transients
};

// Fails the test where the declaration is wrong.
Kept kept_of(const framegraph::Graph& graph);

}  // namespace alcove::passes

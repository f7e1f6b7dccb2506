// A deferred frame as engines have it: a g-buffer, occlusion at half resolution, lighting, a bloom
// chain, temporal antialiasing and tonemapping. 14 g-buffer to tonemap textures and 11 of bloom
// make 24 transients and the imported back buffer.
#pragma once

#include "alcove/framegraph/graph.h"

namespace alcove::framegraph {

void declare_deferred_frame(Graph& graph, std::uint32_t width, std::uint32_t height);

}  // namespace alcove::framegraph

// A deferred frame of a typical engine: a g-buffer of five textures, light tiles, occlusion and its
// blur at half resolution, lighting, temporal antialiasing, a bloom chain of 6 mips down and up
// again, and tonemapping. It has 24 transients and an imported back buffer. At 1080p, with sizes
// rounded up to the pages of 64 KiB that devices use, the transients sum to 112.4 MiB, and at most
// 80.0 MiB are live at once.
#pragma once

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/graph.h"

namespace alcove::framegraph {

void declare_deferred_frame(Graph& graph, std::uint32_t width, std::uint32_t height);

// Declares the frame at 1080p and compiles it with memory requirements that are rounded up to pages
// of 64 KiB, for which it sets `limits`.
tl::expected<Plan, Errors> compile_deferred_frame(Graph& graph, Limits& limits);

}  // namespace alcove::framegraph

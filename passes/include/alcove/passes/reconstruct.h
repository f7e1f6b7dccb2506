// Reconstructs every pixel from the traced pixels: spatial filter, upsampling and temporal
// accumulation in one pass (Jimenez et al. 2016, sections 4.4 and 4.5, with other weights).
#pragma once

#include <string_view>

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

struct ReconstructInputs : OcclusionInputs {
  RawOcclusionTextures raw_occlusion;  // From add_gtao, with the same inputs and Frame::index.
};

// Adds the reconstruction. Each view of a graph needs its own `history_name`. A history starts
// again from this frame when its size (Frame::largest_size) or half_resolution changes, when the
// raw occlusion has bent normals or a GGX lobe that the previous frame did not have, when the
// previous frame had no history, and after Graph::reset_history(history_name).
//
// Errors: an input that is missing or whose size differs from the depth's, raw occlusion whose size
// does not fit the number of tiles, a view or previous view that cannot be used, a size
// above Frame::largest_size, settings that validate() refuses, or no output that was requested.
[[nodiscard]] tl::expected<Occlusion, Error> add_reconstruct(
    const Frame& frame, const ReconstructInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

// Frees the histories of this name that the most recently declared frame does not use, after the
// device has finished with them: see Graph::drop_history.
void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name);

}  // namespace alcove::passes

// Shares the directions that neighbouring pixels searched, without crossing edges.
#pragma once

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"

namespace alcove::passes {

struct SpatialFilterSettings {
  // Neighbours on each side, 0 to 3. 2 covers the 4x4 pattern: the outermost count half, so that
  // the window is 4x4 and centred (the memo's own is off centre). 0 filters nothing: the pass then
  // only brings the signal to its final form.
  std::uint32_t reach = 2;
  // How far a neighbour may lie from the pixel's tangent plane before it counts for nothing, in
  // sizes of a pixel there, over 0.
  float tolerance_px = 2.0f;
  Precision precision = Precision::unorm8;
};

struct SpatialFilterInputs {
  OcclusionSignal signal;       // as add_gtao writes it
  framegraph::Texture depth;    // linear
  framegraph::Texture normals;  // as GtaoInputs::normals
  bool normals_in_view_space = false;
};

struct Occlusion {
  framegraph::Texture visibility;  // one channel, [0,1], 1 open
  framegraph::Texture
      bent_normal;  // xyz unit, in the space of the normals; null where the signal has none
};

[[nodiscard]] tl::expected<Occlusion, Error> add_spatial_filter(
    const Frame& frame, const SpatialFilterInputs& inputs, const SpatialFilterSettings& settings);

}  // namespace alcove::passes

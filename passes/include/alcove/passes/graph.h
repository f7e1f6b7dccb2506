// Adds the work of a view to a render graph.
//
//   once:   Executor::create and Pipelines::create, for the same number of frames in flight
//   frame:  wait for the fence of frame slot s;  graph.reset(); pipelines.begin_frame(s);
//           import textures, add_view;  executor.record(graph, commands, {s})
#pragma once

#include <array>
#include <cstdint>

#include "alcove/alcove_work.h"
#include "alcove/framegraph/graph.h"
#include "alcove/passes/pipelines.h"

namespace alcove::passes {

// The textures of a view, by AlcoveImageRole. Those of absent images are null.
using ViewTextures = std::array<framegraph::Texture, ALCOVE_IMAGE_COUNT>;

// Adds the passes that compute the outputs among `textures`, which become the written textures. The
// graph culls passes whose results are not read. `index` is the number of the frame. The graph
// keeps a history for each AlcoveViewInfo::id. The noise depends only on the pixel and the index,
// so that it is the same in all views.
//
// Errors: a camera, settings, a size or a format that cannot be used, or a missing image.
[[nodiscard]] tl::expected<void, Error> add_view(framegraph::Graph& graph, Pipelines& pipelines,
                                                 const AlcoveViewInfo& info, std::uint32_t index,
                                                 ViewTextures& textures);

// Creates the pipelines that frames of a view can need (alcoveListPipelines), so that no frame has
// to wait for one. Call it while loading or before settings change. Errors: those of add_view().
[[nodiscard]] tl::expected<void, Error> prepare_view(const framegraph::Graph& graph,
                                                     Pipelines& pipelines,
                                                     const AlcoveViewInfo& info,
                                                     const ViewTextures& textures);

// Frees the histories of a view that the most recently declared frame does not use, after the
// device has finished with them: see Graph::drop_history.
void drop_view(framegraph::Graph& graph, std::uint32_t id);

// Textures that lighting reads besides the outputs, from a depth texture as add_view() takes it.
struct SurfaceTextures {
  // R32_SFLOAT: the distance along the view direction in scene units. Sky, NaN and infinitely far
  // depths are 1e12.
  framegraph::Texture linear_depth;
  // RGBA16_SFLOAT: unit normals in view space that point towards the eye. On each image axis, the
  // one of the two neighbours is used whose depth continues the pixel's surface more smoothly.
  framegraph::Texture normals;
};
[[nodiscard]] tl::expected<SurfaceTextures, Error> add_surface(framegraph::Graph& graph,
                                                               Pipelines& pipelines,
                                                               const AlcoveCamera& camera,
                                                               framegraph::Texture depth);

}  // namespace alcove::passes

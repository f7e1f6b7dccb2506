// The work of the frames whose cost is modelled, as the passes describe it for any engine.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "alcove/alcove_work.h"
#include "gpu/occlusion.h"
#include "gpu_cost/pass_work.h"
#include "support/result.h"

namespace alcove::sample {

// The kinds of projection for which the shaders are compiled differently. Depth is reversed in
// perspective views.
enum class ProjectionKind : std::uint8_t { infinite_far, finite_far, orthographic };
inline constexpr std::array<std::string_view, 3> kProjectionNames{
    "infinite far plane", "finite far plane", "orthographic"};

// The inputs that an engine gives to the passes, and the size of its images.
struct CostInputs {
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  bool normals = true;           // true: a texture of normals (RGBA16F); false: normals from depth
  bool motion = false;           // motion vectors (RG16F)
  bool area = false;             // the images are read and written in part
  std::uint32_t guard_band = 0;  // pixels beyond each border that are read and not written
  bool mask = false;             // a mask of surfaces (R8)
  bool samples = false;          // four samples of depth per pixel
  ProjectionKind projection = ProjectionKind::finite_far;
  OcclusionSettings settings;
  AlcoveNormalEncoding normal_encoding = ALCOVE_NORMAL_ENCODING_SIGNED_XYZ;
};

// Returns the work of a frame of each FrameState, in their order, with the outputs that the
// settings enable. Error: the passes reject the settings.
[[nodiscard]] Result<std::vector<AlcoveWork>> describe_frames(const CostInputs& inputs);

// Returns the images that a dispatch of `work` reads and writes, in the order of its bindings.
[[nodiscard]] std::vector<PassImage> dispatch_images(const AlcoveWork& work,
                                                     const AlcoveWorkDispatch& dispatch);

}  // namespace alcove::sample

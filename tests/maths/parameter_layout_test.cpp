// Tests that parameter structs, which GLSL and C++ share, have the same layout in a uniform block
// as in C++.
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>

#include "depth_copy_parameters.h"
#include "gtao_parameters.h"
#include "gtso_parameters.h"
#include "inspect_parameters.h"
#include "linear_depth_parameters.h"
#include "maths/projection.h"
#include "multi_bounce_parameters.h"
#include "normals_parameters.h"
#include "parameter_layouts_spirv.h"
#include "reconstruct_parameters.h"
#include "spirv_layout.h"
#include "upsample_parameters.h"

namespace alcove::maths_test {
namespace {

using Offsets = std::map<std::string, std::uint32_t>;

#define ALCOVE_OFFSET(type, member) \
  { #member, std::uint32_t(offsetof(maths::type, member)) }

const std::map<std::string, Offsets> kExpected = {
    {"Projection",
     {ALCOVE_OFFSET(Projection, uv_to_slope), ALCOVE_OFFSET(Projection, uv_to_origin),
      ALCOVE_OFFSET(Projection, position_to_uv), ALCOVE_OFFSET(Projection, depth_to_uv),
      ALCOVE_OFFSET(Projection, depth_unproject), ALCOVE_OFFSET(Projection, eye),
      ALCOVE_OFFSET(Projection, size_px), ALCOVE_OFFSET(Projection, texel_uv),
      ALCOVE_OFFSET(Projection, sky), ALCOVE_OFFSET(Projection, near_far)}},
    {"GtaoParameters",
     {ALCOVE_OFFSET(GtaoParameters, area), ALCOVE_OFFSET(GtaoParameters, written),
      ALCOVE_OFFSET(GtaoParameters, view_from_normal), ALCOVE_OFFSET(GtaoParameters, slope),
      ALCOVE_OFFSET(GtaoParameters, inverse_depth_from_ndc),
      ALCOVE_OFFSET(GtaoParameters, interleave_offset), ALCOVE_OFFSET(GtaoParameters, radius),
      ALCOVE_OFFSET(GtaoParameters, frame), ALCOVE_OFFSET(GtaoParameters, thickness),
      ALCOVE_OFFSET(GtaoParameters, hidden_exponent), ALCOVE_OFFSET(GtaoParameters, roughness),
      ALCOVE_OFFSET(GtaoParameters, depth_step),
      ALCOVE_OFFSET(GtaoParameters, depth_step_per_inverse_depth)}},
    {"GtsoParameters",
     {ALCOVE_OFFSET(GtsoParameters, origins), ALCOVE_OFFSET(GtsoParameters, written),
      ALCOVE_OFFSET(GtsoParameters, size_px), ALCOVE_OFFSET(GtsoParameters, projection),
      ALCOVE_OFFSET(GtsoParameters, view_from_normal), ALCOVE_OFFSET(GtsoParameters, roughness)}},
    {"DepthCopyParameters",
     {ALCOVE_OFFSET(DepthCopyParameters, first), ALCOVE_OFFSET(DepthCopyParameters, size),
      ALCOVE_OFFSET(DepthCopyParameters, not_receiving),
      ALCOVE_OFFSET(DepthCopyParameters, not_occluding), ALCOVE_OFFSET(DepthCopyParameters, sky)}},
    {"LinearDepthParameters",
     {ALCOVE_OFFSET(LinearDepthParameters, projection),
      ALCOVE_OFFSET(LinearDepthParameters, origin)}},
    {"InspectParameters",
     {ALCOVE_OFFSET(InspectParameters, origin), ALCOVE_OFFSET(InspectParameters, size_px),
      ALCOVE_OFFSET(InspectParameters, has_normals), ALCOVE_OFFSET(InspectParameters, has_motion)}},
    {"MultiBounceParameters",
     {ALCOVE_OFFSET(MultiBounceParameters, positions),
      ALCOVE_OFFSET(MultiBounceParameters, size_px)}},
    {"NormalsParameters", {ALCOVE_OFFSET(NormalsParameters, slope)}},
    {"ReconstructParameters",
     {ALCOVE_OFFSET(ReconstructParameters, area),
      ALCOVE_OFFSET(ReconstructParameters, written),
      ALCOVE_OFFSET(ReconstructParameters, to_outputs),
      ALCOVE_OFFSET(ReconstructParameters, previous_from_pixel),
      ALCOVE_OFFSET(ReconstructParameters, normal_from_view),
      ALCOVE_OFFSET(ReconstructParameters, plane_from_normal),
      ALCOVE_OFFSET(ReconstructParameters, previous_from_view),
      ALCOVE_OFFSET(ReconstructParameters, slope),
      ALCOVE_OFFSET(ReconstructParameters, previous_extent),
      ALCOVE_OFFSET(ReconstructParameters, history_depth_scale),
      ALCOVE_OFFSET(ReconstructParameters, traced_range),
      ALCOVE_OFFSET(ReconstructParameters, motion),
      ALCOVE_OFFSET(ReconstructParameters, history_texel),
      ALCOVE_OFFSET(ReconstructParameters, pixel_uv),
      ALCOVE_OFFSET(ReconstructParameters, inverse_depth_from_ndc),
      ALCOVE_OFFSET(ReconstructParameters, pixels_per_slope),
      ALCOVE_OFFSET(ReconstructParameters, interleave_pixel),
      ALCOVE_OFFSET(ReconstructParameters, smallest_window),
      ALCOVE_OFFSET(ReconstructParameters, first_sharpness),
      ALCOVE_OFFSET(ReconstructParameters, wide_sharpness),
      ALCOVE_OFFSET(ReconstructParameters, half_inverse_depth_per_ndc),
      ALCOVE_OFFSET(ReconstructParameters, depth_step),
      ALCOVE_OFFSET(ReconstructParameters, largest_bend),
      ALCOVE_OFFSET(ReconstructParameters, history_slope),
      ALCOVE_OFFSET(ReconstructParameters, history_unit),
      ALCOVE_OFFSET(ReconstructParameters, tolerance),
      ALCOVE_OFFSET(ReconstructParameters, history_sharpness),
      ALCOVE_OFFSET(ReconstructParameters, history_slack),
      ALCOVE_OFFSET(ReconstructParameters, largest_weight),
      ALCOVE_OFFSET(ReconstructParameters, roughness),
      ALCOVE_OFFSET(ReconstructParameters, power),
      ALCOVE_OFFSET(ReconstructParameters, intensity),
      ALCOVE_OFFSET(ReconstructParameters, dither_offset)}},
    {"UpsampleParameters",
     {ALCOVE_OFFSET(UpsampleParameters, area), ALCOVE_OFFSET(UpsampleParameters, written),
      ALCOVE_OFFSET(UpsampleParameters, to_outputs),
      ALCOVE_OFFSET(UpsampleParameters, normal_from_view), ALCOVE_OFFSET(UpsampleParameters, slope),
      ALCOVE_OFFSET(UpsampleParameters, inverse_depth_from_ndc),
      ALCOVE_OFFSET(UpsampleParameters, pixel_uv), ALCOVE_OFFSET(UpsampleParameters, texel_uv),
      ALCOVE_OFFSET(UpsampleParameters, half_pixel_per_tilt),
      ALCOVE_OFFSET(UpsampleParameters, tolerance), ALCOVE_OFFSET(UpsampleParameters, power),
      ALCOVE_OFFSET(UpsampleParameters, intensity)}},
};

TEST(ShaderParameters, StructsHaveTheSameLayoutInUniformBlocksAndInCpp) {
  std::map<std::string, int> seen;
  for (const StructLayout& layout : struct_layouts(kParameterLayouts)) {
    const auto match = kExpected.find(layout.name);
    if (match == kExpected.end()) continue;
    EXPECT_EQ(layout.offsets, match->second) << layout.name;
    ++seen[layout.name];
  }
  for (const auto& [name, offsets] : kExpected) EXPECT_EQ(seen[name], 1) << name;
}

TEST(ShaderParameters, ProjectionSizeIsAMultipleOf16Bytes) {
  EXPECT_EQ(sizeof(maths::Projection) % 16, 0u);
}

}  // namespace
}  // namespace alcove::maths_test

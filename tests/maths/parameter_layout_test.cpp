// Tests that parameter structs, which GLSL and C++ share, have the same layout in a uniform block
// as in C++. GLSL aligns a member at least as much as C++, so that one that is moved moves all
// after it. The last member of a struct therefore tells whether all are in their places.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "depth_copy_parameters.h"
#include "gtao_parameters.h"
#include "gtso_parameters.h"
#include "inspect_parameters.h"
#include "multi_bounce_parameters.h"
#include "parameter_layouts_spirv.h"
#include "reconstruct_parameters.h"
#include "surface_parameters.h"
#include "upsample_parameters.h"

namespace alcove::maths_test {
namespace {

#define ALCOVE_LAST(type, member) \
  { #type, std::uint32_t(offsetof(maths::type, member)) }

const std::map<std::string, std::uint32_t> kLastOffsets = {
    ALCOVE_LAST(GtaoParameters, depth_step_per_inverse_depth),
    ALCOVE_LAST(GtsoParameters, roughness),
    ALCOVE_LAST(DepthCopyParameters, sky),
    ALCOVE_LAST(InspectParameters, has_motion),
    ALCOVE_LAST(MultiBounceParameters, size_px),
    ALCOVE_LAST(ReconstructParameters, dither_offset),
    ALCOVE_LAST(SurfaceParameters, inverse_depth_from_ndc),
    ALCOVE_LAST(UpsampleParameters, intensity),
};

// Returns the largest offset of a member of each struct of the module that has offsets.
std::map<std::string, std::uint32_t> last_offsets(std::span<const std::uint32_t> module) {
  constexpr std::uint32_t kOpName = 5, kOpMemberDecorate = 72, kOffset = 35;
  std::map<std::uint32_t, std::string> names;
  std::map<std::string, std::uint32_t> offsets;
  for (std::size_t at = 5; at < module.size(); at += module[at] >> 16) {
    const auto words = module.subspan(at, module[at] >> 16);
    const std::uint32_t code = module[at] & 0xffffu;
    if (code == kOpName) names[words[1]] = reinterpret_cast<const char*>(&words[2]);
    if (code == kOpMemberDecorate && words[3] == kOffset)
      offsets[names[words[1]]] = std::max(offsets[names[words[1]]], words[4]);
  }
  return offsets;
}

TEST(ShaderParameters, StructsHaveTheSameLayoutInUniformBlocksAndInCpp) {
  auto offsets = last_offsets(kParameterLayouts);
  for (const auto& [name, offset] : kLastOffsets) {
    ASSERT_TRUE(offsets.contains(name)) << name;
    EXPECT_EQ(offsets[name], offset) << name;
  }
}

}  // namespace
}  // namespace alcove::maths_test

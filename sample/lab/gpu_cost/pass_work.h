// Facts about the occlusion passes that a compiler cannot know: how often each loop of a shader
// runs, how rare a branch is, and (accesses.h) which texels a pass reads and writes. The model
// multiplies the instructions of each loop by these counts.
//
// A commit that changes a loop of a shader must also change pass_work.cpp. A loop without a count
// is an error that names the loop, so that no count is guessed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "alcove/passes/setting_table.h"
#include "gpu/occlusion.h"
#include "support/result.h"

namespace alcove::sample {

// The frames before a frame, which decide how much of the history its reconstruction reads.
enum class FrameState : std::uint8_t {
  first,      // no history yet
  moving,     // the camera moves
  unchanged,  // camera and scene are the same as in the previous frame
  converged,  // camera and scene have been the same for 16 frames
};
inline constexpr std::size_t kFrameStates = 4;
[[nodiscard]] std::string_view name_of(FrameState state);

// The passes of a frame that is modelled, and their labels in the list of work
// (AlcoveWorkDispatch::label) in the order of the enumerators.
enum class Pass : std::uint8_t {
  resolve_depth,
  mask_depth,
  halve_depth,
  gtao,
  reconstruct,
  upsample,
  specular_occlusion,
};
inline constexpr std::array<std::string_view, 7> kPassLabels{
    "resolve depth", "mask depth", "halve depth",       "gtao",
    "reconstruct",   "upsample",   "specular occlusion"};
// Returns the pass of a label. Error: the model has no facts about the pass.
[[nodiscard]] Result<Pass> pass_of(std::string_view label);

// A loop of the compiled shader. Loops that the compiler unrolled do not appear. Loops are in the
// order of the code, an outer loop before its inner ones.
struct CompiledLoop {
  std::uint32_t depth = 1;         // 1 for an outermost loop
  std::uint32_t instructions = 0;  // in its body, including inner loops
  std::uint32_t loads = 0;         // image loads, samples and gathers among them
};

enum class Direction : std::uint8_t { read, write };

// The names in the list of work (AlcoveWorkResource::name) of the images whose accesses depend on
// what they hold.
namespace names {
inline constexpr std::string_view kDepth = "depth";
inline constexpr std::string_view kReceivers = "receivers";  // depth, if there is a mask
inline constexpr std::string_view kOccluders = "depth of occluders";
inline constexpr std::string_view kHalvedDepth = "half depth";
inline constexpr std::string_view kBackDepth = "back-face depth";
inline constexpr std::string_view kSecondDepth = "second depth";
inline constexpr std::string_view kNormals = "normals";
inline constexpr std::string_view kRawOcclusion = "raw occlusion";
inline constexpr std::string_view kResidual = "bent-normal residual";
// Comes before the name of a history, if the image is its slot of the previous frame.
inline constexpr std::string_view kPrevious = "previous ";
inline constexpr std::string_view kDepthHistory = "depth history";
inline constexpr std::string_view kLobeHistory = "lobe history";
inline constexpr std::string_view kHalfTexelDepth = "half-resolution depth";
inline constexpr std::string_view kHalfTexelLobe = "half-resolution lobe";
inline constexpr std::array kAll{kDepth,        kReceivers,    kOccluders,   kHalvedDepth,
                                 kBackDepth,    kSecondDepth,  kNormals,     kRawOcclusion,
                                 kResidual,     kDepthHistory, kLobeHistory, kHalfTexelDepth,
                                 kHalfTexelLobe};
}  // namespace names

// An image that a pass reads or writes, in the order of its bindings.
struct PassImage {
  std::string name;
  Direction direction = Direction::read;
  std::uint32_t texel_bytes = 4;
  std::uint32_t width = 1;  // texels
  std::uint32_t height = 1;

  bool operator==(const PassImage&) const = default;
};

// The numbers of groups of a dispatch.
struct Groups {
  std::uint32_t x = 1;
  std::uint32_t y = 1;
  std::uint32_t z = 1;
};

// A dispatch of a frame, with everything that decides how often its loops run and which texels it
// reads and writes.
struct PassWork {
  Pass pass = Pass::gtao;
  const OcclusionSettings& settings;
  FrameState state = FrameState::first;
  std::span<const PassImage> images;
  Groups groups;
  // The size of the full image in pixels. The radius of the search is 96 pixels of 1080.
  std::uint32_t height = 1080;
};

// Returns how often the body of each loop of a shader runs each time that the loop is entered. In a
// wave, that is the number of iterations of the lane that needs the most. It is an error if no
// count is known for a loop.
[[nodiscard]] Result<std::vector<double>> loop_iterations(const PassWork& work,
                                                          std::span<const CompiledLoop> loops);

// Whether reconstruct.comp computes the tangent planes of most pixels from depth alone, so that few
// waves read normals.
[[nodiscard]] bool has_depth_planes(const PassWork& work);

// One side of a divergent branch of the compiled shader.
struct CompiledBranch {
  double instructions = 0;
  double loads = 0;         // image loads, samples and gathers among them
  double stores = 0;        // image stores among them
  double shared = 0;        // shared-memory operations among them
  std::uint32_t loops = 0;  // loops inside
};

// The share of waves of reconstruct.comp with a pixel whose tangent plane does not come from depth:
// 16 to 27 % in the atrium, the arcade and the helmet.
inline constexpr double kBentDepth = 0.22;

// Returns the share of waves, [0,1], in which at least one invocation executes `branch`. It is 1
// unless the branch is known to be rare.
[[nodiscard]] double branch_share(const PassWork& work, const CompiledBranch& branch);

}  // namespace alcove::sample

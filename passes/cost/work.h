// Facts about the occlusion passes that a compiler cannot know: how often each loop of a shader
// runs, and how much of an image a pass really reads or writes. The GPU cost model
// (sample/gpu_cost) multiplies the instructions of each loop by these counts.
//
// A commit that changes a loop of a shader, or the texels that a pass uses, also changes gtao.cpp
// or reconstruct.cpp here. A loop without a count is an error that names it, so that no count is
// guessed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/passes/occlusion.h"

namespace alcove::passes::cost {

// The frames before a frame, which decide how much of the history its reconstruction reads.
enum class FrameState : std::uint8_t {
  first,      // no history yet
  moving,     // the camera moves
  unchanged,  // camera and scene are the same as in the previous frame
  converged,  // camera and scene have been the same for 16 frames
};
inline constexpr std::size_t kFrameStates = 4;
[[nodiscard]] std::string_view name_of(FrameState state);

// A loop of the compiled shader. Loops that the compiler unrolled do not appear.
struct CompiledLoop {
  std::uint32_t index = 0;         // in the order of the code, an outer loop before its inner ones
  std::uint32_t depth = 1;         // 1 for an outermost loop
  std::uint32_t instructions = 0;  // in its body, including inner loops
  std::uint32_t loads = 0;         // image loads, samples and gathers among them
  std::uint32_t stores = 0;        // image stores among them
  std::uint32_t shared = 0;        // shared-memory operations among them
};

// A shader that a frame runs, with everything that decides how often its loops run.
struct PassWork {
  std::string_view pass;  // name of the pass in the graph
  const OcclusionSettings& settings;
  FrameState state = FrameState::first;
  std::span<const CompiledLoop> loops;
};

// Returns how often the body of `loop`, one of `work.loops`, runs each time that the loop is
// entered. In a wave, the lane with the most iterations counts. Error: the pass's function does not
// know the loop.
[[nodiscard]] tl::expected<double, std::string> iterations(const PassWork& work,
                                                           const CompiledLoop& loop);

enum class Direction : std::uint8_t { read, write };

// Returns the fraction, 0 to 1, of the bytes of an image that a pass moves between memory and
// caches. It is 1 unless the pass's function knows a smaller value.
[[nodiscard]] double traffic_share(const PassWork& work, std::string_view image,
                                   Direction direction);

// The texels that the 64 invocations of a group of 8x8 load with one instruction.
struct LoadPattern {
  std::uint32_t texel_bytes = 4;
  std::uint32_t pitch = 1;      // texels from one invocation's texel to the next, in x and y
  std::uint32_t footprint = 1;  // texels of an invocation in x and y: 2 for a gather
  // Whether the group's first texel may be any, as where a moving camera reads its history.
  // Otherwise it is a multiple of 8 * pitch, plus `first`.
  bool anywhere = false;
  std::int32_t first = 0;
  std::uint32_t count = 1;  // instructions of this pattern in a wave
};

// Cache lines of 64 bytes that a load of this pattern touches, where an image is stored row by row
// and its rows begin with a line; the mean over all positions if the group may be anywhere.
[[nodiscard]] double cache_lines(const LoadPattern& pattern);

// Cache lines per load of a pass, the mean over its loads. 0 for a pass whose patterns are not
// declared, which is all but reconstruct.
[[nodiscard]] double cache_lines_per_load(const PassWork& work);

}  // namespace alcove::passes::cost

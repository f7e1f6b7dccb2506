// Facts about the occlusion passes that a compiler cannot know: how often each loop of a shader
// runs, and how much of an image a pass actually reads or writes. The GPU cost model
// (sample/lab/gpu_cost) multiplies the instructions of each loop by these counts.
//
// A commit that changes a loop of a shader, or the texels that a pass uses, must also change
// gtao.cpp or reconstruct.cpp in this folder. A loop without a count is an error that names the
// loop, so that no count is guessed.
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
// entered. In a wave, that is the number of iterations of the lane that needs the most. It is an
// error if no count is known for the loop.
[[nodiscard]] tl::expected<double, std::string> iterations(const PassWork& work,
                                                           const CompiledLoop& loop);

enum class Direction : std::uint8_t { read, write };

// Returns the fraction, 0 to 1, of the bytes of an image that a pass moves between memory and
// caches. It is 1 unless a smaller fraction is known for the pass.
[[nodiscard]] double traffic_share(const PassWork& work, std::string_view image,
                                   Direction direction);

// The texels that the 64 invocations of a group of 8x8 load with one instruction.
struct LoadPattern {
  std::uint32_t texel_bytes = 4;
  std::uint32_t pitch = 1;      // texels from one invocation's texel to the next, in x and y
  std::uint32_t footprint = 1;  // texels of an invocation in x and y: 2 for a gather
  // Whether the position of the group's first texel is arbitrary, as it is if the history of a
  // moving camera is read. If false, its position is a multiple of 8 * pitch, plus `first`.
  bool anywhere = false;
  std::int32_t first = 0;
  std::uint32_t count = 1;  // instructions of this pattern in a wave
};

// Returns the number of 64-byte cache lines that a load with this pattern touches. The image is
// assumed to be stored row by row, with each row beginning at a cache line. If the group can be
// anywhere, it is the mean over all positions.
[[nodiscard]] double cache_lines(const LoadPattern& pattern);

// Returns the mean number of cache lines per load over all loads of a pass. It is 0 for passes
// whose patterns are not declared, which are all except reconstruct.
[[nodiscard]] double cache_lines_per_load(const PassWork& work);

}  // namespace alcove::passes::cost

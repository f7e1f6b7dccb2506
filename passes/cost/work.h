// What a compiler cannot know of the occlusion passes: how often each loop of a shader runs, and
// how much of an image a pass really reads or writes. The GPU cost model (sample/cost) multiplies
// the instructions of each loop by these counts.
//
// Whoever changes a loop of a shader, or what a pass touches of an image, changes gtao.cpp or
// reconstruct.cpp here in the same commit. A loop without a count is an error that names it, so
// nothing is ever counted with a guess.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/passes/occlusion.h"

namespace alcove::passes::cost {

// What lies before a frame, which decides how much of the history its reconstruction reads.
enum class FrameState : std::uint8_t {
  first,      // no history yet
  moving,     // the camera moves
  unchanged,  // camera and scene are those of the frame before
  converged,  // they have been for 16 frames
};
inline constexpr std::size_t kFrameStates = 4;
[[nodiscard]] std::string_view name_of(FrameState state);

// A loop as the compiler left it. Loops that it unrolled are gone.
struct CompiledLoop {
  std::uint32_t index = 0;         // in the order of the code, an outer loop before its inner ones
  std::uint32_t depth = 1;         // 1 for an outermost loop
  std::uint32_t instructions = 0;  // in its body, those of inner loops too
  std::uint32_t loads = 0;         // image loads, samples and gathers among them
  std::uint32_t stores = 0;        // image stores among them
  std::uint32_t shared = 0;        // shared-memory operations among them
};

// A shader that a frame runs, with all that decides its loops.
struct PassWork {
  std::string_view pass;  // its name in the graph
  const OcclusionSettings& settings;
  FrameState state = FrameState::first;
  std::span<const CompiledLoop> loops;
};

// How often `loop`, one of `work.loops`, runs each time that it is entered. In a wave the lane with
// the most iterations decides. Errors: the loop is none that the pass's function knows.
[[nodiscard]] tl::expected<double, std::string> iterations(const PassWork& work,
                                                           const CompiledLoop& loop);

enum class Direction : std::uint8_t { read, write };

// The share of the bytes of an image that a pass moves between memory and caches, 0 to 1: all of
// them unless the pass's function knows better.
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

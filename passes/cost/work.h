// Facts about the occlusion passes that a compiler cannot know: how often each loop of a shader
// runs, how rare a branch is, and (accesses.h) which texels a pass reads and writes. The GPU cost
// model (sample/lab/gpu_cost) multiplies the instructions of each loop by these counts.
//
// A commit that changes a loop of a shader must also change gtao.cpp or reconstruct.cpp in this
// folder. A loop without a count is an error that names the loop, so that no count is guessed.
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

// One side of a divergent branch of the compiled shader.
struct CompiledBranch {
  std::uint32_t instructions = 0;
  std::uint32_t loads = 0;   // image loads, samples and gathers among them
  std::uint32_t stores = 0;  // image stores among them
  std::uint32_t loops = 0;   // loops inside
};

// Returns the share of waves, [0,1], in which at least one invocation executes `branch`. It is 1
// unless the branch is known to be rare.
[[nodiscard]] double branch_share(const PassWork& work, const CompiledBranch& branch);

}  // namespace alcove::passes::cost

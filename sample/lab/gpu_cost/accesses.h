// The texels that a dispatch of the passes reads and writes, from which cache_traffic.h computes
// the traffic of caches and memory.
//
// A commit that changes the texels that a shader reads must also change accesses.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gpu_cost/pass_work.h"

namespace alcove::sample {

struct Texel {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::uint32_t level = 0;  // mip level
};

// An image instruction of a shader.
struct ImageAccess {
  PassImage image;
  std::uint32_t footprint = 1;  // texels of an invocation along x and y: 2 for a gather
  // The texel of an invocation, or with a footprint of 2 the first of its texels. It is clamped to
  // the image.
  std::function<Texel(Texel invocation)> texel;
  // Whether a wave reads each cache line between the texels of its first and of its last
  // invocation.
  bool dense = false;
  double share = 1.0;  // of the waves that execute it; the others read their first texel
};

// The image instructions that each wave of a dispatch executes, in this order. A workgroup has 8x8
// invocations and is one wave.
struct DispatchAccesses {
  std::uint32_t groups_x = 1;
  std::uint32_t groups_y = 1;
  std::vector<ImageAccess> accesses;
  // The groups of a row, if groups run by columns through strips that are groups_x groups high
  // (invocation_tile() of gtao.comp) and lie one below the other. 0: groups run row by row.
  std::uint32_t strip_columns = 0;
};

// The image instructions of a pass whose pattern is not declared read or write one texel of each
// image, that of the invocation.
[[nodiscard]] DispatchAccesses accesses_of(const PassWork& work);

// The texel that is `distance` pixels from `from` in the direction `phi`, in radians, to within a
// quarter of a pixel per hundred.
[[nodiscard]] Texel along_slice(Texel from, float phi, float distance);

// The access to the texel of an invocation, times `scale` and moved by `offset`.
[[nodiscard]] ImageAccess at_invocation(const PassImage& image, std::int32_t scale = 1,
                                        Texel offset = {}, std::uint32_t footprint = 1);

}  // namespace alcove::sample

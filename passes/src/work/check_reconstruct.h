// Checks of what add_reconstruct() is given.
#pragma once

#include <cstdint>

#include "alcove/passes/work.h"

namespace alcove::passes {

// Checks settings and textures.
[[nodiscard]] tl::expected<void, Error> check_reconstruct(const WorkList& list,
                                                          const WorkFrame& frame,
                                                          const ReconstructInputs& inputs,
                                                          const OcclusionSettings& settings);

// Sizes in pixels. `now` and `previous` are within `largest`.
struct ReconstructSizes {
  VkExtent2D now;
  VkExtent2D previous;
  VkExtent2D largest;
};

// Returns `now`, the size of the depth, and the previous and the largest size that `frame` states,
// or an error if a size is larger than the largest.
[[nodiscard]] tl::expected<ReconstructSizes, Error> reconstruct_sizes(const WorkFrame& frame,
                                                                      VkExtent2D now);

}  // namespace alcove::passes

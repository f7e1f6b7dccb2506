// What add_reconstruct() asks of what it is given.
#pragma once

#include <cstdint>

#include "alcove/passes/reconstruct.h"

namespace alcove::passes {

// What is wrong with settings or textures.
[[nodiscard]] tl::expected<void, Error> check_reconstruct(const Frame& frame,
                                                          const ReconstructInputs& inputs,
                                                          const ReconstructSettings& settings);

// Pixels, each within the last.
struct ReconstructSizes {
  VkExtent2D now;
  VkExtent2D previous;
  VkExtent2D largest;
};

// Of `depth`, in this frame and as the frame has the others.
[[nodiscard]] tl::expected<ReconstructSizes, Error> reconstruct_sizes(const Frame& frame,
                                                                      framegraph::Texture depth);

}  // namespace alcove::passes

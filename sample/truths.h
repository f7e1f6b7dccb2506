#ifndef ALCOVE_SAMPLE_TRUTHS_H_
#define ALCOVE_SAMPLE_TRUTHS_H_

#include <string>
#include <tl/expected.hpp>

#include "errors.h"
#include "height_field_truth.h"
#include "rendering.h"
#include "truth.h"

namespace alcove::sample {

// Both truths of a rendering, and where they can be compared.
struct Truths {
  OcclusionTruth scene;           // ray traced
  HeightFieldTruth height_field;  // by brute force on the same depth buffer
  Mask surfaces;                  // pixels that are not sky
};

// Computes them, or takes them from the cache on disk. Points are where primary rays through the
// pixel centres meet the scene, normals those that the occlusion was given. Progress on stderr.
[[nodiscard]] tl::expected<Truths, std::string> truths_of(const Rendering& rendering,
                                                          const Options& options);

}  // namespace alcove::sample

#endif  // ALCOVE_SAMPLE_TRUTHS_H_

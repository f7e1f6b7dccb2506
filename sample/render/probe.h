#pragma once

#include <memory>
#include <string>

#include "alcove/passes/environment.h"
#include "gpu/gpu.h"
#include "gpu/gpu_image.h"
#include "scene/environment.h"
#include "support/result.h"

namespace alcove::sample {

// A probe of an environment image that is computed once and kept for all frames.
class Probe {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Probe>> create(Gpu& gpu,
                                                             const EnvironmentImage& image);

  // Imports the probe's textures into a graph.
  [[nodiscard]] passes::Environment import(framegraph::Graph& graph) const;

 private:
  Probe() = default;
  std::unique_ptr<GpuImage> harmonics_;
  std::unique_ptr<GpuImage> map_;
};

}  // namespace alcove::sample

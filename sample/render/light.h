#pragma once

#include <memory>

#include "gpu/gpu_image.h"
#include "render/full_screen_pass.h"
#include "render/surfaces.h"
#include "scene/environment.h"

namespace alcove::sample {

// The occlusion that light is multiplied by. Textures may be null.
struct LightOcclusion {
  framegraph::Texture visibility;
  framegraph::Texture bent_normal;
  framegraph::Texture specular;
  // Whether occluders reflect light: visibility is raised by the polynomial of multi-bounce, and
  // the occluded part of specular light shows this reflected light instead of black.
  bool multi_bounce = false;
};

// Radiance towards the eye. Diffuse and specular light are black in the sky.
struct Lit {
  framegraph::Texture all;  // the sum; the environment in the sky
  framegraph::Texture diffuse;
  framegraph::Texture specular;
};

// Lights surfaces with an environment.
class Light {
 public:
  // The Gpu must outlive the object.
  [[nodiscard]] static Result<std::unique_ptr<Light>> create(Gpu& gpu,
                                                             const EnvironmentImage& environment);

  // Imports the environment into a graph, once for all calls of add().
  [[nodiscard]] framegraph::Texture import(framegraph::Graph& graph) const {
    return graph.import_texture("environment", environment_->import_to_read(kSampledState));
  }
  // Adds the pass that lights the g-buffer of `surfaces`. `normals` are those that the occlusion
  // passes used.
  [[nodiscard]] Lit add(framegraph::Graph& graph, framegraph::Texture environment,
                        const GbufferView& view, const Surfaces& surfaces,
                        framegraph::Texture normals, const LightOcclusion& occlusion) const;

 private:
  Light() = default;
  std::unique_ptr<GpuImage> environment_;
  std::unique_ptr<FullScreenPass> pass_;
};

}  // namespace alcove::sample

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "alcove/passes/occlusion.h"
#include "evaluate/motion_errors.h"
#include "evaluate/motion_paths.h"
#include "gpu/gpu.h"
#include "render/frame_renderer.h"
#include "render/normal_source.h"
#include "scene/scene.h"

namespace alcove::sample {

// The inputs of a run other than its path.
struct MotionSetup {
  passes::OcclusionSettings occlusion;  // with a history
  NormalSource normals = NormalSource::shading;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t spp = 256;                        // rays per pixel of the truth, at least 2
  std::filesystem::path cache;                    // folder of cached truths; empty: no cache
  std::function<Progress(std::string)> progress;  // makes the progress of a named task; may be null
};

// Renders the frames of one path and traces their truths.
class MotionRenderer {
 public:
  [[nodiscard]] static tl::expected<MotionRenderer, std::string> create(Gpu& gpu,
                                                                        const Scene& scene,
                                                                        const MotionPath& path,
                                                                        const MotionSetup& setup);

  // How raw occlusion is filtered: not at all, over neighbouring pixels, or also over frames.
  enum class Filtering : std::uint8_t { none, spatial, spatial_and_temporal };

  // The parameters of one rendered frame.
  struct Step {
    std::uint32_t frame = 0;   // frame of the path whose camera and object positions are used
    std::uint32_t before = 0;  // frame of the path that was rendered last; motion is relative to it
    std::uint32_t index = 0;   // frame index that selects the sampling pattern
    bool restart = false;      // whether the history is discarded
    Filtering filtering = Filtering::spatial_and_temporal;
    bool moving = true;  // whether the pass is given motion vectors
  };
  [[nodiscard]] tl::expected<RenderedFrame, std::string> draw_and_read(const Step& step);
  [[nodiscard]] tl::expected<void, std::string> draw(const Step& step);

  // The truth at the surfaces that a frame shows, in two independent halves.
  struct Truth {
    SplitTruth<float> visibility;
    SplitTruth<glm::vec3> bent_normal_ws;
  };
  [[nodiscard]] tl::expected<Truth, std::string> truth(std::uint32_t frame,
                                                       const RenderedFrame& seen);

  const MotionPath& path() const { return path_; }
  Progress progress(const std::string& name) const;

 private:
  MotionRenderer(const MotionPath& path, const MotionSetup& setup) : path_(path), setup_(setup) {}
  FrameRequest request(const Step& step) const;

  MotionPath path_;
  MotionSetup setup_;
  std::unique_ptr<Scene> scene_;  // at a fixed address, which renderer_ keeps
  std::unique_ptr<FrameRenderer> renderer_;
};

}  // namespace alcove::sample

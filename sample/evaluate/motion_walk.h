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
#include "render/frame_renderer.h"
#include "gpu/gpu.h"
#include "render/normal_source.h"
#include "scene/scene.h"

namespace alcove::sample {

// What a run needs besides its path.
struct MotionSetup {
  passes::OcclusionSettings occlusion;  // with a history
  NormalSource normals = NormalSource::kShading;
  std::uint32_t width = 960;
  std::uint32_t height = 540;
  std::uint32_t spp = 256;                        // rays per pixel of the truth, at least 2
  std::filesystem::path cache;                    // of truths; empty: none is kept
  std::function<Progress(std::string)> progress;  // by the name of what is under way; may be null
};

// One path as it is drawn, frame by frame, and what its frames should have shown.
class MotionWalk {
 public:
  [[nodiscard]] static tl::expected<MotionWalk, std::string> create(Gpu& gpu, const Scene& scene,
                                                                    const MotionPath& path,
                                                                    const MotionSetup& setup);

  // What a pixel's visibility is gathered from, besides its own searches.
  enum class Gathered : std::uint8_t { nothing, neighbours, neighbours_and_history };

  // How a frame is drawn.
  struct Step {
    std::uint32_t frame = 0;   // of the path
    std::uint32_t before = 0;  // where everything was one frame ago
    std::uint32_t index = 0;   // of the noise
    bool restart = false;
    Gathered gathered = Gathered::neighbours_and_history;
    bool moving = true;  // motion vectors are given
  };
  [[nodiscard]] tl::expected<SeenFrame, std::string> draw_and_read(const Step& step);
  [[nodiscard]] tl::expected<void, std::string> draw(const Step& step);

  // The truth of a frame, of the surfaces that it saw.
  struct Truth {
    Halves<float> visibility;
    Halves<glm::vec3> bent_normal_ws;
  };
  [[nodiscard]] tl::expected<Truth, std::string> truth(std::uint32_t frame, const SeenFrame& seen);

  const MotionPath& path() const { return path_; }
  Progress progress(const std::string& name) const;

 private:
  MotionWalk(const MotionPath& path, const MotionSetup& setup) : path_(path), setup_(setup) {}
  FrameRequest request(const Step& step) const;

  MotionPath path_;
  MotionSetup setup_;
  std::unique_ptr<Scene> scene_;  // where the renderer looks for it
  std::unique_ptr<FrameRenderer> renderer_;
};

}  // namespace alcove::sample

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "alcove/alcove.h"
#include "gpu/gpu.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// The frames that an engine draws: how the camera moves, and what else changes.
struct EngineCourse {
  VkExtent2D size{240, 135};
  float radius = 0.5f;
  std::uint32_t frames = 16;
  float orbit = 0.0f;      // radians per frame about the camera's target
  bool jitter = false;     // of the image, by up to half a pixel
  bool geometric = false;  // the triangles' own normals instead of shading normals
  bool resize = false;     // the images before the frame `change_at` are smaller
  bool cut = false;        // the camera before it is another
  std::uint32_t change_at = 4;
  bool quick = false;         // few samples, for callers that do not look at the visibility
  bool other_inputs = false;  // creates OtherInputs, which takes time
};

// Images that engines give by mistake instead of the right ones, and cameras without jitter.
struct OtherInputs {
  AlcoveCamera camera_without_jitter{};
  AlcoveImage half_depth{};  // half the width and height
  AlcoveImage linear_depth{};
  AlcoveImage coarse_depth{};  // rounded to 16 bits
  AlcoveImage octahedral_normals{};
  AlcoveImage view_normals{};  // in view space
  AlcoveImage albedo{};
};

// A frame that an engine passes to the C interface.
struct EngineFrame {
  AlcoveFrame frame{};  // `views` points to `view`
  AlcoveView view{};
  AlcoveSettings settings{};
  OtherInputs other;
  OtherInputs other_before;  // of the last frame
  // The views of this frame and of earlier ones without a mistake.
  AlcoveView right{};
  AlcoveView right_before{};
  AlcoveView right_before_that{};
  AlcoveView right_first{};
};

// Changes a frame before it is recorded.
using ChangeFrame = std::function<void(EngineFrame& frame)>;

struct EngineResult {
  Image<float> visibility;  // of the last frame
  // The lines of alcoveDiagnose, which looks at pixels too, or the message of a refused frame.
  std::string said;
};

// Draws the g-buffers of a course once, and records their occlusion through the C interface as
// often as a caller wants, as an engine does.
class EngineRun {
 public:
  // `gpu` and `scene` must outlive the object.
  [[nodiscard]] static Result<std::unique_ptr<EngineRun>> create(Gpu& gpu, const Scene& scene,
                                                                 const Camera& camera,
                                                                 const EngineCourse& course);
  ~EngineRun();
  EngineRun(const EngineRun&) = delete;
  EngineRun& operator=(const EngineRun&) = delete;

  // Records the frames from 0 to `frames` as a new view. `change`, if it is given, changes them
  // from the frame `begin` on. If `submit_late` is true, each of these is submitted after the next
  // one was recorded.
  [[nodiscard]] Result<EngineResult> draw(const ChangeFrame& change = {}, std::uint32_t begin = 0,
                                          bool submit_late = false);

 private:
  struct State;
  explicit EngineRun(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::sample

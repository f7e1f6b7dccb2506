#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/alcove.h"
#include "gpu/gpu.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// A frame that an engine passes to the C interface, and the wrong values that engines pass by
// mistake instead of the right ones.
struct EngineFrame {
  AlcoveFrame frame{};  // `views` points to `view`
  AlcoveView view{};
  AlcoveSettings settings{};
  AlcoveCamera camera_without_jitter{};
  AlcoveCamera previous_without_jitter{};
  AlcoveCamera first_camera{};  // of the first frame
  AlcoveImage half_depth{};     // the same view in an image of half the width and height
};

// Changes a frame before it is recorded.
using ChangeFrame = std::function<void(EngineFrame& frame)>;

// The motion of the camera over the frames, and how the frames are recorded.
struct EngineCourse {
  std::uint32_t frames = 16;
  float orbit = 0.0f;        // radians per frame about the camera's target
  bool jitter = false;       // of the image, by up to half a pixel
  bool geometric = false;    // the triangles' own normals instead of shading normals
  bool submit_late = false;  // each frame is submitted after the next one was recorded
  ChangeFrame change;        // null: the frames are right
};

struct EngineResult {
  Image<float> visibility;  // of the last frame
  std::string said;         // text of alcoveDiagnose, which looks at pixels too: a line per mistake
};

// Draws g-buffers of a scene and records their occlusion through the C interface, as an engine
// does.
class EngineRun {
 public:
  // `gpu` and `scene` must outlive the object. The size is in pixels.
  [[nodiscard]] static tl::expected<std::unique_ptr<EngineRun>, std::string> create(
      Gpu& gpu, const Scene& scene, VkExtent2D size);
  ~EngineRun();
  EngineRun(const EngineRun&) = delete;
  EngineRun& operator=(const EngineRun&) = delete;

  // Draws all frames with a new AlcoveContext. `radius` is in scene units.
  [[nodiscard]] tl::expected<EngineResult, std::string> draw(const Camera& camera, float radius,
                                                             const EngineCourse& course);

 private:
  struct State;
  explicit EngineRun(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::sample

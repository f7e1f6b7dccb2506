#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "alcove/alcove.h"
#include "engine.h"
#include "gpu/gpu.h"
#include "render/gbuffer.h"
#include "scene/camera.h"
#include "scene/scene.h"
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
  bool straight = false;   // the camera also moves, without a rotation
  float tremble = 0.0f;    // it also goes to and fro by this distance, from frame to frame
  bool zoom = false;       // the angle of view changes
  bool sway = false;       // each Mesh::moves sways
  bool stereo = false;     // two eyes alternate, each with a view of its own
  bool relative = false;   // the eye of each frame is the origin of its cameras
  std::uint32_t change_at = 4;
  bool other_inputs = false;  // creates OtherInputs, which takes time
};

// Images that engines give by mistake instead of the correct ones, all of the same size.
enum class Other : std::uint8_t {
  linear_depth,
  linear_to_far_depth,  // from 0 to 1
  log_depth,            // the logarithm of the distance
  coarse_depth,         // rounded to 16 bits
  float16_depth,
  gamma_depth,      // with an exponent of 2.2
  filtered_depth,   // half the size, enlarged with a linear filter
  maximum_depth,    // the largest of 4x4 pixels, as in a hi-Z level
  chequered_depth,  // every second pixel is at the far plane
  letterbox_depth,  // without a quarter of the rows, at the top and at the bottom
  noise,            // a resource that is no depth
  octahedral_normals,
  view_normals,        // in view space
  transposed_normals,  // the same, by the transposed matrix
  albedo,
  count
};

// The mistaken images, and a camera without jitter.
struct OtherInputs {
  AlcoveCamera camera_without_jitter{};
  AlcoveImage half_depth{};  // half the width and height
  std::array<AlcoveImage, static_cast<std::size_t>(Other::count)> images{};
  const AlcoveImage& operator[](Other which) const {
    return images.at(static_cast<std::size_t>(which));
  }
  AlcoveImage& operator[](Other which) { return images.at(static_cast<std::size_t>(which)); }
};

// A frame that an engine passes to the C interface.
struct EngineFrame {
  std::uint32_t records = 1;  // in the command buffer of the frame
  std::uint32_t back = 1;     // frames since the last one of the view
  AlcoveFrame frame{};        // `views` points to `view`
  AlcoveView view{};
  AlcoveSettings settings{};
  OtherInputs other;
  OtherInputs other_before;  // of the last frame
  // The views of this frame and of earlier ones without a mistake.
  AlcoveView correct{};
  AlcoveView correct_before{};
  AlcoveView correct_before_that{};
  AlcoveView correct_first{};
};

// Changes a frame before it is recorded.
using ChangeFrame = std::function<void(EngineFrame& frame)>;

// A scene on a device and a context of the library, which several runs share.
class Engine {
 public:
  // Both must outlive the object.
  Engine(Gpu& gpu, const Scene& scene) : gpu_(gpu), scene_(scene) {}

  [[nodiscard]] Gpu& gpu() const { return gpu_; }
  // Creates the renderer when it is first needed.
  [[nodiscard]] Result<GbufferRenderer*> gbuffer(bool geometric);
  // Creates the context when it is first needed.
  [[nodiscard]] AlcoveContext* context();
  void drop_context() { context_.reset(); }

 private:
  Gpu& gpu_;
  const Scene& scene_;
  std::array<std::unique_ptr<GbufferRenderer>, 2> gbuffers_;
  passes::Context context_;
};

// Draws the g-buffers of a course once, and records their occlusion through the C interface as
// often as a caller wants, as an engine does.
class EngineRun {
 public:
  // `engine` must outlive the object.
  [[nodiscard]] static Result<std::unique_ptr<EngineRun>> create(Engine& engine,
                                                                 const Camera& camera,
                                                                 const EngineCourse& course);

  ~EngineRun();
  EngineRun(const EngineRun&) = delete;
  EngineRun& operator=(const EngineRun&) = delete;

  // Records the frames from 0 to `frames` as a new view. `change`, if it is given, changes them
  // from the frame `begin` on. If `submit_late` is true, each of these is submitted after the next
  // one was recorded. Returns the lines of alcoveDiagnose, which looks at pixels too, or the
  // message of a refused frame.
  [[nodiscard]] Result<std::string> draw(const ChangeFrame& change = {}, std::uint32_t begin = 0,
                                         bool submit_late = false);

 private:
  // A frame of the course, before a mistake is made.
  struct DrawnFrame {
    AlcoveView view{};
    OtherInputs other;
  };

  EngineRun(Engine& engine, const Camera& camera, const EngineCourse& course)
      : engine_(engine),
        gpu_(engine.gpu()),
        camera_(camera),
        course_(course),
        device_(gpu_.device()) {}
  template <typename Texel>
  AlcoveImage create_filled(VkFormat format, VkExtent2D size, const std::vector<Texel>& texels);
  template <typename Texel>
  std::vector<Texel> read(const AlcoveImage& image);
  VkExtent2D size_at(std::uint32_t frame) const;
  CameraMatrices matrices_at(std::uint32_t frame, bool with_jitter) const;
  glm::mat4 world_from_moving_at(std::uint32_t frame) const;
  Result<void> draw_frame(std::uint32_t frame);
  void create_other_inputs(DrawnFrame& targets, std::uint32_t frame);
  EngineFrame describe(std::uint32_t frame) const;

  Engine& engine_;
  Gpu& gpu_;
  Camera camera_;
  EngineCourse course_;
  passes::TestEngine device_;
  std::vector<DrawnFrame> frames_;
  std::uint32_t next_id_ = 0;
};

}  // namespace alcove::sample

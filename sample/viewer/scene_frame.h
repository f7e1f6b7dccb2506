#pragma once

#include <memory>
#include <optional>

#include "gpu/gpu.h"
#include "render/gbuffer.h"
#include "render/light.h"
#include "render/normal_source.h"
#include "render/shaders/picture.h"
#include "render/surfaces.h"
#include "scene/environment.h"
#include "support/result.h"
#include "viewer/view_state.h"

namespace alcove::sample {

// Declares the frames of the window: g-buffer, occlusion and the picture. Passes that the picture
// does not need are culled. Each frame is one graph. Only the scene's meshes and textures and the
// environment are resources outside of it.
class SceneFrame {
 public:
  // `format` is the format of the window's images. Both references must outlive the object.
  [[nodiscard]] static Result<std::unique_ptr<SceneFrame>> create(
      Gpu& gpu, const Scene& scene, const EnvironmentImage& environment, NormalSource normals,
      VkFormat format);

  // Adds the passes that draw `target`. Returns the version of the texture after them.
  [[nodiscard]] Result<framegraph::Texture> declare(framegraph::Graph& graph,
                                                    framegraph::Texture target,
                                                    const ViewState& state);
  // Returns the passes of the declared frame that belong to the view with ViewState::settings.
  const PassRange& view_passes() const { return view_passes_; }
  // Makes the declared frame the previous frame of the next one. Call it after the declared frame
  // was submitted.
  void advance();

 private:
  // The choices that determine format and size of the histories. If a frame differs from the
  // previous one in these, it does not count as static.
  struct HistoryFormat {
    OcclusionSettings settings;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    bool operator==(const HistoryFormat&) const = default;
  };
  // The choices that the previous frame was drawn with. Histories restart if they change.
  struct Choices {
    OcclusionSettings settings;
    std::optional<OcclusionSettings> compared;
    std::optional<float> roughness;
    bool operator==(const Choices&) const = default;
  };

  SceneFrame(Gpu& gpu, NormalSource normals) : gpu_(gpu), normals_(normals) {}
  void begin(framegraph::Graph& graph, const ViewState& state, VkExtent3D size);
  Result<framegraph::Texture> add_picture(framegraph::Graph& graph, const ViewState& state,
                                          const Surfaces& surfaces,
                                          const OcclusionSettings& settings, std::uint32_t view_id);
  maths::PictureParameters picture_parameters(const ViewState& state) const;

  Gpu& gpu_;
  NormalSource normals_;
  std::unique_ptr<GbufferRenderer> gbuffer_;
  std::unique_ptr<Light> light_;
  framegraph::Texture environment_;  // in the declared frame, if it is lit
  std::unique_ptr<FullScreenPass> picture_;
  float exposure_ = 1.0f;
  std::uint32_t index_ = 0;
  std::uint32_t static_frames_ = 0;  // see AlcoveViewInfo
  GbufferView view_;                 // of the declared frame
  PassRange view_passes_;            // of the declared frame
  Choices choices_;
  std::optional<GbufferView> previous_view_;
  std::optional<Choices> previous_choices_;
  HistoryFormat format_;  // of the previous frame
};

}  // namespace alcove::sample

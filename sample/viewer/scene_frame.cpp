#include "viewer/scene_frame.h"

#include <limits>
#include <utility>

#include "render/display.h"
#include "spirv/picture.h"

namespace alcove::sample {
namespace {

// The motion that is shown in full colour, as a fraction of the image's size.
constexpr float kFullMotion = 0.02f;

// Returns the settings with the outputs that the picture needs turned on.
OcclusionSettings with_outputs(OcclusionSettings settings, Picture picture) {
  const bool lit = picture == Picture::lit;
  settings.bent_normal = settings.bent_normal || lit || picture == Picture::bent_normal;
  if ((lit || picture == Picture::specular_occlusion) && settings.specular == ALCOVE_SPECULAR_NONE)
    settings.specular = ALCOVE_SPECULAR_SLICES;
  return settings;
}

bool reads_albedo(Picture picture) {
  return picture == Picture::lit || picture == Picture::multi_bounce || picture == Picture::albedo;
}

}  // namespace

Result<std::unique_ptr<SceneFrame>> SceneFrame::create(Gpu& gpu, const Scene& scene,
                                                       const EnvironmentImage& environment,
                                                       NormalSource normals, VkFormat format) {
  std::unique_ptr<SceneFrame> made(new SceneFrame(gpu, normals));
  ALCOVE_TRY(made->gbuffer_,
             GbufferRenderer::create(gpu, scene, normals == NormalSource::geometric));
  ALCOVE_TRY(made->light_, Light::create(gpu, environment));
  ALCOVE_TRY(made->picture_,
             FullScreenPass::create(
                 gpu, {"picture", kPicture, 2, sizeof(maths::PictureParameters), {format}}));
  made->exposure_ = exposure_of(environment);
  return made;
}

void SceneFrame::begin(Graph& graph, const ViewState& state, VkExtent3D size) {
  const std::uint32_t band = guard_band_pixels(state.guard_band, size.height);
  view_ = with_guard_band(gbuffer_view(state.camera, state.camera, {size.width, size.height}),
                          {size.width, size.height}, {band, band});
  choices_ = {state.settings, compared_settings(state), state.roughness};
  if (state.fits_budget)  // the history goes on when the number of samples changes
    choices_.settings.slices = choices_.settings.steps = 0;
  const HistoryFormat format{with_outputs(state.settings, state.picture), size.width, size.height};
  const bool same_kind = std::exchange(format_, format) == format;
  if (previous_choices_ != choices_) {
    index_ = 0;
    static_frames_ = 0;
    graph.reset_histories();
  } else {
    view_.previous_view_from_world = previous_view_->view_from_world;
    view_.previous_clip_from_view = previous_view_->clip_from_view;
    const bool same = same_kind && view_.view_from_world == view_.previous_view_from_world &&
                      view_.clip_from_view == view_.previous_clip_from_view;
    static_frames_ = same ? static_frames_ + 1 : 0;
  }
}

void SceneFrame::advance() {
  previous_view_ = view_;
  previous_choices_ = choices_;
  ++index_;
}

Result<Texture> SceneFrame::declare(Graph& graph, Texture target, const ViewState& state) {
  VkExtent3D size = graph.extent(target);
  begin(graph, state, size);
  const std::uint32_t band = guard_band_pixels(state.guard_band, size.height);
  size.width += 2 * band;
  size.height += 2 * band;
  const OcclusionSettings settings = with_outputs(state.settings, state.picture);
  const std::optional<OcclusionSettings> compared = compared_settings(state);
  const bool specular = settings.specular != ALCOVE_SPECULAR_NONE ||
                        (compared && compared->specular != ALCOVE_SPECULAR_NONE);
  const HiddenDepths hidden =
      hidden_depths_of(settings).with(compared ? hidden_depths_of(*compared) : HiddenDepths{});
  const bool wanted[kGbufferTargets.size()] = {
      true,
      normals_ != NormalSource::depth,
      reads_albedo(state.picture) || (specular && !state.roughness),
      state.picture == Picture::motion,
      state.picture == Picture::lit,
      hidden.back_faces,
      hidden.second_layer};
  Surfaces surfaces{.normals = normals_, .roughness = state.roughness};
  for (std::size_t i = 0; i < kGbufferTargets.size(); ++i) {
    const auto& [member, format, name] = kGbufferTargets[i];
    if (wanted[i]) {
      surfaces.gbuffer.*member = graph.create_texture(name, {format, {size.width, size.height}});
    }
  }
  surfaces.gbuffer = gbuffer_->add(graph, view_, surfaces.gbuffer);
  environment_ = state.picture == Picture::lit ? light_->import(graph) : Texture();

  maths::PictureParameters parameters = picture_parameters(state);
  parameters.band = static_cast<float>(band);
  Texture shown[2];
  ALCOVE_TRY(shown[0], add_picture(graph, state, surfaces, settings, 0));
  if (compared) {
    ALCOVE_TRY(shown[1],
               add_picture(graph, state, surfaces, with_outputs(*compared, state.picture), 1));
    parameters.split = state.split * static_cast<float>(graph.extent(target).width);
  }
  picture_->add(graph, shown, {&target, 1}, parameters);
  return target;
}

maths::PictureParameters SceneFrame::picture_parameters(const ViewState& state) const {
  maths::PictureParameters parameters{glm::mat4(1.0f), maths::kShowGrey,
                                      std::numeric_limits<float>::max(), 1.0f};
  switch (state.picture) {
    case Picture::lit:
      parameters.show = maths::kShowRadiance;
      parameters.scale = exposure_;
      break;
    case Picture::multi_bounce:
    case Picture::albedo:
      parameters.show = maths::kShowColour;
      break;
    case Picture::bent_normal:
    case Picture::normals:
      parameters.show = maths::kShowDirection;
      if (normals_ == NormalSource::depth)
        parameters.world_from_shown = glm::mat4(glm::transpose(glm::mat3(view_.view_from_world)));
      break;
    case Picture::depth:
      parameters.show = maths::kShowDepth;
      parameters.scale = glm::distance(state.camera.eye_ws, state.camera.target_ws);
      break;
    case Picture::motion:
      parameters.show = maths::kShowMotion;
      parameters.scale = 1.0f / kFullMotion;
      break;
    default:
      parameters.show = maths::kShowGrey;
  }
  return parameters;
}

// Adds the passes of the picture with `settings`, and returns the texture that is shown.
Result<Texture> SceneFrame::add_picture(Graph& graph, const ViewState& state,
                                        const Surfaces& surfaces, const OcclusionSettings& settings,
                                        std::uint32_t view_id) {
  const AlcoveViewInfo view = view_info(view_, view_id, static_frames_);
  ALCOVE_TRY(const Occlusion outputs, add_occlusion(graph, gpu_, view, index_, surfaces, settings,
                                                    state.picture == Picture::multi_bounce));
  if (view_id == 0) view_passes_ = outputs.passes;
  // All outputs of the settings are computed, and timed, whether they are shown or not.
  for (const Texture output : {outputs.visibility, outputs.bent_normal, outputs.specular})
    if (output) graph.output(output);
  switch (state.picture) {
    case Picture::lit:
      return light_
          ->add(graph, environment_, view_, surfaces, outputs.normals,
                {outputs.visibility, outputs.bent_normal, outputs.specular, true})
          .all;
    case Picture::multi_bounce:
      return outputs.multi_bounce;
    case Picture::bent_normal:
      return outputs.bent_normal;
    case Picture::specular_occlusion:
      return outputs.specular;
    case Picture::normals:
      return outputs.normals;
    case Picture::depth:
      return passes::add_surface(graph, gpu_.pipelines(), view.camera, surfaces.gbuffer.depth)
          .map([](const passes::SurfaceTextures& made) { return made.linear_depth; })
          .map_error(&passes::Error::message);
    case Picture::albedo:
      return surfaces.gbuffer.albedo;
    case Picture::motion:
      return surfaces.gbuffer.motion;
    default:
      return outputs.visibility;
  }
}

}  // namespace alcove::sample

#include "viewer/scene_frame.h"

#include <utility>

#include "alcove/passes/multi_bounce.h"
#include "render/display.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using Failure = tl::unexpected<std::string>;

// The motion that is shown in full colour, as a fraction of the image's size.
constexpr float kFullMotion = 0.02f;

// Returns the settings with the outputs that the picture needs turned on.
OcclusionSettings with_outputs(OcclusionSettings settings, Picture picture) {
  const bool lit = picture == Picture::lit;
  settings.bent_normal = settings.bent_normal || lit || picture == Picture::bent_normal;
  if ((lit || picture == Picture::specular_occlusion) &&
      settings.specular == passes::Specular::none)
    settings.specular = passes::Specular::slices;
  return settings;
}

bool reads_albedo(Picture picture) {
  return picture == Picture::lit || picture == Picture::multi_bounce || picture == Picture::albedo;
}

glm::mat3 ray_from_ndc(const Camera& camera, const CameraMatrices& matrices) {
  const glm::mat3 rotation(matrices.world_from_view);
  if (camera.orthographic) return {glm::vec3(0.0f), glm::vec3(0.0f), -rotation[2]};
  const glm::mat4& p = matrices.clip_from_view;
  return rotation * glm::mat3(1.0f / p[0][0], 0.0f, 0.0f,  //
                              0.0f, 1.0f / p[1][1], 0.0f,  //
                              p[2][0] / p[0][0], p[2][1] / p[1][1], -1.0f);
}

}  // namespace

tl::expected<std::unique_ptr<SceneFrame>, std::string> SceneFrame::create(
    Gpu& gpu, const Scene& scene, const EnvironmentImage& environment, NormalSource normals,
    VkFormat format) {
  std::unique_ptr<SceneFrame> made(new SceneFrame(gpu, normals));
  auto done =
      assign(made->gbuffer_,
             GbufferRenderer::create(gpu, scene, normals == NormalSource::geometric))
          .and_then([&] { return assign(made->probe_, Probe::create(gpu, environment)); })
          .and_then([&] { return assign(made->picture_, PicturePass::create(gpu, format)); });
  if (!done) return Failure(std::move(done.error()));
  made->exposure_ = exposure_of(environment);
  return made;
}

void SceneFrame::begin(Graph& graph, const ViewState& state, VkExtent3D size) {
  light_ = {};
  const CameraMatrices matrices = camera_matrices(state.camera, size.width, size.height);
  view_ = {matrices.view_from_world, matrices.clip_from_view, matrices.view_from_world,
           matrices.clip_from_view, state.camera.reversed_z};
  ray_from_ndc_ = ray_from_ndc(state.camera, matrices);
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

passes::Frame SceneFrame::frame_of(Graph& graph) const {
  return pass_frame(graph, gpu_, view_, index_, static_frames_);
}

tl::expected<Texture, std::string> SceneFrame::declare(Graph& graph, Texture target,
                                                       const ViewState& state) {
  const VkExtent3D size = graph.extent(target);
  begin(graph, state, size);
  const OcclusionSettings settings = with_outputs(state.settings, state.picture);
  const std::optional<OcclusionSettings> compared = compared_settings(state);
  const bool specular = settings.specular != passes::Specular::none ||
                        (compared && compared->specular != passes::Specular::none);
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

  PictureInputs inputs = picture_inputs(state);
  auto picture = add_picture(graph, state, surfaces, settings, "occlusion", inputs);
  if (!picture) return picture;
  inputs.texture = *picture;
  if (compared) {
    auto other = add_picture(graph, state, surfaces, with_outputs(*compared, state.picture),
                             "compared", inputs);
    if (!other) return other;
    inputs.other = *other;
    inputs.split = state.split * static_cast<float>(graph.extent(target).width);
  }
  return picture_->add(graph, target, inputs);
}

PictureInputs SceneFrame::picture_inputs(const ViewState& state) const {
  PictureInputs inputs;
  switch (state.picture) {
    case Picture::lit:
      inputs.show = maths::kShowRadiance;
      inputs.world_from_shown = ray_from_ndc_;
      inputs.scale = exposure_;
      break;
    case Picture::multi_bounce:
    case Picture::albedo:
      inputs.show = maths::kShowColour;
      break;
    case Picture::bent_normal:
    case Picture::normals:
      inputs.show = maths::kShowDirection;
      if (normals_ == NormalSource::depth)
        inputs.world_from_shown = glm::transpose(glm::mat3(view_.view_from_world));
      break;
    case Picture::depth:
      inputs.show = maths::kShowDepth;
      inputs.scale = glm::distance(state.camera.eye_ws, state.camera.target_ws);
      break;
    case Picture::motion:
      inputs.show = maths::kShowMotion;
      inputs.scale = 1.0f / kFullMotion;
      break;
    default:
      inputs.show = maths::kShowGrey;
  }
  return inputs;
}

// Adds the passes of the picture with `settings`, and returns the texture that is inputs.
tl::expected<Texture, std::string> SceneFrame::add_picture(Graph& graph, const ViewState& state,
                                                           const Surfaces& surfaces,
                                                           OcclusionSettings settings,
                                                           std::string_view history_name,
                                                           PictureInputs& inputs) {
  settings.linear_depth = true;  // which lighting and a picture of it read
  const auto outputs = add_occlusion(frame_of(graph), surfaces, settings, history_name);
  if (!outputs) return Failure(outputs.error());
  // All outputs of the settings are computed, and timed, whether they are shown or not.
  for (const Texture output : {outputs->visibility, outputs->bent_normal, outputs->specular})
    if (output) graph.output(output);
  switch (state.picture) {
    case Picture::lit:
      return add_lit(graph, surfaces, *outputs, inputs);
    case Picture::multi_bounce:
      return passes::add_multi_bounce(frame_of(graph),
                                      {outputs->visibility, surfaces.gbuffer.albedo},
                                      settings.precision)
          .map_error([](const passes::Error& error) { return error.message; });
    case Picture::bent_normal:
      return outputs->bent_normal;
    case Picture::specular_occlusion:
      return outputs->specular;
    case Picture::normals:
      return outputs->normals;
    case Picture::depth:
      return outputs->linear_depth;
    case Picture::albedo:
      return surfaces.gbuffer.albedo;
    case Picture::motion:
      return surfaces.gbuffer.motion;
    default:
      return outputs->visibility;
  }
}

tl::expected<Texture, std::string> SceneFrame::add_lit(Graph& graph, const Surfaces& surfaces,
                                                       const passes::OcclusionOutputs& outputs,
                                                       PictureInputs& inputs) {
  if (!light_.map) light_ = probe_->import(graph);
  inputs.linear_depth = outputs.linear_depth;
  inputs.environment = light_.map;
  return add_light(frame_of(graph), surfaces, outputs, light_,
                   {.visibility = outputs.visibility,
                    .bent_normal = outputs.bent_normal,
                    .specular_occlusion = outputs.specular})
      .map([](const passes::AppliedLight& lit) { return lit.lit; });
}

}  // namespace alcove::sample

#include "alcove/passes/reconstruct.h"

#include <algorithm>
#include <array>

#include "graph/bindings.h"
#include "graph/check_reconstruct.h"
#include "graph/reconstruct_textures.h"
#include "graph/upsample.h"
#include "maths/history.h"
#include "work/reconstruct_uniforms.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;

namespace {

// Static frames after which every pixel of a tile of 4x4 has been traced once.
constexpr std::uint32_t kConvergedFrames = 16;

// The kind of history that a frame can use. The pipeline depends on it, and also on the settings,
// the inputs and the kind of projection.
enum class Past : std::uint8_t {
  none,  // no history, or none that can be read
  moving,
  unchanged,  // the previous frame shows the same
};

Shader shader_of(bool history, bool lobe, bool half) {
  if (half && lobe) {
    return history ? Shader::reconstruct_half_specular_history : Shader::reconstruct_half_specular;
  }
  if (half) {
    return history ? Shader::reconstruct_half_history : Shader::reconstruct_half;
  }
  if (lobe) {
    return history ? Shader::reconstruct_specular_history : Shader::reconstruct_specular;
  }
  return history ? Shader::reconstruct_history : Shader::reconstruct;
}

Past past_of(const Frame& frame, const ReconstructSizes& sizes, bool history_valid, bool motion) {
  if (!history_valid) {
    return Past::none;
  }
  const bool same_size =
      sizes.now.width == sizes.previous.width && sizes.now.height == sizes.previous.height;
  if (motion || !same_size || frame.view != frame.previous_view) {
    return Past::moving;
  }
  return Past::unchanged;
}

std::array<NamedConstant, 16> constants_of(const ReconstructInputs& inputs,
                                           const OcclusionSettings& settings,
                                           const maths::Projection& projection, Past past) {
  const bool shaped = settings.power != 1.0f || settings.intensity != 1.0f;
  return {{{"kTileSize", inputs.raw_occlusion.tile_size},
           {"kFilterRadius", settings.advanced.filter_radius},
           {"kBentNormal", flag(bool(inputs.raw_occlusion.bent))},
           {"kMotion", flag(inputs.motion && past == Past::moving)},
           {"kPerspective", flag(is_perspective(projection))},
           {"kClamp", flag(settings.advanced.clamp_width > 0.0f)},
           {"kStatic", flag(past == Past::unchanged)},
           {"kRoughnessTexture", flag(bool(inputs.roughness))},
           {"kRoughnessChannel", channel_if(bool(inputs.roughness), settings.roughness_channel)},
           {"kFresh", flag(past == Past::none)},
           {"kVisibility", flag(needs_visibility(settings))},
           {"kNormalEncoding", static_cast<std::uint32_t>(inputs.normal_encoding)},
           {"kShaped", flag(!settings.half_resolution && shaped)},
           {"kReversed", flag(is_reversed(projection))},
           {"kKeepsChannels", flag(inputs.visibility_channel != VisibilityChannel::all)},
           {"kVisibilityChannel", channel_index(inputs.visibility_channel)}}};
}

tl::expected<Kernel, Error> get_kernel(const Frame& frame, const ReconstructInputs& inputs,
                                       const OcclusionSettings& settings,
                                       const maths::Projection& projection, Past past) {
  const bool history = settings.history_frames > 0;
  const auto get = [&](Past of) {
    return frame.kernels.get(
        shader_of(history, inputs.raw_occlusion.lobe, settings.half_resolution),
        constants_of(inputs, settings, projection, of));
  };
  if (history && frame.prepare) {
    for (const Past each : {Past::none, Past::moving, Past::unchanged}) {
      if (auto made = get(each); !made) {
        return made;
      }
    }
  }
  return get(past);
}

// Returns the frame without its previous view and sizes, which are not read if there is no history.
Frame without_past(const Frame& frame) {
  Frame alone = frame;
  alone.previous_view = frame.view;
  alone.previous_size = alone.largest_size = {};
  return alone;
}

}  // namespace

tl::expected<Occlusion, Error> add_reconstruct(const Frame& given_frame,
                                               const ReconstructInputs& given,
                                               const OcclusionSettings& settings,
                                               std::string_view history_name) {
  const bool history = settings.history_frames > 0;
  Frame frame = history ? given_frame : without_past(given_frame);
  ReconstructInputs inputs = given;
  if (frame.view == frame.previous_view && frame.static_frames > 0 && !frame.prepare) {
    inputs.motion = {};
  }
  if (!inputs.raw_occlusion.lobe) {
    inputs.roughness = {};
  }
  if (!inputs.into.visibility || !needs_visibility(settings)) {
    inputs.visibility_channel = VisibilityChannel::all;
  }
  if (auto good = check_reconstruct(frame, inputs, settings); !good) {
    return tl::unexpected(good.error());
  }
  if (!history) {
    inputs.motion = {};
  }
  const auto sizes = reconstruct_sizes(frame, inputs.depth_ndc);
  if (!sizes) {
    return tl::unexpected(sizes.error());
  }
  const auto projection = projection_of(frame.view, sizes->now);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  bool history_valid = false;
  ReconstructTextures textures =
      create_reconstruct_textures(frame, inputs, settings, *sizes, history_name, history_valid);
  if (!history_valid) {  // the previous view is not read
    frame.previous_view = frame.view;
  }
  const auto previous = projection_of(frame.previous_view, sizes->previous, "The previous view");
  if (!previous) {
    return tl::unexpected(Error{previous.error().message +
                                " Where there was none, reset the history (reset_history)."});
  }
  const Past past = past_of(frame, *sizes, history_valid, bool(inputs.motion));
  const auto kernel = get_kernel(frame, inputs, settings, *projection, past);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  auto pass = frame.graph.add_pass("reconstruct");
  declare_reconstruct_accesses(frame.graph, pass, textures);
  maths::ReconstructParameters parameters =
      reconstruct_parameters(frame, *projection, *previous, inputs, settings);
  // In a static view all frames get the same weight in the history.
  if (past == Past::unchanged && frame.static_frames >= kConvergedFrames) {
    parameters.largest_weight = static_cast<float>(maths::kMaxHistoryFrames) - 1.0f;
  }
  const VkExtent2D half_size{(sizes->now.width + 1) / 2, (sizes->now.height + 1) / 2};
  const VkExtent3D stored =
      textures.history.next ? frame.graph.extent(textures.history.next) : VkExtent3D{1, 1, 1};
  parameters.history_texel = 1.0f / maths::vec2(stored.width, stored.height);
  // The dispatch covers one more texel to the right and below, if the textures have room for it,
  // because the upsampling pass reads those texels.
  const VkExtent3D half_extent{std::min(half_size.width + 1, stored.width),
                               std::min(half_size.height + 1, stored.height), 1};
  pass.record([&kernels = frame.kernels, kernel = *kernel, textures, parameters,
               half_extent](RecordContext& context) {
    kernels.dispatch(context, kernel, reconstruct_views(context, textures), bytes_of(parameters),
                     is_half(textures) ? half_extent : context.extent(textures.inputs.depth_ndc));
  });
  if (!is_half(textures)) {
    return textures.result;
  }
  return add_upsample(frame,
                      {.half = textures.history.next,
                       .half_depth = textures.depth_history.next,
                       .half_size = half_size,
                       .residuals = textures.bent_history.next,
                       .lobes = textures.lobe_history.next,
                       .depth_ndc = inputs.depth_ndc,
                       .normals = inputs.normals,
                       .normals_in_view_space = inputs.normals_in_view_space,
                       .normal_encoding = inputs.normal_encoding,
                       .normals_forward_z = inputs.normals_forward_z,
                       .visibility_channel = inputs.visibility_channel,
                       .half_size_results = inputs.half_size_results},
                      textures.result, settings);
}

}  // namespace alcove::passes

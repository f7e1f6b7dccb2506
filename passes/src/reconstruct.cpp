#include "alcove/passes/reconstruct.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <memory_resource>
#include <span>
#include <string>

#include "bindings.h"
#include "check_reconstruct.h"
#include "interleave_offset.h"
#include "maths/history.h"
#include "maths/slice_line.h"
#include "output_format.h"
#include "reconstruct_parameters.h"
#include "upsample.h"
#include "view_parameters.h"
#include "write_result.h"

namespace alcove::passes {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using framegraph::TextureHistory;

namespace {

// Static frames after which every pixel of a tile of 4x4 has been traced once.
constexpr std::uint32_t kConvergedFrames = 16;

// The state of the history at a frame. The pipeline depends on it, on settings, on inputs and on
// the kind of projection.
enum class Past : std::uint8_t {
  none,  // no history, or none that can be read
  moving,
  unchanged,  // the previous frame shows the same
};

// The name of another history that goes with `history_name`. Its memory is part of the object, so
// that a steady frame allocates nothing for it.
class DerivedHistoryName {
 public:
  DerivedHistoryName(std::string_view history_name, std::string_view suffix) {
    text_.reserve(history_name.size() + suffix.size());
    text_.append(history_name).append(suffix);
  }
  operator std::string_view() const { return text_; }

 private:
  std::array<std::byte, 128> room_;
  std::pmr::monotonic_buffer_resource memory_{room_.data(), room_.size()};
  std::pmr::string text_{&memory_};
};

constexpr std::string_view kDepthSuffix = " depth";
constexpr std::string_view kBentSuffix = " bent normal";
constexpr std::string_view kLobeSuffix = " specular";

// A history's texture of the previous frame and that of this frame; null where it is not wanted.
struct HistoryTextures {
  Texture previous;
  Texture next;
};

// Every texture that the pass accesses; null where it is not wanted.
struct Textures {
  ReconstructInputs inputs;
  Occlusion result;               // at half resolution the upsampling pass writes it
  HistoryTextures history;        // at half resolution maths::pack_half_texel()
  HistoryTextures depth_history;  // maths::half_texel_depth(), only at half resolution
  HistoryTextures bent_history;
  HistoryTextures lobe_history;
};

// Declares a history, or resets it where it is not wanted, since it is out of date by the time that
// it is wanted again. Clears `valid` where the previous frame's texture cannot be read.
HistoryTextures create_history(Graph& graph, bool wanted, std::string_view name, VkFormat format,
                               framegraph::Extent largest, bool& valid) {
  if (!wanted) {
    graph.reset_history(name);
    return {};
  }
  const TextureHistory history = graph.create_texture_history(name, {format, largest});
  valid = valid && history.validity == framegraph::HistoryValidity::valid;
  return {history.previous(), history.current};
}

// Declares the histories; `valid` is whether those of the previous frame can be read.
void create_histories(Graph& graph, const OcclusionSettings& settings,
                      std::string_view history_name, framegraph::Extent largest, Textures& textures,
                      bool& valid) {
  const bool wanted = settings.history_frames > 0;
  const RawOcclusionTextures& raw_occlusion = textures.inputs.raw_occlusion;
  valid = wanted;
  const bool half = settings.half_resolution;
  textures.history = create_history(graph, wanted, history_name,
                                    half ? kHalfFormat : kHistoryFormat, largest, valid);
  textures.depth_history =
      create_history(graph, wanted && half, DerivedHistoryName(history_name, kDepthSuffix),
                     kHalfDepthFormat, largest, valid);
  textures.bent_history = create_history(
      graph, wanted && raw_occlusion.bent, DerivedHistoryName(history_name, kBentSuffix),
      half ? kHalfBentFormat : kBentHistoryFormat, largest, valid);
  textures.lobe_history = create_history(graph, wanted && raw_occlusion.lobe,
                                         DerivedHistoryName(history_name, kLobeSuffix),
                                         kLobeHistoryFormat, largest, valid);
}

// Pixels per texel of what is reconstructed, in each direction.
std::uint32_t texel_size(const OcclusionSettings& settings) {
  return settings.half_resolution ? 2 : 1;
}

framegraph::Extent texels(VkExtent2D pixels, const OcclusionSettings& settings) {
  const std::uint32_t size = texel_size(settings);
  return framegraph::Extent::absolute((pixels.width + size - 1) / size,
                                      (pixels.height + size - 1) / size);
}

// Declares what the pass writes for the upsampling pass. Histories are written for it too.
void create_half(Graph& graph, const OcclusionSettings& settings, const ReconstructSizes& sizes,
                 Textures& textures) {
  const auto size = texels(sizes.now, settings);
  if (!textures.history.next) {
    textures.history.next = graph.create_texture("half resolution", {kHalfFormat, size});
    textures.depth_history.next =
        graph.create_texture("half-resolution depth", {kHalfDepthFormat, size});
  }
  if (textures.inputs.raw_occlusion.bent && !textures.bent_history.next) {
    textures.bent_history.next =
        graph.create_texture("half-resolution residual", {kHalfBentFormat, size});
  }
  if (textures.inputs.raw_occlusion.lobe && !textures.lobe_history.next) {
    textures.lobe_history.next =
        graph.create_texture("half-resolution lobe", {kLobeHistoryFormat, size});
  }
}

// Declares the textures that the pass writes. `valid` is whether last frame's history can be read.
Textures create_textures(const Frame& frame, const ReconstructInputs& inputs,
                         const OcclusionSettings& settings, const ReconstructSizes& sizes,
                         std::string_view history_name, bool& valid) {
  Graph& graph = frame.graph;
  const auto size = framegraph::Extent::absolute(sizes.now.width, sizes.now.height);
  const auto largest = texels(sizes.largest, settings);
  Textures textures{.inputs = inputs};
  if (needs_visibility(settings)) {
    textures.result.visibility = given_or_created(graph, inputs.into.visibility, "visibility",
                                                  {scalar_format(settings.precision), size});
  }
  if (inputs.raw_occlusion.bent) {
    textures.result.bent_normal = given_or_created(graph, inputs.into.bent_normal, "bent normal",
                                                   {direction_format(settings.precision), size});
  }
  if (inputs.raw_occlusion.lobe) {
    textures.result.specular = given_or_created(graph, inputs.into.specular, "specular occlusion",
                                                {scalar_format(settings.precision), size});
  }
  create_histories(graph, settings, history_name, largest, textures, valid);
  if (settings.half_resolution) {
    create_half(graph, settings, sizes, textures);
  }
  return textures;
}

bool is_half(const Textures& textures) { return bool(textures.depth_history.next); }

// The normals, or null where the pass does not read them: at half resolution only the weights of
// GGX lobes need them.
Texture read_normals(const Textures& textures) {
  const bool read = !is_half(textures) || textures.inputs.raw_occlusion.lobe;
  return read ? textures.inputs.normals : Texture{};
}

void declare_accesses(const Graph& graph, framegraph::PassBuilder& pass, Textures& textures) {
  const auto read = [&](Texture texture, const framegraph::Access& access) {
    if (texture) {
      pass.read(texture, access);
    }
  };
  const auto write = [&](Texture& texture) {
    if (texture) {
      texture = write_result(graph, pass, texture);
    }
  };
  const auto& sampled = framegraph::access::sampled_compute;
  const auto& stored = framegraph::access::storage_read_compute;
  read(textures.inputs.raw_occlusion.raw_occlusion, stored);
  read(textures.inputs.raw_occlusion.bent, stored);
  read(textures.inputs.depth_ndc, sampled);
  read(read_normals(textures), sampled);
  read(textures.inputs.motion, sampled);
  read(textures.inputs.roughness, sampled);
  if (!is_half(textures)) {
    write(textures.result.visibility);
    write(textures.result.bent_normal);
    write(textures.result.specular);
  }
  for (HistoryTextures* const history : {&textures.history, &textures.depth_history,
                                         &textures.bent_history, &textures.lobe_history}) {
    read(history->previous, sampled);
    write(history->next);
  }
}

// The views of a dispatch; the array has room for all bindings of the shader.
struct Bindings {
  std::array<VkImageView, 15> views{};
  std::size_t count = 0;

  void add(std::initializer_list<VkImageView> more) {
    for (const VkImageView view : more) {
      views.at(count++) = view;
    }
  }
};

// One of the results that are wanted.
Texture any_of(const Occlusion& results) {
  if (results.visibility) {
    return results.visibility;
  }
  return results.bent_normal ? results.bent_normal : results.specular;
}

// In the order of the shader's bindings.
Bindings bindings_of(RecordContext& context, const Textures& textures) {
  const ReconstructInputs& in = textures.inputs;
  const Occlusion& out = textures.result;
  const Texture written = any_of(out);
  // Half resolution may read no normals.
  const bool half = is_half(textures);
  const Texture sampled = half ? in.depth_ndc : in.normals;
  Bindings bindings;
  bindings.add({context.view(in.raw_occlusion.raw_occlusion),
                view_or(context, in.raw_occlusion.bent, in.raw_occlusion.raw_occlusion),
                context.view(in.depth_ndc), view_or(context, read_normals(textures), sampled)});
  if (half) {
    bindings.add({context.view(textures.history.next), context.view(textures.depth_history.next)});
  } else {
    bindings.add(
        {view_or(context, out.visibility, written), view_or(context, out.bent_normal, written)});
  }
  if (textures.history.previous) {
    bindings.add({context.view(textures.history.previous),
                  context.view(half ? textures.depth_history.previous : textures.history.next),
                  view_or(context, in.motion, sampled),
                  view_or(context, textures.bent_history.previous, textures.history.previous),
                  view_or(context, textures.bent_history.next, textures.history.next)});
  } else if (half) {
    bindings.add({view_or(context, textures.bent_history.next, textures.history.next)});
  }
  if (in.raw_occlusion.lobe) {
    bindings.add({view_or(context, in.roughness, sampled)});
    if (!half) {
      bindings.add({context.view(out.specular)});
    }
  }
  if (textures.lobe_history.previous) {
    bindings.add({context.view(textures.lobe_history.previous)});
  }
  if (textures.lobe_history.next) {
    bindings.add({context.view(textures.lobe_history.next)});
  }
  return bindings;
}

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

// The shader's specialisation constants, in its order.
std::array<std::uint32_t, 14> constants_of(const ReconstructInputs& inputs,
                                           const OcclusionSettings& settings,
                                           const maths::Projection& projection, Past past) {
  return {inputs.raw_occlusion.tile_size,
          settings.advanced.filter_radius,
          flag(bool(inputs.raw_occlusion.bent)),
          flag(inputs.motion && past == Past::moving),
          flag(is_perspective(projection)),
          flag(settings.advanced.clamp_width > 0.0f),
          flag(past == Past::unchanged),
          flag(bool(inputs.roughness)),
          channel_if(bool(inputs.roughness), settings.roughness_channel),
          flag(past == Past::none),
          flag(needs_visibility(settings)),
          static_cast<std::uint32_t>(inputs.normal_encoding),
          flag(!settings.half_resolution && (settings.power != 1.0f || settings.intensity != 1.0f)),
          flag(is_reversed(projection))};
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

// To view-space positions from (x s, y s, depth, 1), x and y in pixels and s the depth in
// perspective and 1 in orthographic views.
maths::mat4 view_from_pixel(const maths::Projection& p) {
  const maths::vec2 per_px = maths::ray_per_px(p);
  maths::mat4 m(0.0f);
  m[0][0] = per_px.x;
  m[1][1] = per_px.y;
  m[2] = maths::vec4(p.uv_to_slope.z, p.uv_to_slope.w, -1.0f, 0.0f);
  m[3] = maths::vec4(p.uv_to_origin.z, p.uv_to_origin.w, 0.0f, 1.0f);
  return m;
}

// From view-space positions to (x w, y w, depth, w), x and y in pixels.
maths::mat4 pixel_from_view(const maths::Projection& p) {
  maths::mat4 m(0.0f);
  m[0][0] = p.position_to_uv.x * p.size_px.x;
  m[1][1] = p.position_to_uv.y * p.size_px.y;
  m[2] = -maths::vec4(p.depth_to_uv.x * p.size_px.x, p.depth_to_uv.y * p.size_px.y, 1.0f,
                      p.depth_to_uv.z);
  m[3] = maths::vec4(p.position_to_uv.z * p.size_px.x, p.position_to_uv.w * p.size_px.y, 0.0f,
                     p.depth_to_uv.w);
  return m;
}

// Octaves of depth that the history of a perspective view can tell apart, from the near plane on.
// 14 bits then resolve depth to 2^-10 of itself, or finer where the far plane is nearer.
constexpr float kLargestDepthOctaves = 22.0f;

// The largest power of two that is no larger than the near plane's distance.
float history_unit(const maths::Projection& p) {
  constexpr float kLeast = 1e-30f;
  return std::ldexp(1.0f, std::ilogb(std::max(p.near_far.x, kLeast)));
}

// Scale and offset of maths::history_depth(). A perspective view's depth is stored as its
// logarithm, an orthographic view's as it is, both between the near and the far plane.
maths::vec2 history_depth_scale(const maths::Projection& p) {
  constexpr float kLeast = 1e-30f;
  const float near = p.near_far.x;
  const float far = p.near_far.y;
  if (is_perspective(p)) {
    const float unit = history_unit(p);
    const float log_near = std::log2(std::max(near, kLeast) / unit);
    const float octaves =
        far >= maths::kSkyDepth
            ? kLargestDepthOctaves
            : std::clamp(std::log2(far / std::max(near, kLeast)), 0.01f, kLargestDepthOctaves);
    return {1.0f / octaves, (log_near + octaves) / octaves};
  }
  const float scale = 1.0f / std::max(far - near, kLeast);
  return {scale, -near * scale};
}

// Half a step of the 14 bits of a stored depth, and what computing it rounds.
constexpr float kHistorySlack = 0.75f / 16383.0f;

// ReconstructParameters::history_sharpness. A texel counts less the further it lies off the tangent
// plane, and not at all from 1.5 texels on, or from 0.3 % of the depth in perspective where texels
// are larger. It must at least be 0.12 % there, about the step of a stored depth.
float relative_history_distance(float texel) { return std::clamp(1.5f * texel, 0.0012f, 0.003f); }

float history_sharpness(const maths::Projection& p, maths::vec2 scale) {
  const float pixel = std::abs(maths::ray_per_px(p).y);
  if (is_perspective(p)) {
    // The stored depth changes by scale / ln 2 times a relative change of depth.
    constexpr float kLn2 = 0.69314718f;
    return kLn2 / (relative_history_distance(pixel) * scale.x);
  }
  return 1.0f / std::max(1.5f * pixel * scale.x, 2.0f * kHistorySlack);
}

// The depth of a texel at half resolution is stored to 2^-15 of itself, which is a small part of
// the distance at which a texel no longer counts.
constexpr float kHalfHistorySlack = 0.03f;

// The same at half resolution, where depths are stored as they are: over relative changes of depth
// in perspective, over changes of depth in orthographic views.
float half_history_sharpness(const maths::Projection& p) {
  const float texel = 2.0f * std::abs(maths::ray_per_px(p).y);
  const float rounding = 0x1p-14f * std::abs(p.near_far.y);
  return 1.0f /
         (is_perspective(p) ? relative_history_distance(texel) : std::max(1.5f * texel, rounding));
}

// The width in pixels of the filter's window in a first frame: wide for few slices, for many hardly
// wider than the distance between tiles. Fitted to the error of first frames (`alcove compare
// --frames 1`).
float window_px(const RawOcclusionTextures& raw_occlusion) {
  const float few = 1.1f / std::sqrt(static_cast<float>(raw_occlusion.slices));
  return static_cast<float>(raw_occlusion.tile_size) * std::max(few, 0.55f);
}

maths::ReconstructParameters parameters_of(const Frame& frame, const maths::Projection& projection,
                                           const maths::Projection& previous,
                                           const ReconstructInputs& inputs,
                                           const OcclusionSettings& settings) {
  const maths::mat4 from_pixel = view_from_pixel(projection);
  // In double: far from the world's origin the two all but cancel.
  const maths::dmat4 to_previous = to_rigid(frame.previous_view.view_from_world) *
                                   maths::inverse(to_rigid(frame.view.view_from_world));
  const maths::mat4 to_view =
      view_from_normal(frame, inputs.normals_in_view_space, inputs.normals_forward_z);
  maths::ReconstructParameters parameters{};
  const maths::mat4 previous_from_pixel = maths::transpose(maths::mat4(
      maths::dmat4(pixel_from_view(previous)) * to_previous * maths::dmat4(from_pixel)));
  // x, y, w and depth.
  parameters.previous_from_pixel = maths::mat4(previous_from_pixel[0], previous_from_pixel[1],
                                               previous_from_pixel[3], previous_from_pixel[2]);
  parameters.normal_from_view = maths::transpose(to_view);
  parameters.previous_from_view = maths::mat4(maths::mat3(maths::mat4(to_previous)));
  parameters.slope = maths::vec4(maths::ray_per_px(projection), projection.uv_to_slope.z,
                                 projection.uv_to_slope.w);
  parameters.tolerance =
      1.0f / (settings.advanced.filter_tolerance_px * std::abs(maths::ray_per_px(projection).y));
  parameters.largest_weight = static_cast<float>(settings.history_frames) - 1.0f;
  parameters.clamp_width = settings.advanced.clamp_width;
  const auto texel = static_cast<float>(texel_size(settings));
  parameters.previous_extent = maths::vec4(maths::ceil(previous.size_px / texel) - 0.5f,
                                           previous.size_px / projection.size_px);
  parameters.pixel_uv = 1.0f / projection.size_px;
  parameters.inverse_depth_from_ndc = inverse_depth_from_ndc(projection);
  parameters.pixels_per_slope = 1.0f / maths::ray_per_px(projection);
  parameters.history_depth_scale =
      maths::vec4(history_depth_scale(projection), history_depth_scale(previous));
  parameters.history_unit = {history_unit(projection), history_unit(previous)};
  if (settings.half_resolution) {
    parameters.history_sharpness = half_history_sharpness(projection);
    parameters.history_slack = kHalfHistorySlack;
  } else {
    parameters.history_sharpness = history_sharpness(projection, history_depth_scale(previous));
    parameters.history_slack = kHistorySlack;
  }
  // The golden ratio's fractions are spread evenly over any run of frames.
  parameters.dither_offset = static_cast<float>(frame.index * 2654435769u) * 0x1p-32f;
  const MotionConvention& motion = inputs.motion_convention;
  parameters.motion =
      maths::vec4(maths::vec2(motion.scale[0], motion.scale[1]) * previous.size_px,
                  maths::vec2(motion.offset[0], motion.offset[1]) * previous.size_px);
  parameters.roughness = settings.roughness;
  parameters.power = settings.power;
  parameters.intensity = settings.intensity;
  return parameters;
}

// ReconstructParameters::traced_range. The tiles at the right and the lower border trace their last
// pixel where the interleave offset lies beyond the image.
maths::vec4 traced_range(maths::vec2 size_px, maths::vec2 offset, float tile_size) {
  const maths::vec2 last = maths::ceil(size_px / tile_size) * tile_size - tile_size + offset;
  const maths::vec2 largest = maths::min(last, size_px - 1.0f);
  return maths::vec4(maths::min(offset, largest), largest);
}

// Without a history nothing of the frame before is read.
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
  Textures textures = create_textures(frame, inputs, settings, *sizes, history_name, history_valid);
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
  declare_accesses(frame.graph, pass, textures);
  const auto [offset_x, offset_y] =
      interleave_offset_of(inputs.raw_occlusion.tile_size, frame.index);
  maths::ReconstructParameters parameters =
      parameters_of(frame, *projection, *previous, inputs, settings);
  const float window = window_px(inputs.raw_occlusion);
  parameters.inverse_squared_window = 0.125f / (window * window);
  // Distances from the plane count for more with the slices, as the window narrows with them.
  parameters.tolerance *= std::sqrt(static_cast<float>(inputs.raw_occlusion.slices));
  // Nothing changes, so all frames count alike.
  if (past == Past::unchanged && frame.static_frames >= kConvergedFrames) {
    parameters.largest_weight = static_cast<float>(maths::kMaxHistoryFrames) - 1.0f;
  }
  const VkExtent2D half_size{(sizes->now.width + 1) / 2, (sizes->now.height + 1) / 2};
  const VkExtent3D stored =
      textures.history.next ? frame.graph.extent(textures.history.next) : VkExtent3D{1, 1, 1};
  parameters.history_texel = 1.0f / maths::vec2(stored.width, stored.height);
  // One more texel at the right and the lower border, if the textures have room for it, since the
  // upsampling pass reads it.
  const VkExtent3D half_extent{std::min(half_size.width + 1, stored.width),
                               std::min(half_size.height + 1, stored.height), 1};
  parameters.interleave_pixel = {offset_x, offset_y};
  parameters.interleave_offset = maths::vec2(parameters.interleave_pixel);
  parameters.traced_range = traced_range(projection->size_px, parameters.interleave_offset,
                                         static_cast<float>(inputs.raw_occlusion.tile_size));
  pass.record([&kernels = frame.kernels, kernel = *kernel, textures, parameters,
               half_extent](RecordContext& context) {
    const Bindings bindings = bindings_of(context, textures);
    const std::span<const VkImageView> bound(bindings.views.data(), bindings.count);
    kernels.dispatch(context, kernel, bound, bytes_of(parameters),
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
                       .normals_forward_z = inputs.normals_forward_z},
                      textures.result, settings);
}

void drop_reconstruct_history(Graph& graph, std::string_view history_name) {
  graph.drop_history(history_name);
  graph.drop_history(DerivedHistoryName(history_name, kDepthSuffix));
  graph.drop_history(DerivedHistoryName(history_name, kBentSuffix));
  graph.drop_history(DerivedHistoryName(history_name, kLobeSuffix));
}

}  // namespace alcove::passes

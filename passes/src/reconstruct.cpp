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
#include "view_parameters.h"
#include "write_result.h"

namespace alcove::passes {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using framegraph::TextureHistory;

namespace {

// Still frames after which every pixel of a block of 4 has been searched once.
constexpr std::uint32_t kConvergedFrames = 16;

// What lies before a frame: all that its pipeline depends on besides settings, inputs and the kind
// of projection.
enum class Past : std::uint8_t {
  none,  // no history, or none that can be read
  moving,
  still,    // the frame before shows the very same
  settled,  // as do kConvergedFrames
};

// The history of bent normals that goes with one of this name. On the stack, so that a steady frame
// allocates nothing for it.
class BentHistoryName {
 public:
  explicit BentHistoryName(std::string_view history_name) {
    constexpr std::string_view kAfter = " bent normal";
    text_.reserve(history_name.size() + kAfter.size());
    text_.append(history_name).append(kAfter);
  }
  operator std::string_view() const { return text_; }

 private:
  std::array<std::byte, 128> room_;
  std::pmr::monotonic_buffer_resource memory_{room_.data(), room_.size()};
  std::pmr::string text_{&memory_};
};

// All that the pass touches; null where it is not wanted.
struct Textures {
  ReconstructInputs inputs;
  Occlusion result;
  Texture history;
  Texture next_history;  // the history where that is updated in place, as with the bent one
  Texture bent_history;
  Texture next_bent_history;
};

// Declares the histories; `valid` is whether last frame's can be read. One that is not wanted now
// is old by the time that it is wanted again.
void create_histories(Graph& graph, const ReconstructSettings& settings,
                      std::string_view history_name, framegraph::Extent largest, Textures& textures,
                      bool& valid) {
  const BentHistoryName bent_name(history_name);
  const bool wanted = settings.history_frames > 0;
  const bool bent_wanted = wanted && textures.inputs.raw_occlusion.bent;
  if (!wanted) {
    graph.reset_history(history_name);
  }
  if (!bent_wanted) {
    graph.reset_history(bent_name);
  }
  if (wanted) {
    const TextureHistory history = graph.create_texture_history(
        history_name, {raw_format(textures.inputs.raw_occlusion.lobe), largest});
    valid = history.validity == framegraph::HistoryValidity::valid;
    textures.history = history.previous();
    textures.next_history = history.current;
  }
  if (bent_wanted) {
    const TextureHistory bent =
        graph.create_texture_history(bent_name, {VK_FORMAT_R16G16B16A16_SFLOAT, largest});
    valid = valid && bent.validity == framegraph::HistoryValidity::valid;
    textures.bent_history = bent.previous();
    textures.next_bent_history = bent.current;
  }
}

// Declares the textures that the pass writes. `valid` is whether last frame's history can be read.
Textures create_textures(const Frame& frame, const ReconstructInputs& inputs,
                         const ReconstructSettings& settings, const ReconstructSizes& sizes,
                         std::string_view history_name, bool& valid) {
  Graph& graph = frame.graph;
  const auto size = framegraph::Extent::absolute(sizes.now.width, sizes.now.height);
  const auto largest = framegraph::Extent::absolute(sizes.largest.width, sizes.largest.height);
  Textures textures{.inputs = inputs};
  if (settings.visibility) {
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
  return textures;
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
  read(textures.inputs.inverse_depth, stored);
  read(textures.inputs.normals, sampled);
  read(textures.inputs.motion, sampled);
  read(textures.inputs.roughness, sampled);
  write(textures.result.visibility);
  write(textures.result.bent_normal);
  write(textures.result.specular);
  const auto declare_history = [&](Texture& history, Texture& next) {
    if (!history) {
      return;
    }
    if (next == history) {
      history = next = pass.write(history, framegraph::access::storage_read_write_compute);
      return;
    }
    pass.read(history, stored);
    write(next);
  };
  declare_history(textures.history, textures.next_history);
  declare_history(textures.bent_history, textures.next_bent_history);
}

// As many as the shader can have.
struct Bindings {
  std::array<VkImageView, 13> views{};
  std::size_t count = 0;

  void add(std::initializer_list<VkImageView> more) {
    for (const VkImageView view : more) {
      views.at(count++) = view;
    }
  }
};

// A result that is wanted.
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
  Bindings bindings;
  bindings.add({context.view(in.raw_occlusion.raw_occlusion),
                view_or(context, in.raw_occlusion.bent, in.raw_occlusion.raw_occlusion),
                context.view(in.inverse_depth), context.view(in.normals),
                view_or(context, out.visibility, written),
                view_or(context, out.bent_normal, written)});
  if (textures.history) {
    bindings.add({view_or(context, in.motion, in.normals), context.view(textures.history),
                  view_or(context, textures.bent_history, in.inverse_depth),
                  context.view(textures.next_history),
                  view_or(context, textures.next_bent_history, written)});
  }
  if (in.raw_occlusion.lobe) {
    bindings.add({view_or(context, in.roughness, in.normals), context.view(out.specular)});
  }
  return bindings;
}

Shader shader_of(bool history, bool lobe) {
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
  return frame.static_frames >= kConvergedFrames ? Past::settled : Past::still;
}

// Whether a pixel reads no history but its own.
bool is_static(Past past) { return past == Past::still || past == Past::settled; }

// Of the shader, in its order.
std::array<std::uint32_t, 14> constants_of(const ReconstructInputs& inputs,
                                           const ReconstructSettings& settings, bool perspective,
                                           Past past) {
  return {inputs.raw_occlusion.tile_size,
          settings.filter_radius,
          flag(bool(inputs.raw_occlusion.bent)),
          flag(inputs.motion && past == Past::moving),
          flag(perspective),
          flag(settings.clamp_width > 0.0f),
          flag(is_static(past)),
          flag(bool(inputs.roughness)),
          channel_if(bool(inputs.roughness), settings.roughness_channel),
          flag(past == Past::none),
          flag(settings.visibility),
          flag(past == Past::settled),
          static_cast<std::uint32_t>(inputs.normal_encoding),
          flag(settings.power != 1.0f || settings.intensity != 1.0f)};
}

tl::expected<Kernel, Error> get_kernel(const Frame& frame, const ReconstructInputs& inputs,
                                       const ReconstructSettings& settings, bool perspective,
                                       Past past) {
  const bool history = settings.history_frames > 0;
  const auto get = [&](Past of) {
    return frame.kernels.get(shader_of(history, inputs.raw_occlusion.lobe),
                             constants_of(inputs, settings, perspective, of));
  };
  if (history && frame.prepare) {
    for (const Past each : {Past::none, Past::moving, Past::still, Past::settled}) {
      if (auto made = get(each); !made) {
        return made;
      }
    }
  }
  return get(past);
}

// View-space positions from (x s, y s, depth, 1), as ReconstructParameters::previous_from_pixel has
// them.
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

// Scale and offset for maths::held_depth(). A perspective's near plane is at the least half of full
// precision, 2^-14; an orthographic view, whose depths may begin anywhere, is held from its near
// plane to its far plane. Powers of two, so that no digit is lost.
maths::vec2 history_depth(const maths::Projection& p) {
  constexpr float kLeast = 1e-30f;
  const float near = p.near_far.x;
  if (is_perspective(p)) {
    return {std::ldexp(1.0f, -14 - std::ilogb(std::max(near, kLeast))), 0.0f};
  }
  const float scale = std::ldexp(1.0f, 14 - std::ilogb(std::max(p.near_far.y - near, kLeast)));
  return {scale, -near * scale};
}

// The width of the window over one frame's searches: few slices are filtered far, many hardly
// further than the blocks lie apart. By the error of first frames (`alcove compare --frames 1`).
float window_px(const RawOcclusionTextures& raw_occlusion) {
  const float few = 1.1f / std::sqrt(static_cast<float>(raw_occlusion.slices));
  return static_cast<float>(raw_occlusion.tile_size) * std::max(few, 0.55f);
}

maths::ReconstructParameters parameters_of(const Frame& frame, const maths::Projection& projection,
                                           const maths::Projection& previous,
                                           const ReconstructInputs& inputs,
                                           const ReconstructSettings& settings) {
  const maths::mat4 from_pixel = view_from_pixel(projection);
  // In double: far from the world's origin the two all but cancel.
  const maths::dmat4 to_previous = to_rigid(frame.previous_view.view_from_world) *
                                   maths::inverse(to_rigid(frame.view.view_from_world));
  const maths::mat4 to_view =
      view_from_normal(frame, inputs.normals_in_view_space, inputs.normals_forward_z);
  maths::ReconstructParameters parameters{};
  parameters.previous_from_pixel =
      maths::mat4(maths::dmat4(pixel_from_view(previous)) * to_previous * maths::dmat4(from_pixel));
  parameters.normal_from_view = maths::transpose(to_view);
  parameters.before_from_view = maths::mat4(maths::mat3(maths::mat4(to_previous)));
  parameters.slope = maths::vec4(maths::ray_per_px(projection), projection.uv_to_slope.z,
                                 projection.uv_to_slope.w);
  parameters.tolerance =
      1.0f / (settings.filter_tolerance_px * std::abs(maths::ray_per_px(projection).y));
  parameters.longest = static_cast<float>(settings.history_frames);
  parameters.clamp_width = settings.clamp_width;
  parameters.previous_size = maths::vec4(previous.size_px, previous.size_px / projection.size_px);
  parameters.history_depth = maths::vec4(history_depth(projection), history_depth(previous));
  const MotionConvention& motion = inputs.motion_convention;
  parameters.motion =
      maths::vec4(maths::vec2(motion.scale[0], motion.scale[1]) * previous.size_px,
                  maths::vec2(motion.offset[0], motion.offset[1]) * previous.size_px);
  parameters.roughness = settings.roughness;
  parameters.power = settings.power;
  parameters.intensity = settings.intensity;
  return parameters;
}

// An invocation has a cell of pixels between the searched ones, of which there is one more than of
// blocks, since the outermost stick out of the image. A search of every pixel leaves nothing
// between.
VkExtent3D cells_of(VkExtent3D size, std::uint32_t tile_size) {
  if (tile_size == 1) {
    return size;
  }
  return {(size.width + tile_size - 1) / tile_size + 1,
          (size.height + tile_size - 1) / tile_size + 1, 1};
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
                                               const ReconstructSettings& settings,
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
  const auto sizes = reconstruct_sizes(frame, inputs.inverse_depth);
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
  const auto kernel = get_kernel(frame, inputs, settings, is_perspective(*projection), past);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  if (is_static(past)) {
    textures.next_history = textures.history;
    textures.next_bent_history = textures.bent_history;
  }
  auto pass = frame.graph.add_pass("reconstruct");
  declare_accesses(frame.graph, pass, textures);
  const auto [phase_x, phase_y] = interleave_offset_of(inputs.raw_occlusion.tile_size, frame.index);
  maths::ReconstructParameters parameters =
      parameters_of(frame, *projection, *previous, inputs, settings);
  parameters.window_px = window_px(inputs.raw_occlusion);
  // Distances from the plane count for more with the slices, as the window narrows with them.
  parameters.tolerance *= std::sqrt(static_cast<float>(inputs.raw_occlusion.slices));
  if (past == Past::settled) {  // nothing to follow: all frames count alike
    parameters.longest = static_cast<float>(maths::kMaxHistoryFrames);
  }
  parameters.interleave_offset =
      maths::vec2(static_cast<float>(phase_x), static_cast<float>(phase_y));
  pass.record([&kernels = frame.kernels, kernel = *kernel, textures, parameters,
               tile_size = inputs.raw_occlusion.tile_size](RecordContext& context) {
    const Bindings bindings = bindings_of(context, textures);
    const std::span<const VkImageView> bound(bindings.views.data(), bindings.count);
    kernels.dispatch(context, kernel, bound, bytes_of(parameters),
                     cells_of(context.extent(textures.inputs.inverse_depth), tile_size));
  });
  return textures.result;
}

void drop_reconstruct_history(Graph& graph, std::string_view history_name) {
  graph.drop_history(history_name);
  graph.drop_history(BentHistoryName(history_name));
}

}  // namespace alcove::passes

#include "work/reconstruct_uniforms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "maths/slice_line.h"
#include "work/bindings.h"
#include "work/interleave_offset.h"

namespace alcove::passes {
namespace {

// The largest range of depths that the history of a perspective view distinguishes, in octaves
// (factors of two) from the near plane on. 13 bits then resolve a relative change of depth of
// 2^-9.5. The resolution is finer if the far plane is nearer than that. All surfaces farther away
// than 65,536 times the distance of the near plane have the same depth in the history.
constexpr float kLargestDepthOctaves = 16.0f;

// The largest power of two that is no larger than the near plane's distance.
float history_unit(const maths::Projection& p) {
  constexpr float kLeast = 1e-30f;
  return std::ldexp(1.0f, std::ilogb(std::max(p.near_far.x, kLeast)));
}

// Returns scale and offset for maths::history_depth(), which stores depths between the near and the
// far plane: the logarithm of depth in perspective views, and depth itself in orthographic views.
maths::vec2 history_depth_scale(const maths::Projection& p) {
  constexpr float kLeast = 1e-30f;
  const float near = p.near_far.x;
  const float far = p.near_far.y;
  if (p.perspective) {
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

// The error of a stored depth: half a step of its 13 bits, plus the rounding of its computation.
constexpr float kHistorySlack = 0.75f / 8191.0f;

// Returns the relative difference of depth from the tangent plane at which a history texel's weight
// reaches 0 in perspective views. It is 1.5 texels, but at most 0.3 % of the depth, and at least
// 0.13 %, which is about the step of a stored depth. ReconstructParameters::history_sharpness is
// computed from it.
float relative_history_distance(float texel) { return std::clamp(1.5f * texel, 0.0013f, 0.003f); }

float history_sharpness(const maths::Projection& p, maths::vec2 scale) {
  const float pixel = std::abs(p.ray_per_px().y);
  if (p.perspective) {
    // A relative change of depth by e changes the stored depth by e * scale / ln 2.
    constexpr float kLn2 = 0.69314718f;
    return kLn2 / (relative_history_distance(pixel) * scale.x);
  }
  return 1.0f / std::max(1.5f * pixel * scale.x, 2.0f * kHistorySlack);
}

// The error of the depth of a texel at half resolution, relative to the distance at which its
// weight reaches 0. The depth is stored with a relative error of 2^-15.
constexpr float kHalfHistorySlack = 0.03f;

// Returns ReconstructParameters::history_sharpness at half resolution, where depths are stored
// unscaled: the reciprocal of the change of depth at which a history texel's weight reaches 0. The
// change is relative in perspective views and in scene units in orthographic views.
float half_history_sharpness(const maths::Projection& p) {
  const float texel = 2.0f * std::abs(p.ray_per_px().y);
  const float rounding = 0x1p-14f * std::abs(p.near_far.y);
  return 1.0f /
         (p.perspective ? relative_history_distance(texel) : std::max(1.5f * texel, rounding));
}

// Returns the value of ReconstructParameters::plane_from_normal.
maths::mat4 plane_from_normal(const maths::Projection& p, const maths::mat4& view_from_normal) {
  const maths::mat3 plane_from_view = maths::transpose(maths::mat3(p.view_from_pixel));
  return maths::mat4(maths::transpose(plane_from_view * maths::mat3(view_from_normal)));
}

// Returns 1 / ReconstructParameters::wide_sharpness. The four traced pixels around a pixel are
// needed less the more slices each of them has. A static image averages ever more frames, which
// make the samples of neighbours dispensable. Fitted to the error that `alcove compare --frames 8`,
// 24 and 32, with and without --orbit, prints, and to the noise that its pictures show.
float near_sharpness(const ViewInputs& view, bool is_static, float texel) {
  if (!is_static) {
    const float one_slice = texel > 1.0f ? 1.0f : 1.3f;
    return view.settings.slices > 1 ? 1.7f : one_slice;
  }
  const auto frames = static_cast<float>(view.static_frames);
  return std::lerp(0.8f, 2.2f, std::clamp((frames - 8.0f) / 16.0f, 0.0f, 1.0f));
}

// Returns the filter's smallest window in units of 8 squared pixels: x at the centre of a texel of
// the history, and y what the distance from centres adds, because the interpolation of the history
// blurs there anyway. With tiles of 4 texels few samples are a texel's own even in time, so the
// window stays wider. With one slice, whose noise is large, it then widens more between centres: a
// surface that moves over the image meets other directions in each frame than the pattern has
// prepared for one pixel. Fitted to the error that `alcove compare --orbit 0.4` prints, and to the
// noise that its pictures show.
maths::vec2 smallest_window(const AlcoveSettings& settings, float texel) {
  const bool wide = static_cast<float>(settings.tile_size) > 2.0f * texel;
  const float own = wide ? 1.45f : 0.58f;
  const float between = wide && settings.slices == 1 ? 10.4f : 2.6f;
  return 8.0f * texel * texel * maths::vec2(own * own, between);
}

// Returns the width of the filter's window in pixels for a frame without history: wide if there are
// few slices, and with many slices hardly wider than a tile. Fitted to the error of first frames
// (`alcove compare --frames 1`).
float window_px(const AlcoveSettings& settings) {
  const float few = 1.1f / std::sqrt(static_cast<float>(settings.slices));
  return static_cast<float>(settings.tile_size) * std::max(few, 0.55f);
}

// The second difference of depth, in units of the tolerance, up to which a tangent plane is
// computed from depth instead of the normal. Fitted to the errors of `alcove compare`.
constexpr float kLargestBend = 0.05f;

// Returns ReconstructParameters::traced_range: the positions of the first and the last traced
// pixel. The tiles at the right and lower border trace their last pixel within the image if the
// interleave offset lies outside of it.
maths::vec4 traced_range(maths::vec2 size_px, maths::vec2 offset, float tile_size) {
  const maths::vec2 last = maths::ceil(size_px / tile_size) * tile_size - tile_size + offset;
  const maths::vec2 largest = maths::min(last, size_px - 1.0f);
  return maths::vec4(maths::min(offset, largest), largest);
}

// The distance from a pixel's tangent plane at which the filter gives a neighbour a quarter of the
// full weight, in units of a pixel's width at its depth, with one slice and no history. Fitted to
// the errors of `alcove compare`.
constexpr float kFilterTolerancePx = 1.5f;

}  // namespace

maths::ReconstructParameters reconstruct_parameters(const ViewInputs& view,
                                                    const PreviousFrame& from) {
  const AlcoveViewInfo& info = view.info;
  const AlcoveSettings& settings = view.settings;
  const maths::Projection& projection = view.projection;
  const maths::Projection& previous = from.projection;
  // This matrix is computed in double, because the translations nearly cancel if the camera is far
  // from the origin.
  const maths::dmat4 to_previous =
      to_rigid(from.camera.view_from_world) * maths::inverse(to_rigid(info.camera.view_from_world));
  const maths::mat4 to_view = view_from_normal(info.camera, normals_of(view));
  maths::ReconstructParameters parameters{};
  const maths::mat4 previous_from_pixel =
      maths::transpose(maths::mat4(maths::dmat4(previous.pixel_from_view) * to_previous *
                                   maths::dmat4(projection.view_from_pixel)));
  const float texel = settings.half_resolution != 0 ? 2.0f : 1.0f;
  // From pixels to texels, from the centre of the first one.
  const maths::vec4 x = previous_from_pixel[0] / texel - 0.5f * previous_from_pixel[3];
  const maths::vec4 y = previous_from_pixel[1] / texel - 0.5f * previous_from_pixel[3];
  parameters.previous_from_pixel =
      maths::transpose(maths::mat4(x, y, previous_from_pixel[3], previous_from_pixel[2]));
  if (!projection.perspective)
    std::swap(parameters.previous_from_pixel[2], parameters.previous_from_pixel[3]);
  parameters.normal_from_view = maths::transpose(to_view);
  parameters.plane_from_normal = plane_from_normal(projection, to_view);
  parameters.previous_from_view = maths::mat4(maths::mat3(maths::mat4(to_previous)));
  parameters.slope = projection.slope();
  // More slices reduce the distance from the tangent plane that is tolerated.
  parameters.tolerance = std::sqrt(static_cast<float>(settings.slices)) /
                         (kFilterTolerancePx * std::abs(projection.ray_per_px().y));
  parameters.largest_weight = static_cast<float>(settings.history_frames) - 1.0f;
  // The distances between the borders of the area that is read and those of the area that is
  // written were the same in the previous frame.
  set_areas(parameters, view);
  const maths::vec2 beyond =
      projection.size_px - 1.0f - maths::vec2(parameters.written.z, parameters.written.w);
  parameters.previous_extent = maths::vec4(maths::ceil((previous.size_px - beyond) / texel) - 1.0f,
                                           previous.size_px / projection.size_px / texel);
  parameters.pixel_uv = 1.0f / projection.size_px;
  parameters.inverse_depth_from_ndc = projection.inverse_depth_from_ndc;
  parameters.pixels_per_slope = 1.0f / projection.ray_per_px();
  parameters.history_depth_scale =
      maths::vec4(history_depth_scale(projection), history_depth_scale(previous));
  parameters.history_unit = history_unit(projection);
  if (previous.perspective) {
    // The difference of the units' logarithms is exact, because the units are powers of two.
    parameters.history_depth_scale.w +=
        parameters.history_depth_scale.z * static_cast<float>(std::ilogb(history_unit(previous)) -
                                                              std::ilogb(history_unit(projection)));
  }
  if (settings.half_resolution != 0) {
    parameters.history_sharpness = half_history_sharpness(projection);
    parameters.history_slack = kHalfHistorySlack;
  } else {
    parameters.history_sharpness = history_sharpness(projection, history_depth_scale(previous));
    parameters.history_slack = kHistorySlack * parameters.history_sharpness;
  }
  parameters.history_slope = parameters.history_depth_scale.z * parameters.history_sharpness *
                             (projection.perspective ? 1.442695f : 1.0f);
  // The dither offsets of the frames are multiples of the golden ratio modulo 1, which are spread
  // evenly over any number of successive frames.
  parameters.dither_offset = static_cast<float>(view.index * 2654435769u) * 0x1p-32f;
  const MotionConvention motion = motion_of(info);
  parameters.motion = maths::vec4(
      maths::vec2(motion.scale[0], motion.scale[1]) * previous.size_px / texel,
      maths::vec2(motion.offset[0], motion.offset[1]) * previous.size_px / texel + 0.5f);
  parameters.roughness = settings.roughness;
  const float window = window_px(settings);
  // With tiles, each pixel averages the traced pixels around it, as kBetween of the shader.
  const float sharpness = settings.tile_size > 1 ? near_sharpness(view, from.is_same, texel) : 1.0f;
  parameters.wide_sharpness = 1.0f / sharpness;
  parameters.first_sharpness = sharpness * 0.125f / (window * window);
  parameters.smallest_window = smallest_window(settings, texel) / sharpness;
  const auto [offset_x, offset_y] = interleave_offset_of(settings.tile_size, view.index);
  parameters.interleave_pixel = {offset_x, offset_y};
  parameters.traced_range =
      traced_range(projection.size_px, maths::vec2(parameters.interleave_pixel),
                   static_cast<float>(settings.tile_size));
  const float scale = parameters.inverse_depth_from_ndc.x;
  const float per_ndc = std::abs(scale);
  const bool from_zero = maths::is_counted_from_zero(projection.perspective, projection.reversed);
  parameters.half_inverse_depth_per_ndc = from_zero ? 0.5f * scale : -0.5f * scale;
  parameters.depth_step =
      std::max(depth_step(projection, view.depth_format).constant, 0.0f) / per_ndc;
  parameters.largest_bend = kLargestBend / (per_ndc * parameters.tolerance);
  parameters.power = settings.power;
  parameters.intensity = settings.intensity;
  return parameters;
}

}  // namespace alcove::passes

// Frames with their matrices, under hypotheses of how inputs are meant. inspect() compares them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "diagnose/inspect.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using maths::dmat4;
using maths::dvec2;
using maths::dvec3;
using maths::dvec4;

// The least number of samples from which a mistake is concluded.
inline constexpr std::size_t kEnoughSamples = 100;
// The least number of samples of some kind, for example of one direction, among enough samples.
inline constexpr std::size_t kEnoughOfSome = 12;
// The share of the samples that are at the same place, at most, if cameras do not fit.
inline constexpr double kMisfits = 0.5;
// The largest jitter of a camera from one frame to the next, in pixels.
inline constexpr double kLargestJitter = 1.5;

// A hypothesis of how the inputs are meant.
struct Reading {
  NormalConvention normals;
  bool transposed_normals = false;   // rotated by world_from_view instead of view_from_world
  dvec2 tangent_scale = dvec2(1.0);  // of the tangents of half the angles of view
  double far_shift = 0.0;            // added to all inverse distances, as by another far plane
  bool invert_view = false;          // view_from_world is world_from_view
  bool whole_image = false;          // the whole image is in use
  bool at_bottom = false;            // the part of the image that is in use is the lowest
};

inline bool is_sky(float depth) { return !(depth > 0.0f && depth < 1.0f); }

// Returns the value that a fraction `share`, 0 to 1, of the values does not exceed.
inline double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values.size()) * share);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Returns the mean, or 0 if there are no values.
inline double mean(const std::vector<double>& values) {
  const double count = static_cast<double>(std::max(values.size(), std::size_t{1}));
  return std::accumulate(values.begin(), values.end(), 0.0) / count;
}

template <typename Values, typename Predicate>
double share_of(const Values& values, const Predicate& predicate) {
  return values.empty() ? 0.0
                        : static_cast<double>(std::ranges::count_if(values, predicate)) /
                              static_cast<double>(values.size());
}

inline dvec2 to_vector(VkExtent2D size) { return {size.width, size.height}; }

inline bool is_smaller(VkExtent2D size, VkExtent2D than) {
  return size.width < than.width || size.height < than.height;
}

// The matrices of a frame and the size of its image under a hypothesis.
struct Eye {
  dmat4 clip_from_view;
  dmat4 view_from_world;
  dvec2 size;
  dvec2 origin = dvec2(0.0);  // of the picture in the image, in pixels

  dvec2 ndc(const PixelSample& s) const {
    return 2.0 * (dvec2(s.x + 0.5, s.y + 0.5) - origin) / size - 1.0;
  }
  dvec2 pixel(const dvec4& clip) const {
    return (0.5 * dvec2(clip) / clip.w + 0.5) * size + origin;
  }
};

// A frame with its matrices, and the gradients of depth at its samples.
class Picture {
 public:
  explicit Picture(const InspectedFrame& of)
      : frame(of),
        clip_from_view(to_mat4(of.info.camera.clip_from_view)),
        view_from_clip(maths::inverse(clip_from_view)),
        view_from_world(to_rigid(of.info.camera.view_from_world)),
        perspective(of.info.camera.clip_from_view[15] == 0.0f) {
    gradients.reserve(of.samples.size());
    for (const PixelSample& sample : of.samples) gradients.push_back(gradient(sample));
  }

  Eye eye(const Reading& reading) const {
    Eye eye{clip_from_view, reading.invert_view ? maths::inverse(view_from_world) : view_from_world,
            to_vector(reading.whole_image ? frame.depth_size : frame.size)};
    for (int column = 0; column < 4; ++column) {
      eye.clip_from_view[column][0] /= reading.tangent_scale.x;
      eye.clip_from_view[column][1] /= reading.tangent_scale.y;
    }
    if (reading.at_bottom) eye.origin.y = to_vector(frame.depth_size).y - to_vector(frame.size).y;
    eye.clip_from_view[2][2] += reading.far_shift * clip_from_view[3][2];
    return eye;
  }

  // The distance from the eye along the view axis.
  double distance(double depth) const {
    const dvec4 p = view_from_clip * dvec4(0.0, 0.0, depth, 1.0);
    return -p.z / p.w;
  }

  // The shift of the image by the jitter, in pixels.
  dvec2 jitter() const {
    const dvec4 axis = clip_from_view * dvec4(0.0, 0.0, -1.0, 1.0);
    return 0.5 * dvec2(axis) / axis.w * to_vector(frame.size);
  }

  // The largest step between neighbouring values of the format near this depth.
  double depth_step(float depth) const {
    switch (frame.depth_format) {
      case VK_FORMAT_D16_UNORM:
      case VK_FORMAT_D16_UNORM_S8_UINT:
        return 1.0 / 65535.0;
      case VK_FORMAT_X8_D24_UNORM_PACK32:
      case VK_FORMAT_D24_UNORM_S8_UINT:
        return 1.0 / 16777215.0;
      default:
        return depth * 0x1p-23;
    }
  }

  const InspectedFrame& frame;
  dmat4 clip_from_view;
  dmat4 view_from_clip;
  dmat4 view_from_world;
  bool perspective;
  std::vector<std::optional<dvec2>> gradients;

 private:
  // Returns the gradient of depth per pixel, or nothing if the surface is not smooth there. Depth
  // is linear in screen space on a plane, so a pixel whose depth is not linear among its neighbours
  // is left out.
  std::optional<dvec2> gradient(const PixelSample& s) const {
    const double step = depth_step(s.depth);
    const auto is_line = [&](float before, float after) {
      const double second = double{before} + after - 2.0 * double{s.depth};
      return !is_sky(before) && !is_sky(after) &&
             std::abs(second) <= 0.02 * std::abs(double{after} - before) + 2.0 * step;
    };
    const dvec2 last = to_vector(frame.size) - 1.0;
    const bool inside = s.x > 0.0f && s.y > 0.0f && s.x < last.x && s.y < last.y;
    if (!inside || is_sky(s.depth) || !is_line(s.left, s.right) || !is_line(s.up, s.down))
      return std::nullopt;
    return 0.5 * dvec2(double{s.right} - s.left, double{s.down} - s.up);
  }
};

// Calls `call` with each hypothesis about the camera of a picture.
template <typename Call>
void for_cameras(const Picture& picture, const Reading& given, const Call& call) {
  Reading reading = given;
  reading.invert_view = true;
  call(&mistakes::view_inverted, reading);
  reading = given;
  if (is_smaller(picture.frame.size, picture.frame.depth_size)) {
    reading.whole_image = true;
    call(&mistakes::image_too_large, reading);
    reading = given;
    reading.at_bottom = true;
    call(&mistakes::image_at_bottom, reading);
  }
  reading = given;
  for (const dvec2& sign : {dvec2(1.0, -1.0), dvec2(-1.0, 1.0)}) {
    reading.tangent_scale = sign;
    call(&mistakes::flipped, reading);
  }
  if (!picture.perspective) return;
  // Factors by which the tangents of half the angles of view may be wrong.
  for (double scale = 0.25; scale < 4.2; scale *= 1.05) {
    if (std::abs(std::log(scale)) < 0.05) continue;
    const bool is_aspect = scale > 0.5 && scale < 2.0;
    for (const dvec2& scales : {dvec2(scale), dvec2(scale, 1.0), dvec2(1.0, scale)}) {
      reading.tangent_scale = scales;
      if (is_aspect || scales.x == scales.y) call(&mistakes::field_of_view, reading);
    }
  }
  std::vector<double> distances;
  for (const PixelSample& s : picture.frame.samples)
    if (!is_sky(s.depth)) distances.push_back(picture.distance(s.depth));
  if (distances.empty()) return;
  reading = given;
  for (double shift = -0.9; shift < 3.0; shift += 0.1) {
    reading.far_shift = shift / quantile(distances, 0.5);
    call(&mistakes::field_of_view, reading);
  }
}

// What depth of successive frames says of the cameras.
struct CameraFit {
  const Mistake* mistake = nullptr;
  double measure = 0.0;  // the number of the mistake's sentence
  double share = 0.0;    // of the samples that lie where the cameras expect them
};

// `pictures` begins with the frame that is inspected, followed by one or two earlier frames, and
// `given` is how their inputs are described.
// `fits_normals` returns whether the normals fit depth under another reading as well.
CameraFit fit_cameras(const std::vector<Picture>& pictures, const Reading& given,
                      const std::function<bool(const Reading&)>& fits_normals);
// Returns the share of the samples that lie where the cameras expect them, or 0 if they are few.
double share_explained(const std::vector<Picture>& pictures, const Reading& reading);
// Returns the mistake of the motion vectors, or null if there is none, or nothing if the cameras do
// not fit or do not move. `share` is that of fit_cameras().
std::optional<const Mistake*> mistake_of_motion(const std::vector<Picture>& pictures,
                                                const Reading& given, double share);

}  // namespace alcove::passes

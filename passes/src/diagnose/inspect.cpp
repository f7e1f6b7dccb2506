#include "diagnose/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "inspect_parameters.h"
#include "maths/normal_encoding.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using maths::dmat4;
using maths::dvec2;
using maths::dvec3;
using maths::dvec4;
using maths::kInspectColumns;
using maths::kInspectRows;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
// The least number of samples from which a mistake is concluded.
constexpr std::size_t kEnoughSamples = 100;
// The least number of samples of some kind, for example of one direction, among enough samples.
constexpr std::size_t kEnoughOfSome = 12;

// Limits for the comparison of the angles to the view axis.
constexpr double kSameAngleAboutAxis = 0.966;  // cosine of 15 degrees about the view axis
constexpr double kStoredError = 0.002;  // of stored normals, radians: that of 10 bits a channel
constexpr double kRatioError = 0.05;    // of the tangents' ratio at one sample
constexpr double kOblique = 0.3;        // half the sine of twice the angle: 18 to 72 degrees
constexpr double kLeastScale = 0.14;    // logarithm of 1.15, below which a scale is not reported
constexpr double kLargestSpread = 0.5;  // between the quartiles of the ratios' logarithms

// Limits for the comparison of successive frames.
constexpr double kSamePlace = 0.15;     // pixels
constexpr double kLargestJitter = 1.5;  // pixels, from one frame to the next
constexpr double kFits = 0.75;          // the share of the samples at the same place if cameras fit
constexpr double kMisfits = 0.5;        // the share at most if they do not

// A hypothesis of how the inputs are meant.
struct Reading {
  std::uint32_t encoding = 0;  // of normals
  bool in_view_space = false;
  bool forward_z = false;
  bool flip_y = false;
  bool invert_view = false;        // view_from_world is world_from_view
  bool whole_image = false;        // the whole image is in use
  double tangent_scale = 1.0;      // of the tangents of half the angles of view
  double translation_scale = 1.0;  // of the camera's way from frame to frame
};

bool is_sky(float depth) { return !(depth > 0.0f && depth < 1.0f); }

// Returns the value that a fraction `share`, 0 to 1, of the values does not exceed.
double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values.size()) * share);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <typename Values, typename Predicate>
double share_of(const Values& values, const Predicate& predicate) {
  return values.empty() ? 0.0
                        : static_cast<double>(std::ranges::count_if(values, predicate)) /
                              static_cast<double>(values.size());
}

// Returns true if a number has at most so many significant digits, as near planes that people type.
bool is_round(double value, double digits) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    return false;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - (digits - 1.0));
  const double whole = value / unit;
  return std::abs(whole - std::round(whole)) <= 3e-7 * whole;
}

// Returns the angle between two normals in degrees, 0 to 90. Either may face away.
double angle_between(const dvec3& a, const dvec3& b) {
  const double length = maths::length(a) * maths::length(b);
  const double cosine = length > 0.0 ? std::abs(maths::dot(a, b)) / length : 0.0;
  return std::acos(std::min(cosine, 1.0)) * kDegrees;
}

dvec2 to_vector(VkExtent2D size) { return {size.width, size.height}; }

// A frame with its matrices, and the gradients of depth at its samples.
class Picture {
 public:
  explicit Picture(const InspectedFrame& of)
      : frame(of),
        clip_from_view(to_mat4(of.view.clip_from_view)),
        view_from_clip(maths::inverse(clip_from_view)),
        view_from_world(to_rigid(of.view.view_from_world)),
        perspective(of.view.clip_from_view[15] == 0.0f) {
    gradients.reserve(of.samples.size());
    for (const PixelSample& sample : of.samples) {
      gradients.push_back(gradient(sample));
    }
  }

  // The distance from the eye along the view axis.
  double distance(double depth) const {
    const dvec4 p = view_from_clip * dvec4(0.0, 0.0, depth, 1.0);
    return -p.z / p.w;
  }

  dvec2 size(const Reading& reading) const {
    return to_vector(reading.whole_image ? frame.depth_size : frame.size);
  }
  dvec2 ndc(const PixelSample& s, const Reading& reading) const {
    return 2.0 * dvec2(s.x + 0.5, s.y + 0.5) / size(reading) - 1.0;
  }
  dmat4 clip_from_view_by(const Reading& reading) const {
    dmat4 clip = clip_from_view;
    for (int column = 0; column < 4; ++column) {
      clip[column][0] /= reading.tangent_scale;
      clip[column][1] /= reading.flip_y ? -reading.tangent_scale : reading.tangent_scale;
    }
    return clip;
  }
  dmat4 view_by(const Reading& reading) const {
    return reading.invert_view ? maths::inverse(view_from_world) : view_from_world;
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
    const bool inside =
        s.x > 0 && s.y > 0 && s.x + 1 < frame.size.width && s.y + 1 < frame.size.height;
    if (!inside || is_sky(s.depth) || !is_line(s.left, s.right) || !is_line(s.up, s.down)) {
      return std::nullopt;
    }
    return 0.5 * dvec2(double{s.right} - s.left, double{s.down} - s.up);
  }
};

// Returns the normal, in view space and towards the eye, of the plane on which depth has a
// gradient. It is not normalised.
dvec3 plane_normal(const Picture& picture, const PixelSample& s, const dvec2& gradient,
                   const Reading& reading) {
  // The plane in clip space, depth = slope.x * x + slope.y * y + offset, and then in view space.
  const dvec2 slope = 0.5 * gradient * picture.size(reading);
  const double offset = s.depth - maths::dot(slope, picture.ndc(s, reading));
  const dvec4 plane =
      maths::transpose(picture.clip_from_view_by(reading)) * dvec4(slope, -1.0, offset);
  const double to_eye = picture.perspective ? plane.w : plane.z;
  return to_eye < 0.0 ? -dvec3(plane) : dvec3(plane);
}

// How far a sample is from the place at which the cameras expect it in the earlier frame. Only the
// distance in the direction of the gradient of depth shows.
struct Displacement {
  dvec2 direction;
  double distance = 0.0;  // pixels
  // The distance would be clearly another without the camera's translation or without any motion.
  // The depths of a floor, for example, stay the same when the camera moves along it or turns.
  bool shows_motion = false;
};

double share_at(const std::vector<Displacement>& displacements, const dvec2& shift) {
  return share_of(displacements, [&](const Displacement& d) {
    return std::abs(d.distance - maths::dot(d.direction, shift)) <= kSamePlace;
  });
}

// The share of the samples that show the camera's motion at the place where it says, or nothing if
// there are too few.
std::optional<double> share_in_motion(std::vector<Displacement> displacements) {
  std::erase_if(displacements, [](const Displacement& d) { return !d.shows_motion; });
  return displacements.size() < kEnoughOfSome ? std::nullopt
                                              : std::optional(share_at(displacements, dvec2(0.0)));
}

// Returns the shift of the image that explains the displacements best, by least squares without
// outliers. `shift` is where the search begins.
dvec2 common_shift(const std::vector<Displacement>& displacements, dvec2 shift) {
  for (const double limit : {3.0, 2.0, 1.0, 0.5, 0.3}) {
    double xx = 1.0, xy = 0.0, yy = 1.0;
    dvec2 sum(0.0);
    for (const Displacement& d : displacements) {
      const double rest = d.distance - maths::dot(d.direction, shift);
      if (std::abs(rest) <= limit) {
        xx += d.direction.x * d.direction.x;
        xy += d.direction.x * d.direction.y;
        yy += d.direction.y * d.direction.y;
        sum += rest * d.direction;
      }
    }
    const double determinant = xx * yy - xy * xy;
    shift += dvec2(yy * sum.x - xy * sum.y, xx * sum.y - xy * sum.x) / determinant;
  }
  return shift;
}

class Inspector {
 public:
  explicit Inspector(std::span<const InspectedFrame> frames)
      : pictures_(frames.begin(), frames.end()),
        now_(pictures_.front()),
        frame_(now_.frame),
        reversed_(std::abs(now_.distance(0.0)) > std::abs(now_.distance(1.0 - 1e-7))) {
    given_ = {static_cast<std::uint32_t>(frame_.normal_encoding), frame_.normals_in_view_space,
              frame_.normals_forward_z};
  }

  // Stops at the first mistake of the geometry, because others would be its consequences.
  Findings run() {
    const bool geometry_is_right = depth_fits() && (!frame_.has_normals || normals_fit());
    if (pictures_.size() > 1) {
      inspect_size_changes();
      if (geometry_is_right && frame_.continues_history) {
        inspect_motion();
      }
    }
    return findings_;
  }

 private:
  // Stores whether a mistake is seen, and returns true if it is not.
  bool lacks(Mistake mistake, bool is_seen, double measure = 0.0) {
    findings_.set(mistake, is_seen, measure);
    return !is_seen;
  }

  bool depth_fits() {
    return lacks(Mistake::image_too_small, is_too_small()) &&
           lacks(Mistake::depth_outside, is_depth_outside()) &&
           lacks(Mistake::depth_converted_from_minus_one, is_converted_from_minus_one()) &&
           lacks(Mistake::depth_reversed, is_depth_reversed()) && inspect_depth_format() &&
           lacks(Mistake::depth_from_minus_one, is_depth_from_minus_one()) && inspect_radius();
  }

  static bool is_smaller(VkExtent2D size, VkExtent2D than) {
    return size.width < than.width || size.height < than.height;
  }

  bool is_too_small() const {
    return is_smaller(frame_.depth_size, frame_.size) ||
           (frame_.has_normals && is_smaller(frame_.normals_size, frame_.size));
  }

  bool is_depth_outside() const {
    return share_of(frame_.samples,
                    [](const PixelSample& s) { return s.depth < 0.0f || s.depth > 1.0f; }) > 0.02;
  }

  // Returns true if the sky lies at the near plane, or if almost all surfaces lie just behind it.
  bool is_depth_reversed() const {
    const float near_depth = reversed_ ? 1.0f : 0.0f;
    std::size_t at_near = 0, at_far = 0, close = 0, surfaces = 0;
    const double near = now_.distance(near_depth);
    for (const PixelSample& sample : frame_.samples) {
      at_near += sample.depth == near_depth;
      at_far += sample.depth == 1.0f - near_depth;
      if (!is_sky(sample.depth)) {
        ++surfaces;
        close += now_.distance(sample.depth) < 1.3 * near;
      }
    }
    if (at_far == 0 && at_near * 50 > frame_.samples.size()) {
      return true;
    }
    return now_.perspective && at_far == 0 && surfaces >= kEnoughSamples &&
           static_cast<double>(close) > 0.95 * static_cast<double>(surfaces);
  }

  // The clip-space depth of a perspective projection is x + y / z.
  dvec2 depth_coefficients() const {
    const dmat4& m = now_.clip_from_view;
    return dvec2(m[2][2], m[3][2]) / m[2][3];
  }

  // Returns whether the projection was made for OpenGL's depth range of -1 to 1. A matrix has the
  // same form for either range, but it stands for different near planes. The near plane is a round
  // number only for the range for which the matrix was made.
  bool is_depth_from_minus_one() const {
    const dvec2 c = depth_coefficients();
    return now_.perspective && !reversed_ && is_round(std::abs(c.y / (c.x + 1.0)), 2.0) &&
           !is_round(std::abs(c.y / c.x), 4.0);
  }

  // Returns whether a projection with depth from 0 to 1 was converted as if it were OpenGL's. Its
  // near plane is then a round number before the conversion only, or the depths 0 and 1 do not both
  // lie before the eye.
  bool is_converted_from_minus_one() const {
    if (!now_.perspective) {
      return false;
    }
    const dvec2 c = depth_coefficients();
    const double at_0 = now_.distance(0.0), at_1 = now_.distance(1.0);
    const double nearer = std::min(at_0, at_1);  // behind the eye if it is negative
    return (nearer < 0.0 && -nearer < 100.0 * std::max(at_0, at_1)) ||
           (!reversed_ && is_round(std::abs(2.0 * c.y / (2.0 * c.x - 1.0)), 2.0) &&
            !is_round(std::abs(c.y / c.x), 4.0));
  }

  // Compares the steps of the depths with those of 16 bits. Other formats cannot be told apart.
  bool inspect_depth_format() {
    std::set<float> depths;
    for (const PixelSample& sample : frame_.samples) {
      if (!is_sky(sample.depth)) {
        depths.insert(sample.depth);
      }
    }
    if (depths.size() < kEnoughSamples) {
      return true;
    }
    const double in_steps = share_of(depths, [](float depth) {
      return std::abs(65535.0 * depth - std::round(65535.0 * depth)) < 0.01;
    });
    const bool says_16_bits = now_.depth_step(0.0f) == 1.0 / 65535.0;
    return lacks(Mistake::depth_format, says_16_bits ? in_steps < 0.1 : in_steps > 0.99);
  }

  bool inspect_radius() {
    std::vector<double> pixels;
    const double scale = 0.5 * frame_.size.height * std::abs(now_.clip_from_view[1][1]);
    for (const PixelSample& sample : frame_.samples) {
      if (!is_sky(sample.depth)) {
        const double distance = now_.perspective ? now_.distance(sample.depth) : 1.0;
        pixels.push_back(frame_.radius * scale / distance);
      }
    }
    if (pixels.size() >= kEnoughSamples) {
      // The radius is too small if it spans less than a pixel at 90 % of the samples, and too large
      // if it spans more than two image heights at 90 %.
      const double large = quantile(pixels, 0.9), small = quantile(pixels, 0.1);
      lacks(Mistake::radius_too_small, large < 1.0, large);
      lacks(Mistake::radius_too_large, small > 2.0 * frame_.size.height,
            small / frame_.size.height);
    }
    return true;
  }

  // Calls `call` for each sample on a smooth surface, with its depth normal and its given normal.
  // Samples at which the depth format is so coarse that it would tilt the normal are left out.
  template <typename Call>
  void for_normals(const Reading& reading, const Call& call) const {
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const PixelSample& s = frame_.samples[i];
      const maths::vec3 stored{s.normal[0], s.normal[1], s.normal[2]};
      if (!now_.gradients[i] || !maths::has_direction(stored)) {
        continue;
      }
      const dvec3 own = plane_normal(now_, s, *now_.gradients[i], reading);
      const dvec3 tilted =
          plane_normal(now_, s, *now_.gradients[i] + 0.5 * now_.depth_step(s.depth), reading);
      const double tilt_error = angle_between(own, tilted) / kDegrees;
      if (tilt_error <= 0.02) {
        call(own, given_normal(stored, reading), tilt_error);
      }
    }
  }

  dvec3 given_normal(const maths::vec3& stored, const Reading& reading) const {
    dvec3 given(maths::decode_normal(stored, reading.encoding));
    if (!reading.in_view_space) {
      given = dvec3(now_.view_by(reading) * dvec4(given, 0.0));
    } else if (reading.forward_z) {
      given.z = -given.z;
    }
    return given;
  }

  // Returns the angle, in degrees, that the normals of depth and the given ones have between them
  // at three quarters of the samples at most, for the surfaces of six directions the largest. A
  // floor that fills most of the image would hide mistakes: its normal may be the same in many
  // readings. With too few samples it is 0.
  double error_of(const Reading& reading) const {
    std::array<std::vector<double>, 6> angles;
    for_normals(reading, [&](const dvec3& own, const dvec3& given, double) {
      const dvec3 size = maths::abs(own);
      const int axis = size.x > std::max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
      angles.at(static_cast<std::size_t>(2 * axis + (own[axis] < 0.0 ? 1 : 0)))
          .push_back(angle_between(own, given));
    });
    double largest = 0.0;
    for (const std::vector<double>& direction : angles) {
      if (direction.size() >= kEnoughOfSome) {
        largest = std::max(largest, quantile(direction, 0.75));
      }
    }
    return largest;
  }

  // Returns the median of these angles, or 0 with too few samples.
  double typical_angle() const {
    std::vector<double> angles;
    for_normals(given_, [&](const dvec3& own, const dvec3& given, double) {
      angles.push_back(angle_between(own, given));
    });
    return angles.size() < kEnoughSamples ? 0.0 : quantile(angles, 0.5);
  }

  // The fraction of the given normals that face away from the eye, by more than 15 degrees.
  double facing_away(const Reading& reading) const {
    std::vector<bool> away;
    for_normals(reading, [&](const dvec3& own, const dvec3& given, double) {
      away.push_back(maths::dot(given, own) < -0.25 * maths::length(given) * maths::length(own));
    });
    return away.size() < kEnoughSamples ? 0.0 : share_of(away, [](bool is) { return is; });
  }

  bool normals_fit() {
    const double now = error_of(given_);
    Mistake found = best_reading(now);
    if (found == Mistake::count && now_.perspective && angles_to_view_axis_differ()) {
      found = Mistake::field_of_view;
    }
    // Floors that are seen from above have the normals of ceilings that are seen from below.
    Reading flipped = given_;
    flipped.flip_y = true;
    if (found == Mistake::count && facing_away(given_) > 0.2 && facing_away(flipped) < 0.02) {
      found = Mistake::flipped_y;
    }
    // A jitter in another unit shifts the whole projection.
    const double jitter =
        pictures_.size() > 1 ? maths::length(now_.jitter() - pictures_[1].jitter()) : 0.0;
    if (found != Mistake::count && jitter > kLargestJitter) {
      found = Mistake::jitter_wrong;
      findings_.set(Mistake::jitter_wrong, true, jitter);
    }
    const double typical = typical_angle();
    if (found == Mistake::count && typical > 25.0) {
      found = Mistake::normals_disagree;
    }
    for (const Mistake mistake :
         {Mistake::normal_space, Mistake::normal_encoding, Mistake::normal_forward_z,
          Mistake::view_inverted, Mistake::flipped_y, Mistake::image_too_large,
          Mistake::field_of_view, Mistake::normals_disagree}) {
      findings_.set(mistake, mistake == found, typical);
    }
    return found == Mistake::count;
  }

  // Calls `call` with each hypothesis about the projection.
  template <typename Call>
  void for_projections(const Call& call) const {
    Reading reading = given_;
    reading.whole_image = true;
    if (is_smaller(frame_.size, frame_.depth_size)) {
      call(Mistake::image_too_large, reading);
    }
    reading = given_;
    reading.flip_y = true;
    call(Mistake::flipped_y, reading);
    // Factors by which the tangent of half the field of view may be wrong.
    reading = given_;
    for (double scale = 0.25; now_.perspective && scale < 4.2; scale *= 1.05) {
      if (scale < 0.87 || scale > 1.15) {
        reading.tangent_scale = scale;
        call(Mistake::field_of_view, reading);
      }
    }
  }

  // Returns the mistake whose correction makes the given normals match those from depth, if there
  // is one. `now` is the error without a correction.
  Mistake best_reading(double now) const {
    // Normal maps tilt normals by some degrees from the surface.
    if (now < 4.0) {
      return Mistake::count;
    }
    double least = std::min(0.4 * now, 15.0);
    Mistake best = Mistake::count;
    const auto consider = [&](Mistake mistake, const Reading& reading) {
      const double error = error_of(reading);
      if (error < least - 0.1) {
        least = error;
        best = mistake;
      }
    };
    Reading reading = given_;
    reading.in_view_space = !given_.in_view_space;
    consider(Mistake::normal_space, reading);
    for (const bool other_space : {false, true}) {
      reading.in_view_space = given_.in_view_space != other_space;
      for (reading.encoding = 0; reading.encoding < 4; ++reading.encoding) {
        if (reading.encoding != given_.encoding) {
          consider(Mistake::normal_encoding, reading);
        }
      }
    }
    reading = given_;
    if (given_.in_view_space) {
      reading.forward_z = !given_.forward_z;
      consider(Mistake::normal_forward_z, reading);
    } else {
      reading.invert_view = true;
      consider(Mistake::view_inverted, reading);
    }
    for_projections([&](Mistake mistake, const Reading& projection) {
      if (mistake == Mistake::field_of_view) {
        least = std::min(least, 3.1);
      }
      consider(mistake, projection);
    });
    return best;
  }

  // Compares the angles between normals and the view axis: those of normals from depth with those
  // of given normals. A wrong angle of view multiplies the tangent of every such angle by one
  // number. Surfaces that are parallel or perpendicular to the view axis keep their angle and are
  // left out.
  bool angles_to_view_axis_differ() const {
    std::vector<double> exact, oblique;  // logarithms of the ratio of the tangents
    for_normals(given_, [&](dvec3 own, dvec3 stored, double tilt_error) {
      own = maths::normalize(own);
      stored = maths::normalize(stored);
      const double own_across = std::hypot(own.x, own.y);
      const double stored_across = std::hypot(stored.x, stored.y);
      const double side = own.z * stored.z < 0.0 ? -1.0 : 1.0;  // either may face away
      // An angle of view does not rotate a normal about the view axis.
      const double in_same_direction = side * (own.x * stored.x + own.y * stored.y);
      if (!(in_same_direction > kSameAngleAboutAxis * own_across * stored_across)) {
        return;
      }
      const double ratio =
          std::log(own_across * std::abs(stored.z) / (stored_across * std::abs(own.z)));
      // The sensitivity is half the sine of twice the angle to the view axis. An error of the angle
      // changes the logarithm of the ratio by the error divided by the sensitivity.
      const double sensitivity =
          std::min(own_across * std::abs(own.z), stored_across * std::abs(stored.z));
      if (sensitivity * kRatioError > std::max(tilt_error, kStoredError)) {
        exact.push_back(ratio);
      }
      if (sensitivity > kOblique) {
        oblique.push_back(ratio);
      }
    });
    return is_another_scale(exact) || is_another_scale_with_noise(oblique);
  }

  // Returns true if more than half of the logarithms agree on a number that is not near 0.
  static bool is_another_scale(const std::vector<double>& logarithms) {
    if (logarithms.size() < kEnoughSamples) {
      return false;
    }
    const double median = quantile(logarithms, 0.5);
    const auto share_near = [&](double value) {
      return share_of(logarithms, [&](double log) { return std::abs(log - value) <= kRatioError; });
    };
    return std::abs(median) > kLeastScale && share_near(median) > 0.5 && share_near(0.0) < 0.1;
  }

  // Shading normals and normal maps make each logarithm uncertain, but not their median.
  static bool is_another_scale_with_noise(const std::vector<double>& logarithms) {
    if (logarithms.size() < kEnoughSamples) {
      return false;
    }
    const double median = quantile(logarithms, 0.5);
    const double spread = quantile(logarithms, 0.75) - quantile(logarithms, 0.25);
    // The standard error of the median, for normally distributed numbers with this distance
    // (`spread`) between their quartiles.
    const double error = 0.93 * spread / std::sqrt(static_cast<double>(logarithms.size()));
    return spread < kLargestSpread && std::abs(median) > kLeastScale + 4.0 * error;
  }

  void inspect_size_changes() {
    const InspectedFrame& before = pictures_[1].frame;
    const auto same = [](VkExtent2D a, VkExtent2D b) {
      return a.width == b.width && a.height == b.height;
    };
    if (frame_.continues_history && !same(frame_.size, before.size)) {
      findings_.set(Mistake::size_changes,
                    same(frame_.depth_size, before.depth_size) && !frame_.has_largest_size);
    }
  }

  // Returns the matrix from the view space of `now` to that of `before`.
  static dmat4 camera_motion(const Picture& now, const Picture& before, const Reading& reading) {
    dmat4 motion = before.view_by(reading) * maths::inverse(now.view_by(reading));
    motion[3] = dvec4(dvec3(motion[3]) * reading.translation_scale, 1.0);
    return motion;
  }

  // Returns the displacements of the samples of the frame `now` in the frame `before` if these
  // frames were drawn with the cameras of two other frames.
  static std::vector<Displacement> displacements(const Picture& now, const Picture& before,
                                                 const Picture& camera,
                                                 const Picture& camera_before,
                                                 const Reading& reading) {
    const dmat4 motion = camera_motion(camera, camera_before, reading);
    dmat4 rotation = motion;
    rotation[3] = dvec4(0.0, 0.0, 0.0, 1.0);
    const dmat4 from = maths::inverse(camera.clip_from_view_by(reading));
    const dmat4 to = camera_before.clip_from_view_by(reading);
    const dmat4 to_before = to * motion * from, by_rotation = to * rotation * from,
                without_motion = to * from;
    const dvec2 grid = dvec2(kInspectColumns, kInspectRows) / to_vector(before.frame.size);
    std::vector<Displacement> result;
    for (const PixelSample& s : now.frame.samples) {
      const dvec4 ndc(now.ndc(s, reading), s.depth, 1.0);
      const dvec4 clip = to_before * ndc;
      if (is_sky(s.depth) || !(clip.w > 0.0)) {
        continue;
      }
      const auto to_pixel = [&](const dvec4& p) {
        return (0.5 * dvec2(p) / p.w + 0.5) * before.size(reading);
      };
      const dvec2 pixel = to_pixel(clip);
      const dvec2 cell = pixel * grid - 0.5;  // between four samples
      if (!(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < kInspectColumns - 1.0 &&
            cell.y < kInspectRows - 1.0)) {
        continue;
      }
      const auto sample_at = [](double x, double y) {
        return static_cast<std::size_t>(y) * kInspectColumns + static_cast<std::size_t>(x);
      };
      const std::size_t nearest = sample_at(cell.x + 0.5, cell.y + 0.5);
      const auto& gradient = before.gradients[nearest];
      if (!gradient) {
        continue;
      }
      const PixelSample& found = before.frame.samples[nearest];
      const double slope = maths::length(*gradient);
      const double step = before.depth_step(found.depth);
      const auto depth_at = [&](const dvec2& place) {
        return found.depth + maths::dot(*gradient, place - dvec2(found.x + 0.5, found.y + 0.5));
      };
      // All four samples must lie on one plane that is steep enough for the format of depth.
      bool is_plane = slope > 20.0 * step;
      const std::size_t first = sample_at(cell.x, cell.y);
      for (const std::size_t corner :
           {first, first + 1, first + kInspectColumns, first + kInspectColumns + 1}) {
        const PixelSample& other = before.frame.samples[corner];
        is_plane = is_plane && std::abs(depth_at({other.x + 0.5, other.y + 0.5}) - other.depth) <=
                                   0.1 * slope + 4.0 * step;
      }
      if (is_plane) {
        const auto distance = [&](const dvec4& p) {
          return (p.z / p.w - depth_at(to_pixel(p))) / slope;
        };
        const double here = distance(clip);
        result.push_back({*gradient / slope, here,
                          std::abs(distance(by_rotation * ndc) - here) > 2.0 * kSamePlace ||
                              std::abs(distance(without_motion * ndc) - here) > 2.0 * kSamePlace});
      }
    }
    return result;
  }

  void inspect_motion() {
    const Picture& before = pictures_[1];
    if (frame_.is_static) {
      std::size_t changed = 0;
      for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
        const float a = frame_.samples[i].depth, b = before.frame.samples[i].depth;
        changed += std::abs(double{a} - b) > 4.0 * now_.depth_step(a);
      }
      findings_.set(Mistake::static_in_motion, changed * 50 > frame_.samples.size());
      return;
    }
    const std::vector<Displacement> by_cameras = displacements(now_, before, now_, before, given_);
    // If almost no sample stays on the image, a hypothesis under which samples stay is right.
    const bool leaves_image = by_cameras.size() < kEnoughSamples;
    const double share_of_all = leaves_image ? 0.0 : share_at(by_cameras, dvec2(0.0));
    const double share = std::min(share_of_all, share_in_motion(by_cameras).value_or(1.0));
    double measure = 100.0 * (1.0 - share);
    const Mistake found = share > kMisfits
                              ? Mistake::count
                              : mistake_of_cameras(by_cameras, share_of_all, share, measure);
    for (const Mistake mistake :
         {Mistake::camera_of_another_frame, Mistake::jitter_missing, Mistake::jitter_unused,
          Mistake::jitter_wrong, Mistake::translation_scale, Mistake::no_translation,
          Mistake::cameras_disagree, Mistake::image_too_large, Mistake::field_of_view,
          Mistake::flipped_y, Mistake::view_inverted}) {
      if (mistake == found || (findings_.seen >> static_cast<int>(mistake) & 1u) == 0) {
        findings_.set(mistake, mistake == found, measure);
      }
    }
    if (found == Mistake::count && share > kMisfits && frame_.has_motion) {
      inspect_motion_vectors();
    }
  }

  // Returns the mistake that explains why the cameras do not fit depth from frame to frame.
  // `share_of_all` is the share of all samples at the place that the cameras say, and `share` that
  // of the samples that show the camera's motion, if it is smaller.
  Mistake mistake_of_cameras(const std::vector<Displacement>& by_cameras, double share_of_all,
                             double share, double& measure) const {
    const Picture& before = pictures_[1];
    const auto fits = [&](const std::vector<Displacement>& other, const dvec2& shift) {
      return other.size() >= kEnoughSamples &&
             share_at(other, shift) > std::max(kFits, share_of_all + 0.3);
    };
    if (pictures_.size() > 2) {
      const Picture& oldest = pictures_[2];
      if (fits(displacements(before, oldest, now_, before, given_), dvec2(0.0)) ||
          fits(displacements(now_, before, before, oldest, given_), dvec2(0.0))) {
        return Mistake::camera_of_another_frame;
      }
    }
    // Jitter: the whole image is shifted from where the cameras expect it.
    const dvec2 in_cameras = now_.jitter() - before.jitter();
    for (const dvec2& begin : {dvec2(0.0), in_cameras}) {
      const dvec2 shift = common_shift(by_cameras, begin);
      const dvec2 in_depth = in_cameras - shift;
      measure = maths::length(shift);
      if (fits(by_cameras, shift) && std::abs(in_depth.x) < 1.2 && std::abs(in_depth.y) < 1.2) {
        return maths::length(in_cameras) < 0.02 ? Mistake::jitter_missing
               : maths::length(in_depth) < 0.1  ? Mistake::jitter_unused
                                                : Mistake::jitter_wrong;
      }
    }
    Mistake best = Mistake::count;
    double most = std::max(kFits, share + 0.3);
    const auto consider = [&](Mistake mistake, const Reading& reading) {
      const double other_share =
          share_in_motion(displacements(now_, before, now_, before, reading)).value_or(0.0);
      if (other_share > most) {
        most = other_share;
        best = mistake;
        measure = reading.translation_scale;
      }
    };
    for_projections(consider);
    Reading reading = given_;
    for (double scale = 0.008; scale < 130.0; scale *= 1.1) {
      reading.translation_scale = scale;
      consider(Mistake::translation_scale, reading);
    }
    reading = given_;
    reading.invert_view = true;
    consider(Mistake::view_inverted, reading);
    if (best != Mistake::count) {
      return best;
    }
    measure = 100.0 * (1.0 - share);
    const auto has_translation = [](const Picture& picture) {
      return dvec3(picture.view_from_world[3]) != dvec3(0.0);
    };
    if (!has_translation(now_) && !has_translation(before)) {
      return Mistake::no_translation;
    }
    // Where objects move, depth alone does not tell whether the cameras fit.
    if (by_cameras.size() < kEnoughSamples || share_of_all > 0.25 || frame_.has_motion) {
      return Mistake::count;
    }
    if (maths::length(in_cameras) > kLargestJitter) {
      measure = maths::length(in_cameras);
      return Mistake::jitter_wrong;
    }
    return Mistake::cameras_disagree;
  }

  // Compares the motion vectors with the motion that the cameras give to static surfaces.
  void inspect_motion_vectors() {
    struct Vector {
      dvec2 stored;
      dvec2 by_cameras;  // pixels
    };
    const dmat4 to_before = pictures_[1].clip_from_view *
                            camera_motion(now_, pictures_[1], given_) * now_.view_from_clip;
    const dvec2 size = to_vector(frame_.size);
    std::vector<Vector> vectors;
    std::vector<double> lengths;
    for (const PixelSample& s : frame_.samples) {
      const dvec2 ndc = now_.ndc(s, given_);
      const dvec4 clip = to_before * dvec4(ndc, s.depth, 1.0);
      if (!is_sky(s.depth) && clip.w > 0.0) {
        const dvec2 motion = 0.5 * (ndc - dvec2(clip) / clip.w) * size;
        vectors.push_back({dvec2(s.motion[0], s.motion[1]), motion});
        lengths.push_back(maths::length(motion));
      }
    }
    if (vectors.size() < kEnoughSamples || quantile(lengths, 0.5) < 0.3) {
      return;
    }
    const dvec2 scale(frame_.motion.scale[0], frame_.motion.scale[1]);
    const dvec2 offset(frame_.motion.offset[0], frame_.motion.offset[1]);
    const auto share = [&](const dvec2& factor, const dvec2& shift) {
      return share_of(vectors, [&](const Vector& v) {
        const dvec2 given = (scale * v.stored * factor + offset) * size + shift;
        return maths::length(given - v.by_cameras) <= 0.1 + 0.05 * maths::length(v.by_cameras);
      });
    };
    const double given = share(dvec2(1.0), dvec2(0.0));
    Mistake found = Mistake::count;
    if (given < kMisfits) {
      double most = std::max(kFits, given + 0.3);
      const dvec2 jitter = now_.jitter() - pictures_[1].jitter();
      const dvec2 units[] = {dvec2(1.0), dvec2(0.5), dvec2(2.0), 1.0 / size, size};
      for (const double jitters : {0.0, 1.0, 2.0, -1.0}) {
        for (const dvec2& unit : units) {
          for (int signs = 0; signs < 4; ++signs) {
            const dvec2 factor =
                unit * dvec2((signs & 1) != 0 ? -1.0 : 1.0, (signs & 2) != 0 ? -1.0 : 1.0);
            const double other = share(factor, jitters * jitter);
            if (other > most + 0.02) {
              most = other;
              found = unit != dvec2(1.0) ? Mistake::motion_unit
                      : signs != 0       ? Mistake::motion_sign
                                         : Mistake::motion_jitter;
            }
          }
        }
      }
      if (found == Mistake::count && share_of(vectors, [&](const Vector& v) {
                                       return maths::length(scale * v.stored * size) < 0.02;
                                     }) > 0.9) {
        found = Mistake::motion_zero;
      }
    }
    for (const Mistake mistake : {Mistake::motion_zero, Mistake::motion_sign, Mistake::motion_unit,
                                  Mistake::motion_jitter}) {
      findings_.set(mistake, mistake == found);
    }
  }

  std::vector<Picture> pictures_;  // this frame, then earlier ones
  const Picture& now_;
  const InspectedFrame& frame_;
  Reading given_;
  bool reversed_;
  Findings findings_;
};

}  // namespace

void Findings::set(Mistake mistake, bool is_seen, double measure) {
  static_assert(kMistakes <= 64);
  const std::uint64_t bit = std::uint64_t{1} << static_cast<int>(mistake);
  judged |= bit;
  seen = is_seen ? seen | bit : seen & ~bit;
  if (is_seen) {
    measures.at(static_cast<std::size_t>(mistake)) = static_cast<float>(measure);
  }
}

Findings inspect(std::span<const InspectedFrame> frames) { return Inspector(frames).run(); }

}  // namespace alcove::passes

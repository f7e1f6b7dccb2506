#include "diagnose/inspect.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "maths/normal_encoding.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using maths::dmat4;
using maths::dvec3;
using maths::dvec4;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
// The least number of samples from which a mistake is concluded.
constexpr std::size_t kEnoughSamples = 100;

// Limits for the comparison of the angles to the view axis.
constexpr double kSameAngleAboutAxis = 0.966;  // cosine of 15 degrees about the view axis
constexpr double kStoredError = 0.002;  // of stored normals, radians: that of 10 bits a channel
constexpr double kRatioError = 0.05;    // of the tangents' ratio at one sample
constexpr double kOblique = 0.3;        // half the sine of twice the angle: 18 to 72 degrees
constexpr double kLeastScale = 0.14;    // logarithm of 1.15, below which a scale is not reported
constexpr double kLargestSpread = 0.5;  // between the quartiles of the ratios' logarithms

// A sample on a smooth surface: its position, the differences between the positions of opposite
// neighbours, and the stored normal.
struct SmoothSample {
  dvec3 position;
  dvec3 along_x;
  dvec3 along_y;
  maths::vec3 stored;
  double tilt_error = 0.0;  // of the normal of depth, by the step of the format, radians
};

// A hypothesis of how the normals are stored and which projection drew the depth.
struct Reading {
  bool in_view_space = false;
  bool packed = false;
  bool forward_z = false;
  bool flip_y = false;
  double tangent_scale = 1.0;  // of the tangents of half the angles of view
};

// Returns the value that a fraction `share`, 0 to 1, of the values does not exceed.
double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values.size()) * share);
  std::nth_element(values.begin(), at, values.end());
  return *at;
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

class Inspector {
 public:
  Inspector(const InspectedView& view, std::span<const PixelSample> samples)
      : view_(view),
        samples_(samples),
        clip_from_view_(to_mat4(view.view.clip_from_view)),
        view_from_clip_(maths::inverse(clip_from_view_)),
        rotation_(to_rigid(view.view.view_from_world)),
        perspective_(view.view.clip_from_view[15] == 0.0f) {
    const double near = position(0.5, 0.5, 0.0).z;
    const double far = position(0.5, 0.5, 1.0 - 1e-7).z;
    reversed_ = std::abs(near) > std::abs(far);
  }

  Mistakes run() {
    Mistakes found{};
    const auto set = [&](Mistake mistake, bool is) {
      found.at(static_cast<std::size_t>(mistake)) = is;
    };
    set(Mistake::image_too_small, is_too_small());
    set(Mistake::depth_reversed, is_depth_reversed());
    if (is_too_small() || is_depth_reversed()) {
      return found;  // other checks would find mistakes that are consequences of this one
    }
    const bool from_minus_one = is_depth_from_minus_one();
    set(Mistake::depth_from_minus_one, from_minus_one);
    inspect_radius(set);
    if (view_.has_normals && !from_minus_one) {
      inspect_normals(set);
    }
    return found;
  }

 private:
  static bool is_smaller(VkExtent2D size, VkExtent2D than) {
    return size.width < than.width || size.height < than.height;
  }

  bool is_too_small() const {
    return is_smaller(view_.depth_size, view_.size) ||
           (view_.has_normals && is_smaller(view_.normals_size, view_.size));
  }

  // Returns a position in view space. `u` and `v` are 0 to 1 over the image.
  dvec3 position(double u, double v, double depth) const {
    const dvec4 p = view_from_clip_ * dvec4(2.0 * u - 1.0, 2.0 * v - 1.0, depth, 1.0);
    return dvec3(p) / p.w;
  }

  bool is_sky(float depth) const { return !(depth > 0.0f && depth < 1.0f); }

  // Returns true if the sky lies at the near plane, or if almost all surfaces lie just behind it.
  bool is_depth_reversed() const {
    const float near_depth = reversed_ ? 1.0f : 0.0f;
    std::size_t at_near = 0, at_far = 0, close = 0, surfaces = 0;
    const double near = -position(0.5, 0.5, near_depth).z;
    for (const PixelSample& sample : samples_) {
      at_near += sample.depth == near_depth;
      at_far += sample.depth == 1.0f - near_depth;
      if (!is_sky(sample.depth)) {
        ++surfaces;
        close += -position(0.5, 0.5, sample.depth).z < 1.3 * near;
      }
    }
    if (at_far == 0 && at_near * 50 > samples_.size()) {
      return true;
    }
    return perspective_ && at_far == 0 && surfaces >= kEnoughSamples &&
           static_cast<double>(close) > 0.95 * static_cast<double>(surfaces);
  }

  // Returns whether the projection was made for OpenGL's depth range of -1 to 1. A matrix has the
  // same form for either range, but it stands for different near planes. The near plane is a round
  // number only for the range for which the matrix was made.
  bool is_depth_from_minus_one() const {
    if (!perspective_ || reversed_) {
      return false;
    }
    const double a = clip_from_view_[2][2] / clip_from_view_[2][3];
    const double b = clip_from_view_[3][2] / clip_from_view_[2][3];
    // clip z / w = a + b / z, where z is negative and -1 stands for clip_from_view_[2][3].
    const double near_of_vulkan = b / a;
    const double near_of_opengl = b / (a + 1.0);
    return is_round(std::abs(near_of_opengl), 2.0) && !is_round(std::abs(near_of_vulkan), 4.0);
  }

  template <typename Set>
  void inspect_radius(const Set& set) const {
    std::vector<double> pixels;
    const double scale = 0.5 * view_.size.height * std::abs(clip_from_view_[1][1]);
    for (const PixelSample& sample : samples_) {
      if (!is_sky(sample.depth)) {
        const double distance = perspective_ ? -position(0.5, 0.5, sample.depth).z : 1.0;
        pixels.push_back(view_.radius * scale / distance);
      }
    }
    if (pixels.size() < kEnoughSamples) {
      return;
    }
    std::sort(pixels.begin(), pixels.end());
    // The radius is too small if it spans less than half a pixel at 90 % of the samples, and too
    // large if it spans more than three image heights at 90 %.
    set(Mistake::radius_too_small, pixels[pixels.size() * 9 / 10] < 0.5);
    set(Mistake::radius_too_large, pixels[pixels.size() / 10] > 3.0 * view_.size.height);
  }

  // The largest step between neighbouring values of the format near this depth.
  double depth_step(float depth) const {
    switch (view_.depth_format) {
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

  // Returns the sample with its differences of position, or nothing if the surface is not smooth
  // there. The depth buffer is linear in screen space on a plane, so a pixel whose depth is not
  // linear among its neighbours is left out. A pixel is also left out if the depth format is so
  // coarse that it would tilt the normal.
  std::optional<SmoothSample> smooth(const PixelSample& s) const {
    const double step = depth_step(s.depth);
    const auto is_line = [&](float before, float after) {
      const double second = double{before} + after - 2.0 * double{s.depth};
      return !is_sky(before) && !is_sky(after) &&
             std::abs(second) <= 0.02 * std::abs(double{after} - before) + 2.0 * step;
    };
    const bool inside =
        s.x > 0 && s.y > 0 && s.x + 1 < view_.size.width && s.y + 1 < view_.size.height;
    if (!inside || is_sky(s.depth) || !is_line(s.left, s.right) || !is_line(s.up, s.down)) {
      return std::nullopt;
    }
    const auto at = [&](double dx, double dy, double depth) {
      return position((s.x + 0.5 + dx) / view_.size.width, (s.y + 0.5 + dy) / view_.size.height,
                      depth);
    };
    SmoothSample result;
    result.position = at(0, 0, s.depth);
    result.along_x = at(1, 0, s.right) - at(-1, 0, s.left);
    result.along_y = at(0, 1, s.down) - at(0, -1, s.up);
    result.stored = {s.normal[0], s.normal[1], s.normal[2]};
    const double error = maths::distance(at(0, 0, s.depth + step), result.position);
    const double width = maths::distance(at(1, 0, s.depth), at(-1, 0, s.depth));
    result.tilt_error = error / width;
    if (!(error <= 0.02 * width) || !maths::has_direction(result.stored)) {
      return std::nullopt;
    }
    return result;
  }

  dvec3 given_normal(const SmoothSample& s, const Reading& reading) const {
    auto encoding = static_cast<std::uint32_t>(view_.normal_encoding) & ~1u;
    encoding |= reading.packed ? 1u : 0u;
    dvec3 given(maths::decode_normal(s.stored, encoding));
    if (!reading.in_view_space) {
      given = dvec3(rotation_ * dvec4(given, 0.0));
    } else if (reading.forward_z) {
      given.z = -given.z;
    }
    return given;
  }

  static dvec3 scale_of(const Reading& reading) {
    const double k = reading.tangent_scale;
    return {k, reading.flip_y ? -k : k, 1.0};
  }

  // Returns the surface's normal from the depths. It is not normalised and may face away from the
  // eye.
  static dvec3 own_normal(const SmoothSample& s, const Reading& reading) {
    const dvec3 scale = scale_of(reading);
    return maths::cross(s.along_x * scale, s.along_y * scale);
  }

  // The angle between two normals in degrees, 0 to 90. Either may face away.
  static double angle_between(const dvec3& a, const dvec3& b) {
    const double length = maths::length(a) * maths::length(b);
    const double cosine = length > 0.0 ? std::abs(maths::dot(a, b)) / length : 0.0;
    return std::acos(std::min(cosine, 1.0)) * kDegrees;
  }

  std::vector<double> angles_of(const Reading& reading,
                                std::span<const SmoothSample> samples) const {
    std::vector<double> angles;
    angles.reserve(samples.size());
    for (const SmoothSample& s : samples) {
      angles.push_back(angle_between(own_normal(s, reading), given_normal(s, reading)));
    }
    return angles;
  }

  // Returns the angle in degrees, between normals from depth and the given normals, that three
  // quarters of the samples do not exceed. The median would hide mistakes: walls and floors along
  // the axes of the view have the same normals with any field of view.
  double error_of(const Reading& reading) const {
    return quantile(angles_of(reading, smooth_), 0.75);
  }

  // The fraction of the samples whose normals are at most 2 degrees apart.
  double agreement_of(const Reading& reading, std::span<const SmoothSample> samples) const {
    const std::vector<double> angles = angles_of(reading, samples);
    const auto agreeing = std::ranges::count_if(angles, [](double angle) { return angle <= 2.0; });
    return static_cast<double>(agreeing) / static_cast<double>(angles.size());
  }

  // The fraction of the given normals that face away from the eye, by more than 15 degrees.
  double facing_away(const Reading& reading) const {
    std::size_t away = 0;
    for (const SmoothSample& s : smooth_) {
      const dvec3 to_eye = perspective_ ? -s.position * scale_of(reading) : dvec3(0.0, 0.0, 1.0);
      const dvec3 given = given_normal(s, reading);
      away += maths::dot(given, to_eye) < -0.25 * maths::length(given) * maths::length(to_eye);
    }
    return static_cast<double>(away) / static_cast<double>(smooth_.size());
  }

  // Returns the samples whose normals from depth would change with another field of view. Floors
  // and walls along the axes of the view are left out.
  std::vector<SmoothSample> samples_that_tell_angle_of_view(const Reading& given) const {
    Reading wide = given, narrow = given;
    wide.tangent_scale = 1.5;
    narrow.tangent_scale = 1.0 / 1.5;
    std::vector<SmoothSample> result;
    std::ranges::copy_if(smooth_, std::back_inserter(result), [&](const SmoothSample& s) {
      const dvec3 own = own_normal(s, given);
      return angle_between(own, own_normal(s, wide)) > 5.0 ||
             angle_between(own, own_normal(s, narrow)) > 5.0;
    });
    return result;
  }

  template <typename Set>
  void inspect_normals(const Set& set) {
    for (const PixelSample& sample : samples_) {
      if (const auto found = smooth(sample)) {
        smooth_.push_back(*found);
      }
    }
    if (smooth_.size() < kEnoughSamples) {
      return;
    }
    const Reading given{view_.normals_in_view_space,
                        view_.normal_encoding == NormalEncoding::unsigned_xyz ||
                            view_.normal_encoding == NormalEncoding::unsigned_octahedral,
                        view_.normals_forward_z};
    Mistake found = best_reading(given);
    if (found == Mistake::count && perspective_ && has_other_angle_of_view(given)) {
      found = Mistake::field_of_view;
    }
    // Floors that are seen from above have the normals of ceilings that are seen from below.
    Reading flipped = given;
    flipped.flip_y = true;
    if (found == Mistake::count && facing_away(given) > 0.2 && facing_away(flipped) < 0.02) {
      found = Mistake::flipped_y;
    }
    if (found != Mistake::count) {
      set(found, true);
    }
  }

  // Returns the mistake whose correction makes the given normals match those from depth, if there
  // is one.
  Mistake best_reading(const Reading& given) const {
    const double now = error_of(given);
    // Normal maps tilt normals by some degrees from the surface.
    if (now < 4.0) {
      return Mistake::count;
    }
    double least = std::min(0.4 * now, 15.0);
    Mistake best = Mistake::count;
    const auto consider = [&](Mistake mistake, auto&& change) {
      Reading reading = given;
      change(reading);
      const double error = error_of(reading);
      if (error < least - 0.1) {
        least = error;
        best = mistake;
      }
    };
    consider(Mistake::normal_space, [](Reading& r) { r.in_view_space = !r.in_view_space; });
    consider(Mistake::normal_packing, [](Reading& r) { r.packed = !r.packed; });
    consider(Mistake::normal_packing, [](Reading& r) {
      r.packed = !r.packed;
      r.in_view_space = !r.in_view_space;
    });
    if (given.in_view_space) {
      consider(Mistake::normal_forward_z, [](Reading& r) { r.forward_z = !r.forward_z; });
    }
    consider(Mistake::flipped_y, [](Reading& r) { r.flip_y = true; });
    if (perspective_) {
      least = std::min(least, 3.1);
      for_other_angles_of_view([&](double scale) {
        consider(Mistake::field_of_view, [scale](Reading& r) { r.tangent_scale = scale; });
      });
    }
    return best;
  }

  // Calls `call` with the factors by which the tangent of half the field of view may be wrong, from
  // 1/4 to 4 except near 1.
  template <typename Call>
  static void for_other_angles_of_view(const Call& call) {
    for (double scale = 0.25; scale < 4.2; scale *= 1.05) {
      if (scale < 0.87 || scale > 1.15) {
        call(scale);
      }
    }
  }

  // Compares the angles between normals and the view axis: those of normals from depth with those
  // of given normals. A wrong angle of view multiplies the tangent of every such angle by one
  // number. Surfaces that are parallel or perpendicular to the view axis keep their angle and are
  // left out.
  bool angles_to_view_axis_differ(const Reading& given) const {
    std::vector<double> exact, oblique;  // logarithms of the ratio of the tangents
    for (const SmoothSample& s : smooth_) {
      const dvec3 own = maths::normalize(own_normal(s, given));
      const dvec3 stored = maths::normalize(given_normal(s, given));
      const double own_across = std::hypot(own.x, own.y);
      const double stored_across = std::hypot(stored.x, stored.y);
      const double side = own.z * stored.z < 0.0 ? -1.0 : 1.0;  // either may face away
      // An angle of view does not rotate a normal about the view axis.
      const double in_same_direction = side * (own.x * stored.x + own.y * stored.y);
      if (!(in_same_direction > kSameAngleAboutAxis * own_across * stored_across)) {
        continue;
      }
      const double ratio =
          std::log(own_across * std::abs(stored.z) / (stored_across * std::abs(own.z)));
      // The sensitivity is half the sine of twice the angle to the view axis. An error of the angle
      // changes the logarithm of the ratio by the error divided by the sensitivity.
      const double sensitivity =
          std::min(own_across * std::abs(own.z), stored_across * std::abs(stored.z));
      if (sensitivity * kRatioError > std::max(s.tilt_error, kStoredError)) {
        exact.push_back(ratio);
      }
      if (sensitivity > kOblique) {
        oblique.push_back(ratio);
      }
    }
    return is_another_scale(exact, kRatioError) || is_another_scale_with_noise(oblique);
  }

  // Returns true if more than half of the logarithms agree on a number that is not near 0.
  static bool is_another_scale(const std::vector<double>& logarithms, double tolerance) {
    if (logarithms.size() < kEnoughSamples) {
      return false;
    }
    const double median = quantile(logarithms, 0.5);
    const auto share_near = [&](double value) {
      const auto near = std::ranges::count_if(
          logarithms, [&](double log) { return std::abs(log - value) <= tolerance; });
      return static_cast<double>(near) / static_cast<double>(logarithms.size());
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

  bool has_other_angle_of_view(const Reading& given) const {
    if (angles_to_view_axis_differ(given)) {
      return true;
    }
    const std::vector<SmoothSample> samples = samples_that_tell_angle_of_view(given);
    if (samples.size() < kEnoughSamples) {
      return false;
    }
    const double now = agreement_of(given, samples);
    double most = now;
    for_other_angles_of_view([&](double scale) {
      Reading reading = given;
      reading.tangent_scale = scale;
      most = std::max(most, agreement_of(reading, samples));
    });
    return now < 0.2 && most > 0.5;
  }

  const InspectedView& view_;
  std::span<const PixelSample> samples_;
  dmat4 clip_from_view_;
  dmat4 view_from_clip_;
  dmat4 rotation_;  // view from world space
  bool perspective_;
  bool reversed_ = false;
  std::vector<SmoothSample> smooth_;
};

}  // namespace

const char* sentence(Mistake mistake) {
  switch (mistake) {
    case Mistake::depth_reversed:
      return "depth runs the other way than camera.clip_from_view says: the sky, or all that is "
             "seen, lies at its near plane; give the matrix that depth was drawn with.";
    case Mistake::depth_from_minus_one:
      return "camera.clip_from_view looks like OpenGL's, with depth from -1 to 1: its near plane "
             "is "
             "a round number only then; convert it with "
             "ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE.";
    case Mistake::field_of_view:
      return "normals fit the depth with another angle of view, or other near and far planes, than "
             "those of camera.clip_from_view; give the matrix that depth was drawn with.";
    case Mistake::normal_space:
      return "normals fit the depth in the other space; change normals_in_view_space.";
    case Mistake::normal_packing:
      return "normals fit the depth when they are unpacked the other way; change normal_encoding.";
    case Mistake::normal_forward_z:
      return "normals fit the depth with the other sign of z; change normals_forward_z.";
    case Mistake::flipped_y:
      return "normals fit the depth with y of camera.clip_from_view the other way round; see "
             "ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP.";
    case Mistake::radius_too_small:
      return "the radius is less than half a pixel almost everywhere; give it in the units of the "
             "scene.";
    case Mistake::radius_too_large:
      return "the radius is more than three times the height of the image everywhere; give it in "
             "the units of the scene.";
    case Mistake::image_too_small:
      return "an image is smaller than AlcoveImage::width and height say.";
    default:
      return "";
  }
}

Mistakes inspect(const InspectedView& view, std::span<const PixelSample> samples) {
  return Inspector(view, samples).run();
}

}  // namespace alcove::passes

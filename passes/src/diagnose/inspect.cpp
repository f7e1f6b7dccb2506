#include "diagnose/inspect.h"

#include <array>
#include <set>

#include "diagnose/picture.h"
#include "maths/normal_encoding.h"

namespace alcove::passes {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

// Limits for the comparison of the angles to the view axis.
constexpr double kSameSurface = 15.0;          // degrees between the normals of successive samples
constexpr double kSameAngleAboutAxis = 0.966;  // cosine of 15 degrees about the view axis
constexpr double kStoredError = 0.002;  // of stored normals, radians: that of 10 bits a channel
constexpr double kRatioError = 0.05;    // of the tangents' ratio at one sample
constexpr double kOblique = 0.3;        // half the sine of twice the angle: 18 to 72 degrees
constexpr double kLeastScale = 0.14;    // logarithm of 1.15, below which a scale is not reported
constexpr double kLargestSpread = 0.5;  // between the quartiles of the ratios' logarithms

// Returns true if a number has at most so many significant digits, as near planes that people type.
bool is_round(double value, double digits) {
  if (!(value > 0.0) || !std::isfinite(value)) return false;
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

bool same_rotation(const dmat4& a, const dmat4& b) {
  double largest = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(a[i][k] - b[i][k]));
  return largest < 1e-5;
}

class Inspector {
 public:
  explicit Inspector(std::span<const InspectedFrame> frames)
      : pictures_(frames.begin(), frames.end()),
        now_(pictures_.front()),
        frame_(now_.frame),
        reversed_(std::abs(now_.distance(0.0)) > std::abs(now_.distance(1.0 - 1e-7))) {
    given_.normals = frame_.normals;
    // Cameras may be relative to an origin that moves. previous_camera then differs from the camera
    // that the last frame was recorded with in its translation alone.
    const dmat4 previous = to_rigid(frame_.previous_camera.view_from_world);
    if (pictures_.size() > 1 && previous != now_.view_from_world &&
        same_rotation(previous, pictures_[1].view_from_world))
      pictures_[1].view_from_world = previous;
  }

  // Stops at the first mistake of the geometry, because others would be its consequences.
  Findings run() {
    const bool geometry_is_right = depth_fits() && (!frame_.has_normals || normals_fit());
    if (pictures_.size() > 1) {
      inspect_size_changes();
      if (geometry_is_right && frame_.continues_history)
        inspect_motion(pictures_, given_, findings_);
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
           lacks(Mistake::depth_filtered, is_depth_filtered()) &&
           lacks(Mistake::depth_reversed, is_depth_reversed()) && inspect_depth_format() &&
           lacks(Mistake::depth_from_minus_one, is_depth_from_minus_one()) && inspect_radius();
  }

  bool is_too_small() const {
    return is_smaller(frame_.depth_size, frame_.size) ||
           (frame_.has_normals && is_smaller(frame_.normals_size, frame_.size));
  }

  bool is_depth_outside() const {
    return share_of(frame_.samples,
                    [](const PixelSample& s) { return s.depth < 0.0f || s.depth > 1.0f; }) > 0.02;
  }

  // At the edge of an object each pixel has the depth of one of two surfaces. A linear filter gives
  // it a depth between them, which is neither theirs nor, as on a steep surface, their mean.
  bool is_depth_filtered() const {
    std::size_t edges = 0, between = 0;
    const auto look_at = [&](float before, float here, float after) {
      if (is_sky(before) || is_sky(here) || is_sky(after)) return;
      const double a = now_.distance(before), b = now_.distance(here), c = now_.distance(after);
      const double least = std::min(std::abs(here - before), std::abs(after - here));
      const double most = std::max(std::abs(here - before), std::abs(after - here));
      if (std::abs(a - c) < 0.15 * b || least > 0.8 * most) return;
      ++edges;
      between += (b - a) * (c - b) > 0.0 && least > 0.2 * most;
    };
    for (const PixelSample& s : frame_.samples) {
      look_at(s.left, s.depth, s.right);
      look_at(s.up, s.depth, s.down);
    }
    return edges >= kEnoughOfSome && 2 * between > edges;
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
    if (at_far == 0 && at_near * 50 > frame_.samples.size()) return true;
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
    if (!now_.perspective) return false;
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
    for (const PixelSample& sample : frame_.samples)
      if (!is_sky(sample.depth)) depths.insert(sample.depth);
    if (depths.size() < kEnoughSamples) return true;
    const double in_steps = share_of(depths, [](float depth) {
      return std::abs(65535.0 * depth - std::round(65535.0 * depth)) < 0.01;
    });
    const bool says_16_bits = now_.depth_step(0.0f) == 1.0 / 65535.0;
    return lacks(Mistake::depth_format, says_16_bits ? in_steps < 0.1 : in_steps > 0.99);
  }

  bool inspect_radius() {
    std::vector<double> pixels;
    std::array<std::vector<double>, 3> places;
    const double scale = 0.5 * frame_.size.height * std::abs(now_.clip_from_view[1][1]);
    for (const PixelSample& s : frame_.samples) {
      if (is_sky(s.depth)) continue;
      const dvec4 place = now_.view_from_clip * dvec4(now_.ndc(s, given_), s.depth, 1.0);
      pixels.push_back(frame_.radius * scale / (now_.perspective ? -place.z / place.w : 1.0));
      for (int i = 0; i < 3; ++i)
        places.at(static_cast<std::size_t>(i)).push_back(place[i] / place.w);
    }
    if (pixels.size() < kEnoughSamples) return true;
    // The size of what is seen.
    double extent = 0.0;
    for (const std::vector<double>& place : places)
      extent = std::max(extent, quantile(place, 0.95) - quantile(place, 0.05));
    // The radius is too small if it spans less than a pixel at 90 % of the samples. It is too large
    // if it spans more than two image heights at 90 %, or half of one and three quarters of what is
    // seen.
    const double small = quantile(pixels, 0.1) / frame_.size.height;
    lacks(Mistake::radius_too_small, quantile(pixels, 0.9) < 1.0);
    lacks(Mistake::radius_too_large, small > 2.0 || (small > 0.5 && frame_.radius > 0.5 * extent));
    return true;
  }

  // Calls `call` for each sample on a smooth surface, with its depth normal and its given normal.
  // Samples at which the depth format is so coarse that it would tilt the normal are left out.
  template <typename Call>
  void for_normals(const Reading& reading, const Call& call) const {
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const PixelSample& s = frame_.samples[i];
      const maths::vec3 stored{s.normal[0], s.normal[1], s.normal[2]};
      if (!now_.gradients[i] || !maths::has_direction(stored)) continue;
      const dvec3 own = plane_normal(now_, s, *now_.gradients[i], reading);
      const dvec3 tilted =
          plane_normal(now_, s, *now_.gradients[i] + 0.5 * now_.depth_step(s.depth), reading);
      const double tilt_error = angle_between(own, tilted) / kDegrees;
      if (tilt_error <= 0.02) call(own, given_normal(stored, reading), tilt_error);
    }
  }

  dvec3 given_normal(const maths::vec3& stored, const Reading& reading) const {
    dvec3 given(maths::decode_normal(stored, static_cast<std::uint32_t>(reading.normals.encoding)));
    const dmat4 view = now_.view_by(reading);
    if (reading.transposed_normals) return dvec3(view * view * dvec4(given, 0.0));
    if (!reading.normals.in_view_space) return dvec3(view * dvec4(given, 0.0));
    if (reading.normals.forward_z) given.z = -given.z;
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
      angles.at(2 * static_cast<std::size_t>(axis) + (own[axis] < 0.0 ? 1 : 0))
          .push_back(angle_between(own, given));
    });
    double largest = 0.0;
    for (const std::vector<double>& direction : angles)
      if (direction.size() >= kEnoughOfSome) largest = std::max(largest, quantile(direction, 0.75));
    return largest;
  }

  // Returns the median of these angles on continuous surfaces, where successive samples have nearly
  // the same normal, or 0 if there are too few. Leaves often have the normals of their crown.
  double typical_angle() const {
    std::vector<double> angles;
    std::size_t count = 0;
    dvec3 before(0.0, 0.0, 1.0);
    for_normals(given_, [&](const dvec3& own, const dvec3& given, double) {
      if (angle_between(own, before) < kSameSurface) angles.push_back(angle_between(own, given));
      before = own;
      ++count;
    });
    const bool judged = count >= kEnoughSamples && 5 * angles.size() >= 2 * count;
    return judged ? quantile(angles, 0.5) : 0.0;
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
    if (found == Mistake::count && now_.perspective && angles_to_view_axis_differ())
      found = Mistake::field_of_view;
    // Floors that are seen from above have the normals of ceilings that are seen from below.
    Reading flipped = given_;
    flipped.tangent_scale.y = -1.0;
    if (found == Mistake::count && facing_away(given_) > 0.2 && facing_away(flipped) < 0.02)
      found = Mistake::flipped;
    // A jitter in another unit shifts the whole projection.
    const double jitter =
        pictures_.size() > 1 ? maths::length(now_.jitter() - pictures_[1].jitter()) : 0.0;
    if (found != Mistake::count && jitter > kLargestJitter) {
      found = Mistake::jitter_wrong;
      findings_.set(Mistake::jitter_wrong, true, jitter);
    }
    const double typical = typical_angle();
    if (found == Mistake::count && typical > 25.0) found = Mistake::normals_disagree;
    for (const Mistake mistake :
         {Mistake::normal_space, Mistake::normal_encoding, Mistake::normal_forward_z,
          Mistake::normals_transposed, Mistake::view_inverted, Mistake::flipped,
          Mistake::image_too_large, Mistake::field_of_view, Mistake::normals_disagree})
      findings_.set(mistake, mistake == found, typical);
    return found == Mistake::count;
  }

  // Returns the mistake whose correction makes the given normals match those from depth, if there
  // is one. `now` is the error without a correction.
  Mistake best_reading(double now) const {
    // Normal maps tilt normals by some degrees from the surface.
    if (now < 4.0) return Mistake::count;
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
    reading.normals.in_view_space = !given_.normals.in_view_space;
    consider(Mistake::normal_space, reading);
    for (const bool other_space : {false, true}) {
      reading.normals.in_view_space = given_.normals.in_view_space != other_space;
      for (const AlcoveNormalEncoding encoding :
           {ALCOVE_NORMAL_ENCODING_SIGNED_XYZ, ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ,
            ALCOVE_NORMAL_ENCODING_OCTAHEDRAL, ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL}) {
        reading.normals.encoding = encoding;
        if (encoding != given_.normals.encoding) consider(Mistake::normal_encoding, reading);
      }
    }
    reading = given_;
    if (given_.normals.in_view_space) {
      reading.normals.forward_z = !given_.normals.forward_z;
      consider(Mistake::normal_forward_z, reading);
      reading = given_;
      reading.transposed_normals = true;
      consider(Mistake::normals_transposed, reading);
    } else {
      reading.invert_view = true;
      consider(Mistake::view_inverted, reading);
    }
    for_projections(now_, given_, [&](Mistake mistake, const Reading& projection) {
      if (mistake == Mistake::field_of_view) least = std::min(least, 3.1);
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
      if (!(in_same_direction > kSameAngleAboutAxis * own_across * stored_across)) return;
      const double ratio =
          std::log(own_across * std::abs(stored.z) / (stored_across * std::abs(own.z)));
      // The sensitivity is half the sine of twice the angle to the view axis. An error of the angle
      // changes the logarithm of the ratio by the error divided by the sensitivity.
      const double sensitivity =
          std::min(own_across * std::abs(own.z), stored_across * std::abs(stored.z));
      if (sensitivity * kRatioError > std::max(tilt_error, kStoredError)) exact.push_back(ratio);
      if (sensitivity > kOblique) oblique.push_back(ratio);
    });
    return is_another_scale(exact) || is_another_scale_with_noise(oblique);
  }

  // Returns true if more than half of the logarithms agree on a number that is not near 0.
  static bool is_another_scale(const std::vector<double>& logarithms) {
    if (logarithms.size() < kEnoughSamples) return false;
    const double median = quantile(logarithms, 0.5);
    const auto share_near = [&](double value) {
      return share_of(logarithms, [&](double log) { return std::abs(log - value) <= kRatioError; });
    };
    return std::abs(median) > kLeastScale && share_near(median) > 0.5 && share_near(0.0) < 0.1;
  }

  // Shading normals and normal maps make each logarithm uncertain, but not their median.
  static bool is_another_scale_with_noise(const std::vector<double>& logarithms) {
    if (logarithms.size() < kEnoughSamples) return false;
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
  if (is_seen) measures.at(static_cast<std::size_t>(mistake)) = static_cast<float>(measure);
}

Findings inspect(std::span<const InspectedFrame> frames) { return Inspector(frames).run(); }

}  // namespace alcove::passes

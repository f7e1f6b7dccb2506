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
constexpr double kOblique = 0.04;              // half the sine of twice the angle: 2 to 88 degrees
constexpr double kRatioError = 0.05;           // of the logarithm of a ratio, at most, to agree
constexpr double kLeastScale = 0.14;  // logarithm of 1.15, below which a scale is not reported

// Returns true if a number has at most so many significant digits, as near planes that people type.
bool is_round(double value, double digits) {
  if (!(value > 0.0) || !std::isfinite(value)) return false;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - (digits - 1.0));
  const double whole = value / unit;
  return std::abs(whole - std::round(whole)) <= 3e-7 * whole;
}

// Returns the angle between two normals in degrees, 0 to 180.
double angle_between(const dvec3& a, const dvec3& b) {
  const double length = maths::length(a) * maths::length(b);
  const double cosine = length > 0.0 ? maths::dot(a, b) / length : 0.0;
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees;
}

// Returns the normal, in view space and towards the eye, of the plane on which depth has a
// gradient. It is not normalised.
dvec3 plane_normal(const Eye& eye, const PixelSample& s, const dvec2& gradient, bool perspective) {
  // The plane in clip space, depth = slope.x * x + slope.y * y + offset, and then in view space.
  const dvec2 slope = 0.5 * gradient * eye.size;
  const double offset = s.depth - maths::dot(slope, eye.ndc(s));
  const dvec4 plane = maths::transpose(eye.clip_from_view) * dvec4(slope, -1.0, offset);
  const double to_eye = perspective ? plane.w : plane.z;
  return to_eye < 0.0 ? -dvec3(plane) : dvec3(plane);
}

class Inspector {
 public:
  explicit Inspector(std::span<const InspectedFrame> frames)
      : pictures_(frames.begin(), frames.end()),
        now_(pictures_.front()),
        frame_(now_.frame),
        eye_(now_.eye(given_)),
        reversed_(std::abs(now_.distance(0.0)) > std::abs(now_.distance(1.0 - 1e-7))) {
    given_.normals = normals_of(frame_.info, frame_.has_normals);
    // Cameras may be relative to an origin that moves. previous_camera then differs from the camera
    // that the last frame was recorded with in its translation alone.
    const AlcoveCamera& previous = frame_.info.previous_camera;
    if (pictures_.size() > 1 && same_rotation(previous, frames[1].info.camera) &&
        to_rigid(previous.view_from_world) != now_.view_from_world)
      pictures_[1].view_from_world = to_rigid(previous.view_from_world);
  }

  // Stops at the first mistake of the geometry, because others would be its consequences. Those of
  // the groups that are not compared are not noted.
  void run(Sightings& sightings) {
    const Mistake* found = nullptr;
    unsigned compared = 0;
    // Returns whether a group is compared: nothing is wrong so far, and there is what shows it.
    const auto compares = [&](MistakeGroup group, bool is_shown) {
      if (found != nullptr || !is_shown) return false;
      compared |= group;
      return true;
    };
    if (compares(kByDepth, true)) found = mistake_of_depth();
    if (compares(kBySurfaces, surfaces() >= kEnoughSamples)) found = mistake_of_surfaces();
    if (compares(kByNormals, frame_.has_normals)) found = mistake_of_normals();
    const bool continues = pictures_.size() > 1 && frame_.continues_history();
    if (continues) note_size(sightings);
    if (continues && frame_.info.static_frames > 0) {
      if (found == nullptr) sightings.note(mistakes::static_in_motion, changes());
    } else if (compares(kByCameras, continues)) {
      const CameraFit fit = fit_cameras(pictures_, given_);
      found = fit.mistake;
      measure_ = fit.measure;
      const auto motion =
          frame_.has_motion ? mistake_of_motion(pictures_, given_, fit.share) : std::nullopt;
      if (motion) sightings.note_groups(kByMotion, *motion);
    }
    if ((compared & (kByNormals | kByCameras)) != 0) compared |= kByGeometry;
    sightings.note_groups(compared, found, measure_);
  }

 private:
  // The number of samples that are not of the sky.
  std::size_t surfaces() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        frame_.samples, [](const PixelSample& s) { return !is_sky(s.depth); }));
  }

  // Returns the first mistake that shows in depth, whatever is seen, or null.
  const Mistake* mistake_of_depth() const {
    if (is_too_small()) return &mistakes::image_too_small;
    if (is_depth_outside()) return &mistakes::depth_outside;
    if (is_converted_from_minus_one()) return &mistakes::depth_converted_from_minus_one;
    if (is_depth_reversed()) return &mistakes::depth_reversed;
    return near_is_round_with(1.0) ? &mistakes::depth_from_minus_one : nullptr;
  }

  // Returns the first mistake that shows in the depth of surfaces.
  const Mistake* mistake_of_surfaces() const {
    if (is_depth_filtered()) return &mistakes::depth_filtered;
    if (is_another_format()) return &mistakes::depth_format;
    return mistake_of_radius();
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
    std::size_t at_near = 0, at_far = 0, close = 0;
    const double near = now_.distance(near_depth);
    for (const PixelSample& sample : frame_.samples) {
      at_near += sample.depth == near_depth;
      at_far += sample.depth == 1.0f - near_depth;
      close += !is_sky(sample.depth) && now_.distance(sample.depth) < 1.3 * near;
    }
    if (at_far == 0 && at_near * 50 > frame_.samples.size()) return true;
    return now_.perspective && at_far == 0 && surfaces() >= kEnoughSamples &&
           static_cast<double>(close) > 0.95 * static_cast<double>(surfaces());
  }

  // A projection has the same form for OpenGL's depth range of -1 to 1 as for 0 to 1, but the near
  // plane is a round number only for the range for which the matrix was made. Returns whether it is
  // one if `offset` is added to depth, and not without.
  bool near_is_round_with(double offset) const {
    const dmat4& m = now_.clip_from_view;
    // The clip-space depth of a perspective projection is x + y / z.
    const dvec2 c = dvec2(m[2][2], m[3][2]) / m[2][3];
    return now_.perspective && !reversed_ && is_round(std::abs(c.y / (c.x + offset)), 2.0) &&
           !is_round(std::abs(c.y / c.x), 4.0);
  }

  // Returns whether a projection with depth from 0 to 1 was converted as if it were OpenGL's. The
  // depths 0 and 1 then may not both lie before the eye.
  bool is_converted_from_minus_one() const {
    const double at_0 = now_.distance(0.0), at_1 = now_.distance(1.0);
    const double nearer = std::min(at_0, at_1);  // behind the eye if it is negative
    const bool behind = nearer < 0.0 && -nearer < 100.0 * std::max(at_0, at_1);
    return (now_.perspective && behind) || near_is_round_with(-0.5);
  }

  // Compares the steps of the depths with those of 16 bits. Other formats cannot be told apart.
  bool is_another_format() const {
    std::set<float> depths;
    for (const PixelSample& sample : frame_.samples)
      if (!is_sky(sample.depth)) depths.insert(sample.depth);
    const double in_steps = share_of(depths, [](float depth) {
      return std::abs(65535.0 * depth - std::round(65535.0 * depth)) < 0.01;
    });
    const bool says_16_bits = now_.depth_step(0.0f) == 1.0 / 65535.0;
    return depths.size() >= kEnoughSamples && (says_16_bits ? in_steps < 0.1 : in_steps > 0.99);
  }

  const Mistake* mistake_of_radius() const {
    const double radius = frame_.settings.radius;
    std::vector<double> heights;  // of the radius at each sample, in heights of the image
    std::array<std::vector<double>, 3> places;
    const double scale = 0.5 * std::abs(now_.clip_from_view[1][1]);
    for (const PixelSample& s : frame_.samples) {
      if (is_sky(s.depth)) continue;
      const dvec4 place = now_.view_from_clip * dvec4(eye_.ndc(s), s.depth, 1.0);
      heights.push_back(radius * scale / (now_.perspective ? -place.z / place.w : 1.0));
      for (int i = 0; i < 3; ++i)
        places.at(static_cast<std::size_t>(i)).push_back(place[i] / place.w);
    }
    // The size of what is seen.
    double extent = 0.0;
    for (const std::vector<double>& place : places)
      extent = std::max(extent, quantile(place, 0.95) - quantile(place, 0.05));
    // The radius is too small if it spans less than a pixel at 90 % of the samples. It is too large
    // if it spans more than two image heights at 90 %, or half of one and half of what is seen.
    if (quantile(heights, 0.9) * frame_.size.height < 1.0) return &mistakes::radius_too_small;
    const double small = quantile(heights, 0.1);
    return small > 2.0 || (small > 0.5 && radius > 0.5 * extent) ? &mistakes::radius_too_large
                                                                 : nullptr;
  }

  // A normal from depth and the given one at the same sample.
  struct Normals {
    dvec3 own;
    dvec3 given;
  };

  // Returns the normals of the samples on smooth surfaces. Samples at which the depth format is so
  // coarse that it would tilt the normal are left out.
  std::vector<Normals> normals(const Reading& reading) const {
    const Eye eye = now_.eye(reading);
    std::vector<Normals> result;
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const PixelSample& s = frame_.samples[i];
      const maths::vec3 stored{s.normal[0], s.normal[1], s.normal[2]};
      if (!now_.gradients[i] || !maths::has_direction(stored)) continue;
      const dvec3 own = plane_normal(eye, s, *now_.gradients[i], now_.perspective);
      const dvec3 tilted = plane_normal(eye, s, *now_.gradients[i] + 0.5 * now_.depth_step(s.depth),
                                        now_.perspective);
      if (angle_between(own, tilted) <= 0.02 * kDegrees)
        result.push_back({own, given_normal(stored, reading, eye.view_from_world)});
    }
    return result;
  }

  static dvec3 given_normal(const maths::vec3& stored, const Reading& reading, const dmat4& view) {
    dvec3 given(maths::decode_normal(stored, static_cast<std::uint32_t>(reading.normals.encoding)));
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
    for (const auto& [own, given] : normals(reading)) {
      const dvec3 size = maths::abs(own);
      const int axis = size.x > std::max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
      angles.at(2 * static_cast<std::size_t>(axis) + (own[axis] < 0.0 ? 1 : 0))
          .push_back(angle_between(own, given));
    }
    double largest = 0.0;
    for (const std::vector<double>& direction : angles)
      if (direction.size() >= kEnoughOfSome) largest = std::max(largest, quantile(direction, 0.75));
    return largest;
  }

  // Returns the median of these angles on continuous surfaces, where successive samples have nearly
  // the same normal, or 0 if there are too few. Leaves often have the normals of their crown, and
  // may be seen from behind.
  double typical_angle() const {
    const std::vector<Normals> all = normals(given_);
    std::vector<double> angles;
    dvec3 before(0.0, 0.0, 1.0);
    for (const auto& [own, given] : all) {
      const double angle = angle_between(own, given);
      if (angle_between(own, before) < kSameSurface)
        angles.push_back(std::min(angle, 180.0 - angle));
      before = own;
    }
    const bool judged = all.size() >= kEnoughSamples && 5 * angles.size() >= 2 * all.size();
    return judged ? quantile(angles, 0.5) : 0.0;
  }

  // Returns the mistake that shows in depth and normals, or null.
  const Mistake* mistake_of_normals() {
    const Mistake* found = best_reading(error_of(given_));
    if (found == nullptr && now_.perspective && angles_to_view_axis_differ())
      found = &mistakes::field_of_view;
    // A jitter in another unit shifts the whole projection.
    const double jitter =
        pictures_.size() > 1 ? maths::length(now_.jitter() - pictures_[1].jitter()) : 0.0;
    if (found != nullptr && jitter > kLargestJitter) {
      measure_ = jitter;
      return &mistakes::jitter_wrong;
    }
    measure_ = typical_angle();
    return found == nullptr && measure_ > 25.0 ? &mistakes::normals_disagree : found;
  }

  // Returns the mistake whose correction makes the given normals match those from depth, if there
  // is one. `now` is the error without a correction.
  const Mistake* best_reading(double now) const {
    // Normal maps tilt normals by some degrees from the surface.
    if (now < 4.0) return nullptr;
    double least = std::min(0.4 * now, 15.0);
    const Mistake* best = nullptr;
    const auto consider = [&](const Mistake* mistake, const Reading& reading) {
      const double error = error_of(reading);
      if (error < least - 0.1) {
        least = error;
        best = mistake;
      }
    };
    Reading reading = given_;
    for (const bool other_space : {true, false}) {
      reading.normals.in_view_space = given_.normals.in_view_space != other_space;
      for (const AlcoveNormalEncoding encoding :
           {given_.normals.encoding, ALCOVE_NORMAL_ENCODING_SIGNED_XYZ,
            ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ, ALCOVE_NORMAL_ENCODING_OCTAHEDRAL,
            ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL}) {
        reading.normals.encoding = encoding;
        consider(encoding == given_.normals.encoding ? &mistakes::normal_space
                                                     : &mistakes::normal_encoding,
                 reading);
      }
    }
    reading = given_;
    if (given_.normals.in_view_space) {
      reading.normals.forward_z = !given_.normals.forward_z;
      consider(&mistakes::normal_forward_z, reading);
      reading = given_;
      reading.transposed_normals = true;
      consider(&mistakes::normals_transposed, reading);
    } else {
      reading.invert_view = true;
      consider(&mistakes::view_inverted, reading);
    }
    for_projections(now_, given_, [&](const Mistake* mistake, const Reading& projection) {
      if (mistake == &mistakes::field_of_view) least = std::min(least, 3.1);
      consider(mistake, projection);
    });
    return best;
  }

  // Compares the angles between normals and the view axis: those of normals from depth with those
  // of given normals. A wrong angle of view multiplies the tangent of every such angle by one
  // number. Returns true if more than half of the ratios agree on one that is not near 1. Surfaces
  // that are parallel or perpendicular to the view axis keep their angle and are left out.
  bool angles_to_view_axis_differ() const {
    std::vector<double> logarithms;  // of the ratio of the tangents
    for (const auto& pair : normals(given_)) {
      const dvec3 own = maths::normalize(pair.own), given = maths::normalize(pair.given);
      const double own_across = std::hypot(own.x, own.y);
      const double given_across = std::hypot(given.x, given.y);
      const double side = own.z * given.z < 0.0 ? -1.0 : 1.0;  // either may face away
      // An angle of view does not rotate a normal about the view axis.
      const double in_same_direction = side * (own.x * given.x + own.y * given.y);
      const double oblique = std::min(own_across * std::abs(own.z),  // half the sine of twice the
                                      given_across * std::abs(given.z));  // angle to the view axis
      if (in_same_direction > kSameAngleAboutAxis * own_across * given_across && oblique > kOblique)
        logarithms.push_back(
            std::log(own_across * std::abs(given.z) / (given_across * std::abs(own.z))));
    }
    if (logarithms.size() < kEnoughSamples) return false;
    const double median = quantile(logarithms, 0.5);
    const auto share_near = [&](double value) {
      return share_of(logarithms, [&](double log) { return std::abs(log - value) <= kRatioError; });
    };
    return std::abs(median) > kLeastScale && share_near(median) > 0.5 && share_near(0.0) < 0.1;
  }

  // A size that changes within images of one size shows in frames in which it changes.
  void note_size(Sightings& sightings) const {
    const InspectedFrame& before = pictures_[1].frame;
    if (to_vector(frame_.size) != to_vector(before.size)) {
      sightings.note(mistakes::size_changes,
                     to_vector(frame_.depth_size) == to_vector(before.depth_size) &&
                         frame_.info.largest_width == 0);
    }
  }

  // Returns whether depth changed.
  bool changes() const {
    std::size_t changed = 0;
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const float a = frame_.samples[i].depth, b = pictures_[1].frame.samples[i].depth;
      changed += std::abs(double{a} - b) > 4.0 * now_.depth_step(a);
    }
    return changed * 50 > frame_.samples.size();
  }

  std::vector<Picture> pictures_;  // this frame, then earlier ones
  const Picture& now_;
  const InspectedFrame& frame_;
  Reading given_;
  Eye eye_;
  bool reversed_;
  double measure_ = 0.0;  // the number of the sentence of the mistake that was found
};

}  // namespace

void inspect(std::span<const InspectedFrame> frames, Sightings& sightings) {
  Inspector(frames).run(sightings);
}

}  // namespace alcove::passes

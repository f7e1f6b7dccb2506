#include "diagnose/inspect.h"

#include <array>
#include <bit>
#include <set>

#include "diagnose/picture.h"
#include "maths/normal_encoding.h"

namespace alcove::passes {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

// The angle in degrees below which normals count as equal: their format rounds them.
constexpr double kSameNormal = 0.5;
constexpr double kSameSurface = 15.0;  // degrees between the normals of successive samples

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
dvec3 plane_normal(const Eye& eye, const PixelSample& s, const dvec2& gradient) {
  // The plane in clip space, depth = slope.x * x + slope.y * y + offset, and then in view space.
  const dvec2 slope = 0.5 * gradient * eye.size;
  const double offset = s.depth - maths::dot(slope, eye.ndc(s));
  const dvec4 plane = dvec4(slope, -1.0, offset) * eye.clip_from_view;
  const bool perspective = eye.clip_from_view[3][3] == 0.0;
  return (perspective ? plane.w : plane.z) < 0.0 ? -dvec3(plane) : dvec3(plane);
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
    choose_samples();
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
    const bool sees_surfaces = surfaces() >= kEnoughSamples;
    if (compares(kBySurfaces, sees_surfaces)) found = mistake_of_surfaces();
    if (compares(kByNormals, frame_.has_normals)) found = mistake_of_normals();
    const bool continues = pictures_.size() > 1 && frame_.continues_history();
    if (continues) note_size(sightings);
    if (continues && frame_.info.static_frames > 0) {
      if (found == nullptr) sightings.note(mistakes::static_in_motion, depth_changes());
    } else if (compares(kByCameras, continues)) {
      const double error = std::max(2.0, error_of(given_));
      const CameraFit fit = fit_cameras(
          pictures_, given_, [&](const Reading& reading) { return error_of(reading) <= error; });
      found = fit.mistake;
      measure_ = fit.measure;
      const auto motion =
          frame_.has_motion ? mistake_of_motion(pictures_, given_, fit.share) : std::nullopt;
      if (motion) sightings.note_groups(kByMotion, *motion);
    }
    if (compares(kByRadius, sees_surfaces)) found = mistake_of_radius();
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
    if (is_another_format()) return &mistakes::depth_format;
    if (!is_surface()) return &mistakes::not_surfaces;
    if (is_depth_filtered()) return &mistakes::depth_filtered;
    return is_curved() ? &mistakes::depth_curved : nullptr;
  }

  bool is_too_small() const {
    return is_smaller(frame_.depth_size, frame_.size) ||
           (frame_.has_normals && is_smaller(frame_.normals_size, frame_.size));
  }

  bool is_depth_outside() const {
    return share_of(frame_.samples,
                    [](const PixelSample& s) { return s.depth < 0.0f || s.depth > 1.0f; }) > 0.02;
  }

  // Calls `call` with the depths of each three pixels in a row or a column, none of the sky.
  template <typename Call>
  void for_lines(const Call& call) const {
    for (const PixelSample& s : frame_.samples)
      for (const auto& [a, c] : {std::pair{s.left, s.right}, std::pair{s.up, s.down}})
        if (!is_sky(a) && !is_sky(s.depth) && !is_sky(c))
          call(double{a}, double{s.depth}, double{c});
  }

  // At the edge of an object each pixel has the depth of one of two surfaces. A linear filter gives
  // it a depth between them, which is neither theirs nor, as on a steep surface, their mean.
  bool is_depth_filtered() const {
    std::size_t edges = 0, between = 0;
    for_lines([&](double before, double here, double after) {
      const double a = now_.distance(before), b = now_.distance(here), c = now_.distance(after);
      const auto [least, most] = std::minmax({std::abs(here - before), std::abs(after - here)});
      if (std::abs(a - c) < 0.15 * b || least > 0.8 * most) return;
      ++edges;
      between += (b - a) * (c - b) > 0.0 && least > 0.2 * most;
    });
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

  // Compares the steps of the depths with those of 16 bits and of half floats, whose last 13 bits
  // are 0. Other formats cannot be told apart.
  bool is_another_format() const {
    std::set<float> depths;
    for (const PixelSample& sample : frame_.samples)
      if (!is_sky(sample.depth)) depths.insert(sample.depth);
    const double in_steps = share_of(depths, [](float depth) {
      return std::abs(65535.0 * depth - std::round(65535.0 * depth)) < 0.01;
    });
    const double halves = share_of(
        depths, [](float depth) { return (std::bit_cast<std::uint32_t>(depth) & 0x1fffu) == 0; });
    const bool says_16_bits = now_.depth_step(0.0f) == 1.0 / 65535.0;
    return depths.size() >= kEnoughSamples &&
           (says_16_bits ? in_steps < 0.1 : std::max(in_steps, halves) > 0.99);
  }

  // Returns whether neighbouring pixels are related as those of surfaces are, of leaves too: a few
  // lie on planes, and where depth has a slope few pixels repeat that of a neighbour in x and in y.
  bool is_surface() const {
    std::size_t smooth = 0, sloped = 0, repeated = 0;
    const double least = 16.0 * now_.depth_step(1.0f);
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const PixelSample& s = frame_.samples[i];
      smooth += now_.gradients[i].has_value();
      const auto steps = [&](float a, float b) {
        return std::minmax({std::abs(double{a} - s.depth), std::abs(double{b} - s.depth)});
      };
      const auto x = steps(s.left, s.right), y = steps(s.up, s.down);
      sloped += std::max(x.second, y.second) > least;
      repeated += x.first == 0.0 && y.first == 0.0 && std::min(x.second, y.second) > least;
    }
    return 100 * smooth >= surfaces() && (sloped < kEnoughSamples || 8 * repeated <= sloped);
  }

  // Returns whether the depths of planes become linear in screen space, as those of a projection
  // are, if they are read as a distance or its logarithm.
  bool is_curved() const {
    std::vector<dvec3> lines;
    for_lines([&](double before, double here, double after) {
      const double steps = std::abs(after - before), bend = std::abs(before + after - 2.0 * here);
      if (steps > 1e-3 && bend < 0.3 * steps) lines.emplace_back(before, here, after);
    });
    if (lines.size() < kEnoughSamples) return false;
    const auto curvature = [&](const auto& read) {
      std::vector<double> curvatures;
      for (const dvec3& line : lines) {
        const double a = read(line.x), c = read(line.z);
        curvatures.push_back(std::abs((a + c - 2.0 * read(line.y)) / (c - a)));
      }
      return quantile(curvatures, 0.5);
    };
    const double least = 0.15 * curvature([](double depth) { return depth; });
    // The logarithm of 1 plus the distance times a factor, over that of the far plane. At small
    // rates it is the distance itself.
    for (double rate = 0.1; rate < 25.0 && least > 1e-4; rate *= 1.1)
      if (curvature([&](double depth) { return 1.0 / std::expm1(rate * depth); }) < least)
        return true;
    return false;
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

  // A sample whose normal is given, and known from depth.
  struct SmoothSample {
    std::size_t index;
    std::size_t direction;  // of six, in which its normal from depth points
  };

  // Leaves out where the format of depth is so coarse that it would tilt the normal.
  void choose_samples() {
    for (std::size_t i = 0; i < frame_.samples.size(); ++i) {
      const PixelSample& s = frame_.samples[i];
      const auto& gradient = now_.gradients[i];
      if (!gradient || !maths::has_direction({s.normal[0], s.normal[1], s.normal[2]})) continue;
      const dvec3 own = plane_normal(eye_, s, *gradient), size = maths::abs(own);
      const dvec3 tilted = plane_normal(eye_, s, *gradient + 0.5 * now_.depth_step(s.depth));
      if (angle_between(own, tilted) > 0.02 * kDegrees) continue;
      const std::size_t axis = size.x > std::max(size.y, size.z) ? 0 : size.y > size.z ? 1 : 2;
      smooth_.push_back({i, 2 * axis + (own[static_cast<int>(axis)] < 0.0 ? 1 : 0)});
    }
  }

  // A normal from depth and the given one at the same sample.
  struct Normals {
    dvec3 own;
    dvec3 given;
  };

  std::vector<Normals> normals(const Reading& reading) const {
    const Eye eye = now_.eye(reading);
    dmat4 view_from_given(1.0);
    if (reading.transposed_normals)
      view_from_given = eye.view_from_world * eye.view_from_world;
    else if (!reading.normals.in_view_space)
      view_from_given = eye.view_from_world;
    else if (reading.normals.forward_z)
      view_from_given[2][2] = -1.0;
    std::vector<Normals> result;
    for (const auto& [i, direction] : smooth_) {
      const PixelSample& s = frame_.samples[i];
      const dvec3 given(maths::decode_normal({s.normal[0], s.normal[1], s.normal[2]},
                                             static_cast<std::uint32_t>(reading.normals.encoding)));
      result.push_back(
          {plane_normal(eye, s, *now_.gradients[i]), dvec3(view_from_given * dvec4(given, 0.0))});
    }
    return result;
  }

  // Returns the typical angle, in degrees, between the normals of depth and the given ones: the
  // geometric mean, so that a reading counts where it makes normals equal. Each direction with
  // enough samples counts the same: a floor that fills most of the image would hide mistakes,
  // because its normal may be the same in many readings.
  double error_of(const Reading& reading) const {
    const std::vector<Normals> all = normals(reading);
    std::array<std::vector<double>, 6> logarithms;
    for (std::size_t i = 0; i < all.size(); ++i)
      logarithms.at(smooth_[i].direction)
          .push_back(std::log(angle_between(all[i].own, all[i].given) + kSameNormal));
    std::vector<double> means;
    for (const auto& each : logarithms)
      if (each.size() >= kEnoughOfSome) means.push_back(std::exp(mean(each)));
    return mean(means);
  }

  // Returns the median angle between these normals on continuous surfaces, where successive samples
  // have nearly the same normal, or 0 if there are too few. Leaves often have the normals of their
  // crown, and may be seen from behind.
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
    const Mistake* found = best_reading();
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
  // is one.
  const Mistake* best_reading() const {
    double least = 0.4 * error_of(given_);
    if (least <= kSameNormal) return nullptr;
    const Mistake* best = nullptr;
    // What the cameras explain from frame to frame, a remedy must explain too.
    const bool moves = pictures_.size() > 1 && frame_.continues_history();
    const bool fits = moves && share_explained(pictures_, given_) > kMisfits;
    const auto consider = [&](const Mistake* mistake, const Reading& reading) {
      const double error = error_of(reading);
      if (error > 0.9 * least || (fits && share_explained(pictures_, reading) <= kMisfits)) return;
      least = error;
      best = mistake;
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
    }
    for_cameras(now_, given_, consider);
    return best;
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

  bool depth_changes() const {
    return share_of(frame_.samples, [&](const PixelSample& s) {
             const auto i = static_cast<std::size_t>(&s - frame_.samples.data());
             return std::abs(s.depth - double{pictures_[1].frame.samples[i].depth}) >
                    4.0 * now_.depth_step(s.depth);
           }) > 0.02;
  }

  std::vector<Picture> pictures_;  // this frame, then earlier ones
  const Picture& now_;
  const InspectedFrame& frame_;
  Reading given_;
  Eye eye_;
  bool reversed_;
  std::vector<SmoothSample> smooth_;
  double measure_ = 0.0;  // the number of the sentence of the mistake that was found
};

}  // namespace

void inspect(std::span<const InspectedFrame> frames, Sightings& sightings) {
  Inspector(frames).run(sightings);
}

}  // namespace alcove::passes

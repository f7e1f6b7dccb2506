#include <array>

#include "diagnose/picture.h"
#include "inspect_parameters.h"

namespace alcove::passes {
namespace {

using maths::kInspectColumns;
using maths::kInspectRows;

// Limits for the comparison of successive frames.
constexpr double kSamePlace = 0.15;  // pixels
constexpr double kFits = 0.75;       // the share of the samples at the same place if cameras fit
constexpr double kMisfits = 0.5;     // the share at most if they do not

// How far a sample is from the place at which the cameras expect it in the earlier frame. Only the
// distance in the direction of the gradient of depth shows.
struct Displacement {
  dvec2 direction;
  double distance = 0.0;  // pixels
  dvec3 by_translation;   // its derivative by the translation of the camera
  // The distance would be clearly another without the camera's translation or without any motion.
  // The depths of a floor, for example, stay the same when the camera moves along it or turns.
  bool shows_motion = false;
};

double share_at(const std::vector<Displacement>& displacements, const dvec2& shift) {
  return share_of(displacements, [&](const Displacement& d) {
    return std::abs(d.distance - maths::dot(d.direction, shift)) <= kSamePlace;
  });
}

// The share of the samples that a hypothesis explains: of all, or of those that show the camera's
// motion, if these are enough and their share is smaller.
double explained(std::vector<Displacement> displacements, const dvec2& shift = dvec2(0.0)) {
  if (displacements.size() < kEnoughSamples) return 0.0;
  const double of_all = share_at(displacements, shift);
  std::erase_if(displacements, [](const Displacement& d) { return !d.shows_motion; });
  return displacements.size() < kEnoughOfSome ? of_all
                                              : std::min(of_all, share_at(displacements, shift));
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

class MotionInspector {
 public:
  MotionInspector(const std::vector<Picture>& pictures, const Reading& given, Findings& findings)
      : pictures_(pictures),
        now_(pictures.front()),
        frame_(now_.frame),
        given_(given),
        findings_(findings) {}

  void run() {
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
    const double share = explained(by_cameras);
    double measure = 100.0 * (1.0 - share);
    const Mistake found = share > kMisfits
                              ? Mistake::count
                              : mistake_of_cameras(by_cameras, share_of_all, share, measure);
    for (const Mistake mistake :
         {Mistake::camera_of_another_frame, Mistake::jitter_missing, Mistake::jitter_unused,
          Mistake::jitter_wrong, Mistake::translation_scale, Mistake::translation_wrong,
          Mistake::no_translation, Mistake::cameras_disagree, Mistake::image_too_large,
          Mistake::field_of_view, Mistake::flipped, Mistake::view_inverted})
      if (mistake == found || (findings_.seen >> static_cast<int>(mistake) & 1u) == 0)
        findings_.set(mistake, mistake == found, measure);
    if (share > kMisfits && frame_.has_motion) inspect_motion_vectors(share > kFits);
  }

 private:
  // Returns the matrix from the view space of `now` to that of `before`.
  static dmat4 camera_motion(const Picture& now, const Picture& before, const Reading& reading) {
    dmat4 motion = before.view_by(reading) * maths::inverse(now.view_by(reading));
    if (reading.translation) motion[3] = dvec4(*reading.translation, 1.0);
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
      if (is_sky(s.depth) || !(clip.w > 0.0)) continue;
      const auto to_pixel = [&](const dvec4& p) {
        return (0.5 * dvec2(p) / p.w + 0.5) * before.size(reading);
      };
      const dvec2 pixel = to_pixel(clip);
      const dvec2 cell = pixel * grid - 0.5;  // between four samples
      if (!(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < kInspectColumns - 1.0 &&
            cell.y < kInspectRows - 1.0))
        continue;
      const auto sample_at = [](double x, double y) {
        return static_cast<std::size_t>(y) * kInspectColumns + static_cast<std::size_t>(x);
      };
      const std::size_t nearest = sample_at(cell.x + 0.5, cell.y + 0.5);
      const auto& gradient = before.gradients[nearest];
      if (!gradient) continue;
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
        const double place_w = (from * ndc).w;
        dvec3 by_translation;
        for (int axis = 0; axis < 3; ++axis) {
          const dvec4 change = place_w / clip.w * (to[axis] - clip * (to[axis].w / clip.w));
          by_translation[axis] =
              (change.z - 0.5 * maths::dot(*gradient, dvec2(change) * before.size(reading))) /
              slope;
        }
        result.push_back({*gradient / slope, here, by_translation,
                          std::abs(distance(by_rotation * ndc) - here) > 2.0 * kSamePlace ||
                              std::abs(distance(without_motion * ndc) - here) > 2.0 * kSamePlace});
      }
    }
    return result;
  }

  // Returns the translation of the camera that explains the depths best, by least squares without
  // outliers, beginning with a camera that does not move.
  dvec3 best_translation() const {
    Reading reading = given_;
    reading.translation = dvec3(0.0);
    for (const double limit : {30.0, 20.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5, 0.3, 0.3}) {
      maths::dmat3 matrix(1e-12);
      dvec3 sum(0.0);
      for (const Displacement& d : displacements(now_, pictures_[1], now_, pictures_[1], reading)) {
        if (std::abs(d.distance) > limit) continue;
        matrix += maths::outerProduct(d.by_translation, d.by_translation);
        sum += d.by_translation * d.distance;
      }
      *reading.translation -= maths::inverse(matrix) * sum;
    }
    return *reading.translation;
  }

  // Returns the mistake that explains why the cameras do not fit depth from frame to frame.
  // `share_of_all` is the share of all samples at the place that the cameras say, and `share` that
  // of the samples that show the camera's motion, if it is smaller. A hypothesis must explain most
  // samples, and more than those before it, which are simpler.
  Mistake mistake_of_cameras(const std::vector<Displacement>& by_cameras, double share_of_all,
                             double share, double& measure) const {
    const Picture& before = pictures_[1];
    Mistake best = Mistake::count;
    double most = std::max(kFits, share + 0.3);
    const auto consider = [&](Mistake mistake, double its_measure,
                              const std::vector<Displacement>& other,
                              const dvec2& shift = dvec2(0.0)) {
      const double its_share = explained(other, shift);
      if (its_share <= most) return;
      most = its_share + 0.02;
      best = mistake;
      measure = its_measure;
    };
    const auto by = [&](const Reading& reading) {
      return displacements(now_, before, now_, before, reading);
    };
    if (pictures_.size() > 2) {
      const Picture& oldest = pictures_[2];
      consider(Mistake::camera_of_another_frame, 0.0,
               displacements(before, oldest, now_, before, given_));
      consider(Mistake::camera_of_another_frame, 0.0,
               displacements(now_, before, before, oldest, given_));
    }
    Reading reading = given_;
    reading.invert_view = true;
    consider(Mistake::view_inverted, 0.0, by(reading));
    for_projections(now_, given_, [&](Mistake mistake, const Reading& projection) {
      consider(mistake, 0.0, by(projection));
    });
    // Jitter: the whole image is shifted from where the cameras expect it.
    const dvec2 in_cameras = now_.jitter() - before.jitter();
    for (const dvec2& begin : {dvec2(0.0), in_cameras}) {
      const dvec2 shift = common_shift(by_cameras, begin);
      const dvec2 in_depth = in_cameras - shift;
      if (std::abs(in_depth.x) < 1.2 && std::abs(in_depth.y) < 1.2) {
        consider(maths::length(in_cameras) < 0.02 ? Mistake::jitter_missing
                 : maths::length(in_depth) < 0.1  ? Mistake::jitter_unused
                                                  : Mistake::jitter_wrong,
                 maths::length(shift), by_cameras, shift);
      }
    }
    const dvec3 translation(camera_motion(now_, before, given_)[3]);
    reading = given_;
    reading.translation = best_translation();
    const double length = maths::length(translation);
    const double scale = maths::dot(*reading.translation, translation) / (length * length);
    const bool is_scaled =
        scale > 0.0 && maths::length(*reading.translation - scale * translation) <
                           0.1 * maths::length(*reading.translation);
    const auto has_translation = [](const Picture& picture) {
      return dvec3(picture.view_from_world[3]) != dvec3(0.0);
    };
    const bool has_none = !has_translation(now_) && !has_translation(before);
    consider(has_none    ? Mistake::no_translation
             : is_scaled ? Mistake::translation_scale
                         : Mistake::translation_wrong,
             scale, by(reading));
    if (best != Mistake::count) return best;
    measure = 100.0 * (1.0 - share);
    if (has_none) return Mistake::no_translation;
    // Where objects move, depth alone does not tell whether the cameras fit.
    if (by_cameras.size() < kEnoughSamples || share_of_all > 0.25 || frame_.has_motion)
      return Mistake::count;
    if (maths::length(in_cameras) > kLargestJitter) {
      measure = maths::length(in_cameras);
      return Mistake::jitter_wrong;
    }
    return Mistake::cameras_disagree;
  }

  // Compares the motion vectors with the motion that the cameras give to static surfaces.
  // `is_static` says that depth shows almost no other motion.
  void inspect_motion_vectors(bool is_static) {
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
    if (vectors.size() < kEnoughSamples || quantile(lengths, 0.5) < 0.3) return;
    const dvec2 scale(frame_.motion.scale[0], frame_.motion.scale[1]);
    const dvec2 offset(frame_.motion.offset[0], frame_.motion.offset[1]);
    const auto share = [&](const dvec2& factor, const dvec2& shift) {
      return share_of(vectors, [&](const Vector& v) {
        const dvec2 given = (scale * v.stored * factor + offset) * size + shift;
        return maths::length(given - v.by_cameras) <= 0.1 + 0.05 * maths::length(v.by_cameras);
      });
    };
    // Returns the offset of most vectors in pixels.
    const auto common_offset = [&](const dvec2& factor) {
      std::array<std::vector<double>, 2> rests;
      for (const Vector& v : vectors)
        for (int i = 0; i < 2; ++i)
          rests.at(static_cast<std::size_t>(i))
              .push_back(v.by_cameras[i] -
                         (scale[i] * v.stored[i] * factor[i] + offset[i]) * size[i]);
      return dvec2(quantile(rests[0], 0.5), quantile(rests[1], 0.5));
    };
    const double given = share(dvec2(1.0), dvec2(0.0));
    const bool is_zero = share_of(vectors, [&](const Vector& v) {
                           return maths::length(scale * v.stored * size) < 0.02;
                         }) > 0.9;
    Mistake found = Mistake::count;
    if (given < kMisfits && is_zero) {
      found = Mistake::motion_zero;
    } else if (given < kMisfits) {
      double most = std::max(kFits, given + 0.3);
      for (const bool has_offset : {false, true}) {
        for (const dvec2& unit : {dvec2(1.0), dvec2(0.5), dvec2(2.0), 1.0 / size, size}) {
          for (int signs = 0; signs < 4; ++signs) {
            const dvec2 factor =
                unit * dvec2((signs & 1) != 0 ? -1.0 : 1.0, (signs & 2) != 0 ? -1.0 : 1.0);
            const dvec2 shift = has_offset ? common_offset(factor) : dvec2(0.0);
            // With another unit or sign, only a jitter is likely to be missing too.
            if (factor != dvec2(1.0) && maths::length(shift) > kLargestJitter) continue;
            const double other = share(factor, shift);
            if (other > most + 0.02) {
              most = other;
              found = unit != dvec2(1.0) ? Mistake::motion_unit
                      : signs != 0       ? Mistake::motion_sign
                                         : Mistake::motion_offset;
            }
          }
        }
      }
      if (found == Mistake::count && is_static && given < 0.25) found = Mistake::motion_disagrees;
    }
    for (const Mistake mistake : {Mistake::motion_zero, Mistake::motion_sign, Mistake::motion_unit,
                                  Mistake::motion_offset, Mistake::motion_disagrees})
      findings_.set(mistake, mistake == found);
  }

  const std::vector<Picture>& pictures_;  // this frame, then earlier ones
  const Picture& now_;
  const InspectedFrame& frame_;
  const Reading& given_;
  Findings& findings_;
};

}  // namespace

void inspect_motion(const std::vector<Picture>& pictures, const Reading& given,
                    Findings& findings) {
  MotionInspector(pictures, given, findings).run();
}

}  // namespace alcove::passes

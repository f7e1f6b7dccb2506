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
    const double share = std::min(share_of_all, share_in_motion(by_cameras).value_or(1.0));
    double measure = 100.0 * (1.0 - share);
    const Mistake found = share > kMisfits
                              ? Mistake::count
                              : mistake_of_cameras(by_cameras, share_of_all, share, measure);
    for (const Mistake mistake :
         {Mistake::camera_of_another_frame, Mistake::jitter_missing, Mistake::jitter_unused,
          Mistake::jitter_wrong, Mistake::translation_scale, Mistake::no_translation,
          Mistake::cameras_disagree, Mistake::image_too_large, Mistake::field_of_view,
          Mistake::flipped_y, Mistake::view_inverted})
      if (mistake == found || (findings_.seen >> static_cast<int>(mistake) & 1u) == 0)
        findings_.set(mistake, mistake == found, measure);
    if (found == Mistake::count && share > kMisfits && frame_.has_motion) inspect_motion_vectors();
  }

 private:
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
        result.push_back({*gradient / slope, here,
                          std::abs(distance(by_rotation * ndc) - here) > 2.0 * kSamePlace ||
                              std::abs(distance(without_motion * ndc) - here) > 2.0 * kSamePlace});
      }
    }
    return result;
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
          fits(displacements(now_, before, before, oldest, given_), dvec2(0.0)))
        return Mistake::camera_of_another_frame;
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
      const auto other = displacements(now_, before, now_, before, reading);
      const double other_share =
          other.size() < kEnoughSamples ? 0.0 : share_in_motion(other).value_or(0.0);
      if (other_share > most) {
        most = other_share;
        best = mistake;
        measure = reading.translation_scale;
      }
    };
    for_projections(now_, given_, consider);
    Reading reading = given_;
    for (double scale = 0.008; scale < 130.0; scale *= 1.1) {
      reading.translation_scale = scale;
      consider(Mistake::translation_scale, reading);
    }
    reading = given_;
    reading.invert_view = true;
    consider(Mistake::view_inverted, reading);
    if (best != Mistake::count) return best;
    measure = 100.0 * (1.0 - share);
    const auto has_translation = [](const Picture& picture) {
      return dvec3(picture.view_from_world[3]) != dvec3(0.0);
    };
    if (!has_translation(now_) && !has_translation(before)) return Mistake::no_translation;
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
    if (vectors.size() < kEnoughSamples || quantile(lengths, 0.5) < 0.3) return;
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
                                     }) > 0.9)
        found = Mistake::motion_zero;
    }
    for (const Mistake mistake :
         {Mistake::motion_zero, Mistake::motion_sign, Mistake::motion_unit, Mistake::motion_jitter})
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

#include <array>
#include <initializer_list>

#include "diagnose/picture.h"
#include "inspect_parameters.h"

namespace alcove::passes {
namespace {

using maths::kInspectColumns;
using maths::kInspectRows;

// Limits for the comparison of successive frames.
constexpr double kSamePlace = 0.15;  // pixels
constexpr double kFits = 0.75;       // the share of the samples at the same place if cameras fit

// How far a sample is from the place at which the cameras expect it in the earlier frame. Only the
// distance in the direction of the gradient of depth shows.
struct Displacement {
  double distance = 0.0;  // pixels
  // Its derivatives by a shift of the image in pixels, whose z is 0, and by the camera's
  // translation.
  dvec3 by_shift;
  dvec3 by_translation;
  // The distance would be clearly another without the camera's translation or without any motion.
  // The depths of a floor, for example, stay the same when the camera moves along it or turns.
  bool shows_motion = false;
};
using Displacements = std::vector<Displacement>;

// The share of samples that are where a hypothesis says.
double share_in_place(const Displacements& displacements) {
  return share_of(displacements,
                  [](const Displacement& d) { return std::abs(d.distance) <= kSamePlace; });
}

// The share of the samples that a hypothesis explains: of all, or of those that show the camera's
// motion, if these are enough and their share is smaller.
double explained(Displacements displacements) {
  if (displacements.size() < kEnoughSamples) return 0.0;
  const double of_all = share_in_place(displacements);
  std::erase_if(displacements, [](const Displacement& d) { return !d.shows_motion; });
  return displacements.size() < kEnoughOfSome ? of_all
                                              : std::min(of_all, share_in_place(displacements));
}

// Returns the vector that explains displacements best, by least squares without outliers. It begins
// with `start` and takes a step with each limit of a distance. `displace` returns the displacements
// that a vector leaves, whose derivatives by the vector are their members `derivative`.
template <typename Displace>
dvec3 best_fit(dvec3 best, std::initializer_list<double> limits, dvec3 Displacement::*derivative,
               const Displace& displace) {
  for (const double limit : limits) {
    maths::dmat3 matrix(0.0);
    dvec3 sum(0.0);
    for (const Displacement& d : displace(best)) {
      if (std::abs(d.distance) > limit) continue;
      matrix += maths::outerProduct(d.*derivative, d.*derivative);
      sum += d.*derivative * d.distance;
    }
    // A vector that does not show in some direction is not changed in it.
    const double trace = matrix[0][0] + matrix[1][1] + matrix[2][2];
    best -= maths::inverse(matrix + maths::dmat3(1e-9 * trace + 1e-30)) * sum;
  }
  return best;
}

Displacements shifted(Displacements displacements, const dvec3& shift) {
  for (Displacement& d : displacements) d.distance += maths::dot(d.by_shift, shift);
  return displacements;
}

// Returns the matrix from the view space of `now` to that of `before`.
dmat4 motion_between(const Eye& now, const Eye& before) {
  return before.view_from_world * maths::inverse(now.view_from_world);
}

// Returns `before`, moved so that the camera has another translation from frame to frame.
Eye moved(const Eye& now, Eye before, const dvec3& translation) {
  dmat4 motion = motion_between(now, before);
  motion[3] = dvec4(translation, 1.0);
  before.view_from_world = motion * now.view_from_world;
  return before;
}

// Returns the displacements of the samples of the frame `now` in the frame `before` if these frames
// were drawn with two eyes.
Displacements displacements(const Picture& now, const Picture& before, const Eye& eye,
                            const Eye& eye_before) {
  const dmat4 motion = motion_between(eye, eye_before);
  dmat4 rotation = motion;
  rotation[3] = dvec4(0.0, 0.0, 0.0, 1.0);
  const dmat4 from = maths::inverse(eye.clip_from_view);
  const dmat4& to = eye_before.clip_from_view;
  const dmat4 to_before = to * motion * from, by_rotation = to * rotation * from,
              without_motion = to * from;
  const dvec2 grid = dvec2(kInspectColumns, kInspectRows) / to_vector(before.frame.size);
  Displacements result;
  for (const PixelSample& s : now.frame.samples) {
    const dvec4 ndc(eye.ndc(s), s.depth, 1.0);
    const dvec4 clip = to_before * ndc;
    if (is_sky(s.depth) || !(clip.w > 0.0)) continue;
    const dvec2 cell = eye_before.pixel(clip) * grid - 0.5;  // between four samples
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
    if (!is_plane) continue;
    const auto distance = [&](const dvec4& p) {
      return (p.z / p.w - depth_at(eye_before.pixel(p))) / slope;
    };
    const double here = distance(clip);
    const double place_w = (from * ndc).w;
    dvec3 by_translation;
    for (int axis = 0; axis < 3; ++axis) {
      const dvec4 change = place_w / clip.w * (to[axis] - clip * (to[axis].w / clip.w));
      by_translation[axis] =
          (change.z - 0.5 * maths::dot(*gradient, dvec2(change) * eye_before.size)) / slope;
    }
    result.push_back({here, dvec3(-*gradient / slope, 0.0), by_translation,
                      std::abs(distance(by_rotation * ndc) - here) > 2.0 * kSamePlace ||
                          std::abs(distance(without_motion * ndc) - here) > 2.0 * kSamePlace});
  }
  return result;
}

}  // namespace

double share_explained(const std::vector<Picture>& pictures, const Reading& reading) {
  return explained(
      displacements(pictures[0], pictures[1], pictures[0].eye(reading), pictures[1].eye(reading)));
}

CameraFit fit_cameras(const std::vector<Picture>& pictures, const Reading& given,
                      const std::function<bool(const Reading&)>& fits_normals) {
  const Picture &now = pictures[0], &before = pictures[1];
  const Eye eye = now.eye(given), eye_before = before.eye(given);
  const Displacements by_cameras = displacements(now, before, eye, eye_before);
  const double share = explained(by_cameras);
  CameraFit fit{.share = share};
  if (share > kMisfits) return fit;
  // A hypothesis must explain most samples, and more than those before it, which are simpler. If
  // almost no sample stays on the image, a hypothesis under which samples stay is right.
  double most = std::max(kFits, share + 0.3);
  const auto consider = [&](const Mistake* mistake, double measure, double its_share) {
    if (its_share <= most) return;
    most = its_share + 0.02;
    fit.mistake = mistake;
    fit.measure = measure;
  };
  const auto consider_reading = [&](const Mistake* mistake, const Reading& reading) {
    const double its_share = share_explained(pictures, reading);
    if (its_share > most && fits_normals(reading)) consider(mistake, 0.0, its_share);
  };
  if (pictures.size() > 2) {
    const Picture& oldest = pictures[2];
    consider(&mistakes::camera_of_another_frame, 0.0,
             explained(displacements(before, oldest, eye, eye_before)));
    consider(&mistakes::camera_of_another_frame, 0.0,
             explained(displacements(now, before, eye_before, oldest.eye(given))));
  }
  // Jitter: the whole image is shifted from where the cameras expect it. A change of the size may
  // also move the view axis.
  const bool resized = eye.size != eye_before.size;
  const dvec2 in_cameras = resized ? dvec2(0.0) : now.jitter() - before.jitter();
  for (const dvec2& begin : {dvec2(0.0), in_cameras}) {
    const dvec3 shift =
        best_fit(dvec3(begin, 0.0), {3.0, 2.0, 1.0, 0.5, 0.3}, &Displacement::by_shift,
                 [&](const dvec3& by) { return shifted(by_cameras, by); });
    const dvec2 in_depth = in_cameras - dvec2(shift);
    if (std::abs(in_depth.x) < 1.2 && std::abs(in_depth.y) < 1.2) {
      consider(maths::length(in_cameras) < 0.02 ? &mistakes::jitter_missing
               : maths::length(in_depth) < 0.1  ? &mistakes::jitter_unused
                                                : &mistakes::jitter_wrong,
               maths::length(shift), explained(shifted(by_cameras, shift)));
    }
  }
  for_cameras(now, given, consider_reading);
  // Another translation of the camera.
  const auto by_translation = [&](const dvec3& by) {
    return displacements(now, before, eye, moved(eye, eye_before, by));
  };
  const dvec3 best = best_fit(dvec3(0.0), {30.0, 20.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5, 0.3, 0.3},
                              &Displacement::by_translation, by_translation);
  const dvec3 translation(motion_between(eye, eye_before)[3]);
  const double scale =
      maths::dot(best, translation) / maths::dot(translation, translation);  // or not a number
  const bool is_scaled =
      scale > 0.0 && maths::length(best - scale * translation) < 0.1 * maths::length(best);
  const bool has_none =
      dvec3(now.view_from_world[3]) == dvec3(0.0) && dvec3(before.view_from_world[3]) == dvec3(0.0);
  consider(has_none    ? &mistakes::no_translation
           : is_scaled ? &mistakes::translation_scale
                       : &mistakes::translation_wrong,
           scale, explained(by_translation(best)));
  if (fit.mistake != nullptr) return fit;
  // Where objects move, depth alone does not tell whether the cameras fit.
  const bool shows = by_cameras.size() >= kEnoughSamples && !now.frame.has_motion &&
                     share_in_place(by_cameras) <= 0.25;
  const double jitter = maths::length(in_cameras);
  if (has_none) {
    fit.mistake = &mistakes::no_translation;
  } else if (shows && jitter > kLargestJitter) {
    fit.mistake = &mistakes::jitter_wrong;
    fit.measure = jitter;
  } else if (shows) {
    fit.mistake = &mistakes::cameras_disagree;
    fit.measure = 100.0 * (1.0 - share);
  }
  return fit;
}

// Compares the motion vectors with the motion that the cameras give to static surfaces.
std::optional<const Mistake*> mistake_of_motion(const std::vector<Picture>& pictures,
                                                const Reading& given, double share_of_cameras) {
  if (share_of_cameras <= kMisfits) return std::nullopt;
  struct Vector {
    dvec2 stored;
    dvec2 by_cameras;  // pixels
  };
  const Picture &now = pictures[0], &before = pictures[1];
  const Eye eye = now.eye(given);
  const dmat4 to_before =
      before.clip_from_view * motion_between(eye, before.eye(given)) * now.view_from_clip;
  std::vector<Vector> vectors;
  std::vector<double> lengths;
  for (const PixelSample& s : now.frame.samples) {
    const dvec2 ndc = eye.ndc(s);
    const dvec4 clip = to_before * dvec4(ndc, s.depth, 1.0);
    if (is_sky(s.depth) || !(clip.w > 0.0)) continue;
    vectors.push_back(
        {dvec2(s.motion[0], s.motion[1]), 0.5 * (ndc - dvec2(clip) / clip.w) * eye.size});
    lengths.push_back(maths::length(vectors.back().by_cameras));
  }
  if (vectors.size() < kEnoughSamples || quantile(lengths, 0.5) < 0.3) return std::nullopt;
  const MotionConvention convention = motion_of(now.frame.info);
  const dvec2 scale(convention.scale[0], convention.scale[1]);
  const dvec2 offset(convention.offset[0], convention.offset[1]);
  // Returns the motion in pixels if the convention had another scale.
  const auto pixels = [&](const Vector& v, const dvec2& factor) {
    return (scale * v.stored * factor + offset) * eye.size;
  };
  const auto share = [&](const dvec2& factor, const dvec2& shift) {
    return share_of(vectors, [&](const Vector& v) {
      return maths::length(pixels(v, factor) + shift - v.by_cameras) <=
             0.1 + 0.05 * maths::length(v.by_cameras);
    });
  };
  // Returns the offset of most vectors in pixels.
  const auto common_offset = [&](const dvec2& factor) {
    std::array<std::vector<double>, 2> rests;
    for (const Vector& v : vectors)
      for (int i = 0; i < 2; ++i)
        rests.at(static_cast<std::size_t>(i)).push_back((v.by_cameras - pixels(v, factor))[i]);
    return dvec2(quantile(rests[0], 0.5), quantile(rests[1], 0.5));
  };
  const double with_given = share(dvec2(1.0), dvec2(0.0));
  if (with_given >= kMisfits) return nullptr;
  const Mistake* found = nullptr;
  double most = std::max(kFits, with_given + 0.3);
  for (const bool has_offset : {false, true}) {
    for (const dvec2& unit : {dvec2(1.0), dvec2(0.5), dvec2(2.0), 1.0 / eye.size, eye.size}) {
      for (const dvec2& sign : {dvec2(1.0), dvec2(-1.0, 1.0), dvec2(1.0, -1.0), dvec2(-1.0)}) {
        const dvec2 factor = unit * sign;
        const dvec2 shift = has_offset ? common_offset(factor) : dvec2(0.0);
        // With another unit or sign, only a jitter is likely to be missing too.
        if (factor != dvec2(1.0) && maths::length(shift) > kLargestJitter) continue;
        const double other = share(factor, shift);
        if (other <= most + 0.02) continue;
        most = other;
        found = unit != dvec2(1.0)   ? &mistakes::motion_unit
                : sign != dvec2(1.0) ? &mistakes::motion_sign
                                     : &mistakes::motion_offset;
      }
    }
  }
  const double zeros = share_of(
      vectors, [&](const Vector& v) { return maths::length(scale * v.stored * eye.size) < 0.02; });
  if (found == nullptr && zeros > 0.9) return &mistakes::motion_zero;
  const bool disagrees = found == nullptr && share_of_cameras > kFits && with_given < 0.25;
  return disagrees ? &mistakes::motion_disagrees : found;
}

}  // namespace alcove::passes

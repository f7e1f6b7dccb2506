#include "evaluate/motion_run.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;

constexpr std::uint32_t kCompared = 3;  // frames of a path

Mask surfaces_of(const SeenFrame& seen) {
  return surfaces_where(seen, [](const glm::vec3&) { return true; });
}

Mask aged(const Image<Age>& ages, bool uncovered) {
  Mask mask(ages.width, ages.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    const Age& age = ages.pixels[i];
    mask.pixels[i] = age.frames == kUncoveredFrames && age.uncovered == uncovered ? 1 : 0;
  }
  return mask;
}

// A frame to compare, as it was seen in passing.
struct Compared {
  std::uint32_t frame = 0;
  SeenFrame seen;
  Image<Age> ages;
  SeenFrame before;
  Retraced retraced;
};

// The path as it is walked.
struct Passed {
  RunningMean change;
  RunningMean speed;
  RunningMean fast;
  std::vector<Compared> compared;
};

std::uint32_t first_settled(const MotionPath& path) { return path.frames() / kCompared; }

bool is_compared(const MotionPath& path, std::uint32_t frame) {
  for (std::uint32_t i = 1; i <= kCompared; ++i) {
    if (frame + 1 == i * path.frames() / kCompared) {
      return true;
    }
  }
  return false;
}

// Of what is drawn along a path, after the path's own.
std::string_view name_of(MotionWalk::Gathered gathered) {
  switch (gathered) {
    case MotionWalk::Gathered::nothing:
      return " without history and filter";
    case MotionWalk::Gathered::neighbours:
      return " without history";
    case MotionWalk::Gathered::neighbours_and_history:
      break;
  }
  return "";
}

tl::expected<Passed, std::string> pass_along(MotionWalk& walk, MotionWalk::Gathered gathered) {
  const bool history = gathered == MotionWalk::Gathered::neighbours_and_history;
  Passed passed;
  const MotionPath& path = walk.path();
  const Progress progress =
      walk.progress(std::string(name_of(path.kind())) + std::string(name_of(gathered)));
  // Nothing is kept without a history, so that the way to where it counts is not walked.
  const std::uint32_t first = history ? 0 : first_settled(path) - 1;
  SeenFrame before;
  Image<Age> ages;
  for (std::uint32_t frame = first; frame < path.frames(); ++frame) {
    auto seen = walk.draw_and_read({.frame = frame,
                                    .before = frame - (frame > first ? 1 : 0),
                                    .index = frame,
                                    .gathered = gathered});
    if (!seen) {
      return Failure(std::move(seen.error()));
    }
    if (frame == first) {
      ages = first_ages(*seen);
    } else {
      const Retraced retraced = retrace(*seen, before, [&](const glm::vec3& position) {
        return path.position_before(position, frame);
      });
      ages = next_ages(*seen, retraced, ages);
      if (frame >= first_settled(path)) {
        passed.change += visibility_change(seen->visibility, before.visibility, retraced);
      }
      const Speed speed = speed_of(retraced);
      passed.speed += {speed.mean, 1};
      passed.fast += {speed.percentile_95, 1};
      if (history && is_compared(path, frame)) {
        passed.compared.push_back({frame, *seen, ages, std::move(before), retraced});
      }
    }
    before = std::move(*seen);
    progress(static_cast<double>(frame + 1 - first) / (path.frames() - first));
  }
  return passed;
}

// The last of as many frames under a camera that stands, and its change since the one before.
struct Standing {
  Image<float> visibility;
  Image<glm::vec3> bent_normal_ws;
  RunningMean change;
};

tl::expected<Standing, std::string> stand_at(MotionWalk& walk, std::uint32_t frame) {
  for (std::uint32_t index = 0; index + 1 < frame; ++index) {
    if (auto drawn = walk.draw({.frame = frame, .before = frame, .index = index, .moving = false});
        !drawn) {
      return Failure(std::move(drawn.error()));
    }
  }
  const auto read = [&](std::uint32_t index) {
    return walk.draw_and_read({.frame = frame, .before = frame, .index = index, .moving = false});
  };
  const auto before = read(frame - 1);
  if (!before) {
    return Failure(before.error());
  }
  auto last = read(frame);
  if (!last) {
    return Failure(std::move(last.error()));
  }
  Standing standing;
  for (std::size_t i = 0; i < last->depth.pixels.size(); ++i) {
    if (std::isfinite(last->depth.pixels[i])) {
      standing.change += {std::abs(last->visibility.pixels[i] - before->visibility.pixels[i]), 1};
    }
  }
  standing.visibility = std::move(last->visibility);
  standing.bent_normal_ws = std::move(last->bent_normal_ws);
  return standing;
}

// Squared errors of a run and of its still counterpart over the same pixels.
struct SquaresPair {
  RunningMean moving;
  RunningMean still;

  template <class T>
  void add(const Image<T>& moved, const Image<T>& stood, const Halves<T>& truth, const Mask& mask) {
    moving += squared_error(moved, truth, mask);
    still += squared_error(stood, truth, mask);
  }
  ErrorPair errors() const { return {moving.count, root(moving), root(still)}; }
};

// What the compared frames come to.
struct Comparison {
  SquaresPair all;
  SquaresPair uncovered;
  SquaresPair entered;
  SquaresPair passed_by;
  SquaresPair bent_normals;
  RunningMean static_change;
  RunningMean truth_change;
  Weave weave;
  Weave static_weave;
  std::vector<MotionPicture> pictures;
};

Done compare(MotionWalk& walk, const Compared& compared, Comparison& sums) {
  auto standing = stand_at(walk, compared.frame);
  if (!standing) {
    return Failure(std::move(standing.error()));
  }
  const auto truth = walk.truth(compared.frame, compared.seen);
  if (!truth) {
    return Failure(truth.error());
  }
  const auto truth_before = walk.truth(compared.frame - 1, compared.before);
  if (!truth_before) {
    return Failure(truth_before.error());
  }
  const auto passes_by = [&](const glm::vec3& position) {
    return walk.path().passes_by(position, compared.frame, kTrailFrames);
  };
  const SeenFrame& seen = compared.seen;
  const Mask surfaces = surfaces_of(seen);
  const auto add = [&](SquaresPair& squares, const Mask& mask) {
    squares.add(seen.visibility, standing->visibility, truth->visibility, mask);
  };
  add(sums.all, surfaces);
  add(sums.uncovered, aged(compared.ages, true));
  add(sums.entered, aged(compared.ages, false));
  add(sums.passed_by, surfaces_where(seen, passes_by));
  sums.bent_normals.add(seen.bent_normal_ws, standing->bent_normal_ws, truth->bent_normal_ws,
                        surfaces);
  sums.static_change += standing->change;
  sums.truth_change += least_change(truth->visibility, truth_before->visibility, compared.retraced);
  Image<float> mean_truth = mean_of(truth->visibility);
  sums.weave += weave_of(seen.visibility, mean_truth, surfaces);
  sums.static_weave += weave_of(standing->visibility, mean_truth, surfaces);
  sums.pictures.push_back(
      {compared.frame, seen.visibility, std::move(standing->visibility), std::move(mean_truth)});
  return {};
}

// The frames from `first` on as they are seen after 1, 2, 4 ... of them, the camera standing.
tl::expected<std::vector<SeenFrame>, std::string> after_cut(MotionWalk& walk, bool restart) {
  const MotionPath& path = walk.path();
  const std::uint32_t cut = path.cut().value_or(0);
  std::vector<SeenFrame> seen;
  for (std::uint32_t frame = restart ? cut : 0; frame < path.frames(); ++frame) {
    const std::uint32_t since = frame + 1 - std::min(cut, frame + 1);
    const MotionWalk::Step step{
        .frame = frame,
        .before = frame == 0 || (restart && frame == cut) ? frame : frame - 1,
        .index = frame,
        .restart = restart && frame == cut};
    // 1, 2, 4, ...
    if (since > 0 && (since & (since - 1)) == 0) {
      auto images = walk.draw_and_read(step);
      if (!images) {
        return Failure(std::move(images.error()));
      }
      seen.push_back(std::move(*images));
    } else if (auto drawn = walk.draw(step); !drawn) {
      return Failure(std::move(drawn.error()));
    }
  }
  return seen;
}

}  // namespace

tl::expected<MotionReport, std::string> run_motion(Gpu& gpu, const Scene& scene,
                                                   const MotionPath& path,
                                                   const MotionSetup& setup) {
  auto walk = MotionWalk::create(gpu, scene, path, setup);
  if (!walk) {
    return Failure(std::move(walk.error()));
  }
  using Gathered = MotionWalk::Gathered;
  const auto passed = pass_along(*walk, Gathered::neighbours_and_history);
  if (!passed) {
    return Failure(passed.error());
  }
  const auto unkept = pass_along(*walk, Gathered::neighbours);
  if (!unkept) {
    return Failure(unkept.error());
  }
  const auto unfiltered = pass_along(*walk, Gathered::nothing);
  if (!unfiltered) {
    return Failure(unfiltered.error());
  }
  Comparison sums;
  for (const Compared& compared : passed->compared) {
    if (auto done = compare(*walk, compared, sums); !done) {
      return Failure(std::move(done.error()));
    }
  }
  return MotionReport{
      .speed = {passed->speed.mean(), passed->fast.mean()},
      .all = sums.all.errors(),
      .uncovered = sums.uncovered.errors(),
      .entered = sums.entered.errors(),
      .passed_by = sums.passed_by.errors(),
      .bent_normals = sums.bent_normals.errors(),
      .flicker = {passed->change.mean(), unkept->change.mean(), unfiltered->change.mean(),
                  sums.static_change.mean(), sums.truth_change.mean()},
      .weave = sums.weave,
      .static_weave = sums.static_weave,
      .pictures = std::move(sums.pictures)};
}

tl::expected<CutReport, std::string> run_cut(Gpu& gpu, const Scene& scene, const MotionPath& path,
                                             const MotionSetup& setup) {
  auto walk = MotionWalk::create(gpu, scene, path, setup);
  if (!walk) {
    return Failure(std::move(walk.error()));
  }
  auto untold = after_cut(*walk, false);
  if (!untold) {
    return Failure(std::move(untold.error()));
  }
  auto restart = after_cut(*walk, true);
  if (!restart) {
    return Failure(std::move(restart.error()));
  }
  const std::uint32_t cut = path.cut().value_or(0);
  const auto truth = walk->truth(cut, untold->front());
  if (!truth) {
    return Failure(truth.error());
  }
  CutReport report;
  const Mask surfaces = surfaces_of(untold->front());
  for (std::size_t i = 0; i < untold->size(); ++i) {
    SeenFrame& kept = (*untold)[i];
    SeenFrame& begun = (*restart)[i];
    const std::uint32_t frames = 1u << i;
    const Halves<float>& visibility = truth->visibility;
    report.after.push_back({frames, root(squared_error(kept.visibility, visibility, surfaces)),
                            root(squared_error(begun.visibility, visibility, surfaces))});
    report.pictures.push_back({cut + frames - 1, std::move(kept.visibility),
                               std::move(begun.visibility), mean_of(visibility)});
  }
  return report;
}

}  // namespace alcove::sample

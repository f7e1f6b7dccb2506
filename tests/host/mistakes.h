#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine_run.h"
#include "support/result.h"

namespace alcove::sample {

// A mistake that engines make when they call Alcove.
struct PlantedMistake {
  const char* name;
  const char* sentence;  // part of the only sentence of alcoveDiagnose, or of the refused call
  ChangeFrame plant;     // makes the mistake in a frame; null for a late submission
  // The frames: of an orbiting camera, with a reversed depth buffer and an infinite far plane, of a
  // camera that moves straight ahead, with two eyes, with a near plane that is no round number, or
  // of a camera that stands still.
  enum Frames {
    orbit,
    reversed,
    straight,
    stereo,
    straight_stereo,
    odd_planes,
    standing,
    kinds
  } frames = orbit;
};

[[nodiscard]] const std::vector<PlantedMistake>& planted_mistakes();

// Frames without a mistake: a camera that stands still, moves, has jitter, is resized or cut.
struct CorrectCourse {
  const char* name;
  EngineCourse course;
};
[[nodiscard]] std::vector<CorrectCourse> correct_courses(const EngineCourse& base);

// Returns what alcoveDiagnose says of frames without a mistake: as they are, with motion vectors,
// without normals, and with dynamic resolution. It should be nothing.
[[nodiscard]] Result<std::string> diagnose_correct_frames(EngineRun& run);

// Draws frames without and with mistakes, of a camera that moves and has jitter.
class MistakeRun {
 public:
  // `course` has the size and the radius, and says when the size changes.
  MistakeRun(Engine& engine, const Camera& camera, const EngineCourse& course)
      : engine_(engine), camera_(camera), course_(course) {}

  // Makes a mistake from the frame `begin` on.
  [[nodiscard]] Result<std::string> draw(const PlantedMistake& mistake, std::uint32_t begin);

 private:
  Result<EngineRun*> run_of(PlantedMistake::Frames frames);

  Engine& engine_;
  Camera camera_;
  EngineCourse course_;
  std::array<std::unique_ptr<EngineRun>, PlantedMistake::kinds> runs_;  // made when needed
};

// Returns whether `said` is one line, which contains the sentence of the mistake.
[[nodiscard]] bool names(const std::string& report, const PlantedMistake& mistake);

}  // namespace alcove::sample

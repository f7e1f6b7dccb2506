#pragma once

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
  const char* table_name = "";  // in the table of passes/INTEGRATION.md, if it has a row there
  bool reversed = false;        // in frames with a reversed depth buffer and an infinite far plane
};

[[nodiscard]] const std::vector<PlantedMistake>& planted_mistakes();

// Frames without a mistake: a camera that stands still, moves, has jitter, is resized or cut.
struct RightCourse {
  const char* name;
  EngineCourse course;
};
[[nodiscard]] std::vector<RightCourse> right_courses(const EngineCourse& base);

// Returns what alcoveDiagnose says of frames without a mistake: as they are, with motion vectors,
// without normals, and with dynamic resolution. It should be nothing.
[[nodiscard]] Result<std::string> diagnose_right_frames(EngineRun& run);

// Draws frames without and with mistakes, of a camera that moves and has jitter.
class MistakeRun {
 public:
  // `course` has the size and the radius, and says when the size changes.
  [[nodiscard]] static Result<MistakeRun> create(Gpu& gpu, const Scene& scene, const Camera& camera,
                                                 EngineCourse course);

  // Makes a mistake from the frame `begin` on.
  [[nodiscard]] Result<EngineResult> draw(const PlantedMistake& mistake, std::uint32_t begin);
  [[nodiscard]] Result<EngineResult> draw_right(bool reversed);

 private:
  std::unique_ptr<EngineRun> plain_;
  std::unique_ptr<EngineRun> reversed_;
};

// Returns whether `said` is one line, which contains the sentence of the mistake.
[[nodiscard]] bool names(const std::string& said, const PlantedMistake& mistake);

}  // namespace alcove::sample

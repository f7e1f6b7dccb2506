#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/engine_run.h"

namespace alcove::sample {

// A mistake that engines make when they call Alcove.
struct PlantedMistake {
  const char* name;      // for the table
  const char* file;      // of its picture, without the ending
  const char* sentence;  // part of the sentence of alcoveDiagnose; empty: it need not say anything
  ChangeFrame plant;     // makes the mistake in a frame; null for a late submission
  bool submit_late = false;
};

// The mistakes in the order of the table in passes/INTEGRATION.md.
[[nodiscard]] const std::vector<PlantedMistake>& planted_mistakes();

// A mistake drawn on a scene.
struct MistakeResult {
  const PlantedMistake* mistake = nullptr;
  double rmse = 0.0;   // of visibility against the picture without the mistake, all pixels
  std::string said;    // lines of alcoveDiagnose
  bool named = false;  // `said` is one line, which contains PlantedMistake::sentence
};

struct MistakeReport {
  std::string said_of_right_frames;
  std::vector<MistakeResult> results;
};

// Draws the view of a moving camera, once without a mistake and once with each mistake. If
// `pictures` is not empty, it must be an existing folder, to which `right.png` and a picture of
// each mistake are written.
[[nodiscard]] tl::expected<MistakeReport, std::string> draw_mistakes(
    EngineRun& run, const Camera& camera, float radius, const std::filesystem::path& pictures);

}  // namespace alcove::sample

#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/indirect_truths.h"
#include "render/rendering.h"

namespace alcove::sample {

// How far the lit picture is off with one more part of the occlusion each time. In parts of the
// truth's mean radiance; the noise of the truth is taken out.
struct LitStep {
  std::string name;
  double rmse = 0;
  double bias = 0;
};
struct LitErrors {
  std::uint64_t pixels = 0;
  double mean_radiance = 0;  // of the truth
  double noise = 0;          // of the truth, RMS, in parts of its mean
  std::vector<LitStep> steps;
  LitStep unbent;   // visibility as a first step by itself, light along the normal
  LitStep diffuse;  // the parts of the last step against those of the truth
  LitStep specular;
};

// Of a rendering with IndirectRequest::lit_steps; `light.lit` must be there.
[[nodiscard]] LitErrors lit_errors_of(const Rendering& rendering, const IndirectTruths& light);
[[nodiscard]] nlohmann::ordered_json to_json(const LitErrors& errors);
[[nodiscard]] std::string lit_error_table(const LitErrors& errors);

// lit_steps.png: the four steps; then visibility alone, the truth and the error of the last step,
// grey where it is right; a pixel for each that was traced. truth_lit.png: the truth alone.
[[nodiscard]] tl::expected<void, std::string> write_lit_steps(const Rendering& rendering,
                                                              const IndirectTruths& light,
                                                              const std::filesystem::path& folder);

}  // namespace alcove::sample

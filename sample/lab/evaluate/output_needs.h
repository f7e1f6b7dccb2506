#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluate/recommendation.h"
#include "evaluate/situations.h"
#include "evaluate/truths.h"
#include "gpu/occlusion.h"
#include "reference/truth.h"
#include "render/session.h"
#include "scene/scene.h"
#include "support/image.h"
#include "support/result.h"

namespace alcove::sample {

// Returns by how much a change of the settings raises the modelled time: 0.2 for 20 %.
using TimeIncrease =
    std::function<Result<double>(const std::function<void(OcclusionSettings& settings)>& change)>;

// Returns a sentence for each output and input of the passes on which the materials in view decide:
// specular occlusion, multi-bounce, bent normals, normals, settings for thin occluders, and motion
// vectors. Each says how much of the view asks for it, and what it costs. `seen` and `truths` are
// of the same view and size. The list is empty for a scene of one plain material. Errors: those of
// `time_increase`.
[[nodiscard]] Result<std::vector<std::string>> output_needs(const Scene& scene, const GBuffer& seen,
                                                            const Truths& truths,
                                                            const TimeIncrease& time_increase);

// Returns output_needs() for the session's view. `truths` and `times` are those of the view.
[[nodiscard]] Result<std::vector<std::string>> view_needs(const Session& session,
                                                          const Truths& truths,
                                                          const SettingTimes& times,
                                                          const RecommendationGoal& goal,
                                                          const Achievement& chosen);

}  // namespace alcove::sample

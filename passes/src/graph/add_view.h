// Adds all work of a view to a render graph.
#pragma once

#include <string_view>

#include "work/view_work.h"

namespace alcove::passes {

[[nodiscard]] tl::expected<OcclusionOutputs, Error> add_view(const Frame& frame,
                                                             const ViewInputs& inputs,
                                                             const OcclusionSettings& settings,
                                                             std::string_view history_name);

}  // namespace alcove::passes

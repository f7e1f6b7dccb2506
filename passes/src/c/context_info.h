// Checks the AlcoveContextInfo from which a context is created.
#pragma once

#include <tl/expected.hpp>

#include "alcove/alcove.h"
#include "c/failure.h"

namespace alcove::passes {

// Returns an error if a required field is missing or the device lacks something that the passes
// need.
[[nodiscard]] Result check(const AlcoveContextInfo* info);

}  // namespace alcove::passes

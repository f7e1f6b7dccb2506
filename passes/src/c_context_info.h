// What the engine gives a context of the C interface to work on.
#pragma once

#include <tl/expected.hpp>

#include "alcove/alcove.h"
#include "c_failure.h"

namespace alcove::passes {

// Whether all is given, and the device can do what the passes need.
[[nodiscard]] tl::expected<void, Failure> check(const AlcoveContextInfo* info);

}  // namespace alcove::passes

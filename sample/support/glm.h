#pragma once

// Includes GLM for a depth range of 0 to 1. alcove_sample_support defines the macro for every
// target that links it. A file that is compiled without it would silently use another depth range.
#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#error "link alcove_sample_support, which defines GLM_FORCE_DEPTH_ZERO_TO_ONE"
#endif

#include <glm/glm.hpp>

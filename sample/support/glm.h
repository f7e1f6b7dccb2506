#pragma once

// GLM with depth 0..1. alcove_sample_support defines the macro for every target that links it; a
// file that is compiled without it would silently differ.
#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#error "link alcove_sample_support, which defines GLM_FORCE_DEPTH_ZERO_TO_ONE"
#endif

#include <glm/glm.hpp>

#pragma once

// GLM as the sample takes it: radians, depth 0..1. alcove_sample_scene defines the switches for
// every target that links it; a file that is compiled without them must not silently differ.
#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#error "link alcove_sample_scene, which defines GLM_FORCE_DEPTH_ZERO_TO_ONE"
#endif

#include <glm/glm.hpp>

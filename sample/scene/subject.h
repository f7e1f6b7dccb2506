#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "scene/bounds.h"

namespace alcove::sample {

struct Scene;

// The directions from the subject to the candidate eyes of the default view, from the front first.
inline constexpr std::array<glm::vec3, 4> kSidesOfSubject{glm::vec3{0.6f, 0.45f, 0.85f},
                                                          {-0.85f, 0.45f, 0.6f},
                                                          {-0.6f, 0.45f, -0.85f},
                                                          {0.85f, 0.45f, -0.6f}};

// The part of a scene that the default view shows.
struct Subject {
  Bounds bounds_ws;
  uint64_t triangles_outside = 0;  // triangles of the scene that do not belong to the subject
  // By side, the distance from the centre of the subject at which a sky, or the wall of a room that
  // has no outside, would hide it. Infinite without either.
  std::array<float, 4> free_distance_ws{
      std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
      std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
};

// Finds the subject of a scene: the group of neighbouring parts with the greatest area, without its
// surroundings.
//
// Parts are triangles that are connected by shared or touching vertices. Two groups of parts are
// neighbours if the gap between them is at most twice the size of the smaller one, measured by its
// area. Surroundings are large parts that enclose the others on all sides (a sky), or that lie
// under or behind them as a thin sheet (a ground plane, a backdrop). A shell with upright walls on
// whose floor the others stand is a room, and a room belongs to the subject.
//
// Scenes of more than 2^23 vertices, instances counted each, are judged by instances and not by
// connected parts.
[[nodiscard]] Subject find_subject(const Scene& scene);

}  // namespace alcove::sample

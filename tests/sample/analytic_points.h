#pragma once

#include <cstdint>

#include "reference/surface_points.h"
#include "scene/analytic_scenes.h"

// The reference points of an analytic scene as one row of pixels.
namespace alcove::sample {

inline SurfacePoints points_of(const AnalyticScene& analytic) {
  const auto count = static_cast<std::uint32_t>(analytic.points.size());
  SurfacePoints out{{count, 1}, {count, 1}, {count, 1}};
  for (std::uint32_t i = 0; i < count; ++i) {
    out.position_ws.at(i, 0) = analytic.points[i].position_ws;
    out.normal_ws.at(i, 0) = analytic.points[i].normal_ws;
  }
  out.geometric_normal_ws = out.normal_ws;
  return out;
}

}  // namespace alcove::sample

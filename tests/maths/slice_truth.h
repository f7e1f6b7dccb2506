// A slice in double precision, computed from its definition, as the reference for the shaders'
// closed forms, and these closed forms up to a horizon, which is given by its cosine as in
// horizon_light().
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/slice.h"
#include "quadrature.h"
#include "random_input.h"

namespace alcove::maths_test {

struct SliceTruth {
  double scale;  // length of the projected normal
  double gamma;  // signed angle from the view direction to it

  // Copies the components of a shader's slice.
  explicit SliceTruth(const maths::Slice& s)
      : scale(std::hypot(double(s.along), double(s.toward))),
        gamma(scale > 0.0 ? std::atan2(double(s.along), double(s.toward)) : 0.0) {}
  SliceTruth(double projected_scale, double projected_gamma)
      : scale(projected_scale), gamma(projected_gamma) {}

  double lowest() const { return gamma - kPi / 2; }
  double highest() const { return gamma + kPi / 2; }

  // Returns the integrand of visibility at the angle t from the view direction.
  double density(double t) const { return scale * std::cos(t - gamma) * std::abs(std::sin(t)); }

  // Returns the visibility between two angles, clamped to the hemisphere of the normal. The
  // integral is split at the view direction.
  double visibility(double from, double to) const {
    const double a = std::max(from, lowest()), b = std::min(to, highest());
    if (a >= b) return 0.0;
    const auto f = [this](double t) { return density(t); };
    const double split = std::clamp(0.0, a, b);
    return integrate(f, a, split) + integrate(f, split, b);
  }

  // Returns the integral of the direction as a vector: x along the slice, y along the view
  // direction.
  glm::dvec2 bent(double from, double to) const {
    const double a = std::max(from, lowest()), b = std::min(to, highest());
    if (a >= b) return glm::dvec2(0.0);
    const auto f = [this](double t) { return density(t) * glm::dvec2(std::sin(t), std::cos(t)); };
    const double split = std::clamp(0.0, a, b);
    return integrate(f, a, split) + integrate(f, split, b);
  }

  double open() const { return scale * (std::cos(gamma) + gamma * std::sin(gamma)); }
};

// Returns a slice whose projected normal has the given length and angle.
inline maths::Slice slice_of(double scale, double gamma) {
  const glm::vec3 view(0, 0, 1), direction(1, 0, 0);
  const double y = std::sqrt(std::max(0.0, 1.0 - scale * scale));
  const glm::vec3 normal(scale * std::sin(gamma), y, scale * std::cos(gamma));
  return maths::make_slice(normal, direction, view);
}

inline maths::Slice random_slice(RandomInput& random) {
  const float scale = random.uniform(0.05f, 1.0f);
  return slice_of(scale, random.uniform(-1.57f, 1.57f));
}

// Returns light_arc() up to a horizon.
inline float slice_arc(const maths::Slice& s, float side, float horizon) {
  return maths::light_arc(s, side, maths::horizon_light(s, side, horizon));
}

// Returns the visible part of both half-slices. `ahead` is the horizon in the positive half-slice.
inline float slice_visibility(const maths::Slice& s, float ahead, float behind) {
  return std::max(slice_arc(s, 1.0f, ahead) + slice_arc(s, -1.0f, behind), 0.0f);
}

// Returns lobe_light_arc() up to a horizon.
inline float lobe_arc(const maths::Slice& s, const maths::HalfLobe& lobe, float horizon) {
  return maths::lobe_light_arc(lobe, maths::horizon_light(s, lobe.side, horizon));
}

// Calls f(slice, truth, horizon) for slices of many normals. `horizon` is the cosine of an angle
// from 0 to 180 degrees to the view direction.
template <typename Function>
void for_each_slice_and_horizon(Function f) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2 + 1e-9; gamma += kPi / 60) {
    for (const double scale : {1.0, 0.4, 1e-3}) {
      const maths::Slice s = slice_of(scale, gamma);
      const SliceTruth truth(s);
      for (double h = 0.0; h <= kPi; h += kPi / 90) f(s, truth, float(std::cos(h)));
    }
  }
}

}  // namespace alcove::maths_test

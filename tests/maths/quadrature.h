// Numerical integration in double precision, as the reference for closed forms.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace alcove::maths_test {

inline constexpr double kPi = std::numbers::pi;

// Returns the integral of f over [a,b] by eight-point Gauss-Legendre quadrature on `panels` equal
// pieces. The error is about 1e-12 for smooth f; split the interval at kinks of f.
template <typename Function>
auto integrate(Function f, double a, double b, int panels = 32) {
  constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290,
                                            0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873,
                                              0.2223810344533745, 0.1012285362903763};
  auto sum = 0.0 * f(a);
  const double half = 0.5 * (b - a) / panels;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = a + (2 * panel + 1) * half;
    for (std::size_t k = 0; k < kNodes.size(); ++k)
      sum += half * kWeights[k] * (f(middle - half * kNodes[k]) + f(middle + half * kNodes[k]));
  }
  return sum;
}

}  // namespace alcove::maths_test

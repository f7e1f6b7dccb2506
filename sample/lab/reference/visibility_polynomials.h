#pragma once

#include <array>
#include <cstddef>

#include "support/glm.h"

namespace alcove::sample {

// Visibility as a function of direction, as fifteen coefficients: Zernike polynomials up to the
// fourth degree (Noll 1976, table I, in another order) on the disc that the hemisphere above a
// surface projects to. A cosine-weighted hemisphere projects to a uniform disc, so the polynomials
// are orthonormal with the cosine weight of visibility. Each coefficient is a mean over
// cosine-weighted directions, and the first one is the visibility.
inline constexpr std::size_t kVisibilityPolynomials = 15;
using VisibilityPolynomials = std::array<float, kVisibilityPolynomials>;

// The values of the polynomials at a unit direction, with z >= 0 along the normal.
[[nodiscard]] VisibilityPolynomials visibility_polynomials(const glm::vec3& direction);

// Adds `other` times `weight` to `sum`.
void add_weighted(VisibilityPolynomials& sum, const VisibilityPolynomials& other, float weight);

// Returns the visible fraction of a lobe, between 0 and 1 (open). `hidden` has the coefficients of
// the occluded directions (1 - visibility). If they are all 0, the result is exactly 1. `lobe` is
// the weighted mean of the polynomials over the lobe.
[[nodiscard]] float visible_share(const VisibilityPolynomials& hidden,
                                  const VisibilityPolynomials& lobe);

}  // namespace alcove::sample

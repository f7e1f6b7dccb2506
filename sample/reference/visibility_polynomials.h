#pragma once

#include <array>
#include <cstddef>

#include "support/glm.h"

namespace alcove::sample {

// Visibility by direction as fifteen numbers that any lobe can be asked of: Zernike's polynomials
// of up to the fourth degree (Noll 1976, table I, another sequence) on the disc that the hemisphere
// over a surface projects to. A cosine-weighted hemisphere is an even disc, so they are orthonormal
// in the very weight of visibility: each number is a mean over cosine-weighted directions, and the
// first is the visibility itself. Filters and histories may average them.
inline constexpr std::size_t kVisibilityPolynomials = 15;
using VisibilityPolynomials = std::array<float, kVisibilityPolynomials>;

// Their values at a unit direction whose z, along the normal, is at least 0.
[[nodiscard]] VisibilityPolynomials visibility_polynomials(const glm::vec3& direction);

// The sum of two sets of numbers, the second times `weight`.
void add_weighted(VisibilityPolynomials& sum, const VisibilityPolynomials& other, float weight);

// The visible share of a lobe, [0,1], 1 open. `hidden`: means over cosine-weighted directions of
// what is hidden times the polynomials, so that an open surface's are 0 and it is open exactly;
// `lobe`: the weighted mean of the polynomials over the lobe.
[[nodiscard]] float visible_share(const VisibilityPolynomials& hidden,
                                  const VisibilityPolynomials& lobe);

}  // namespace alcove::sample

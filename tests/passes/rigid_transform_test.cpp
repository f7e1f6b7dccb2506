// Tests that view matrices with the rounding errors of engines are accepted: inverted in float or
// double, with and without fused multiply-adds, and far from the origin.
#include "work/rigid_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "random_input.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using maths_test::RandomInput;

// Returns a * b - c * d, with or without a fused multiply-add. Compilers may generate either.
template <typename Number, bool kFused>
Number difference_of_products(Number a, Number b, Number c, Number d) {
  if constexpr (kFused)
    return std::fma(a, b, -(c * d));
  else
    return a * b - c * d;
}

// Inverts a matrix by cofactors, as glm::inverse and most engines do. The last row is also computed
// by a division, so that it has rounding errors.
template <typename Number, bool kFused>
glm::mat<4, 4, Number> inverse_of(const glm::mat<4, 4, Number>& m) {
  const auto minor_of = [&](int skipped_column, int skipped_row) {
    Number e[3][3];
    for (int column = 0, c = 0; column < 4; ++column) {
      if (column == skipped_column) continue;
      for (int row = 0, r = 0; row < 4; ++row) {
        if (row == skipped_row) continue;
        e[c][r++] = m[column][row];
      }
      ++c;
    }
    const auto two = [](Number a, Number b, Number c, Number d) {
      return difference_of_products<Number, kFused>(a, b, c, d);
    };
    const Number x = two(e[1][1], e[2][2], e[2][1], e[1][2]);
    const Number y = two(e[1][0], e[2][2], e[2][0], e[1][2]);
    const Number z = two(e[1][0], e[2][1], e[2][0], e[1][1]);
    return kFused ? std::fma(e[0][0], x, std::fma(-e[0][1], y, e[0][2] * z))
                  : e[0][0] * x - e[0][1] * y + e[0][2] * z;
  };
  glm::mat<4, 4, Number> adjugate;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      const Number sign = (column + row) % 2 == 0 ? Number(1) : Number(-1);
      adjugate[row][column] = sign * minor_of(column, row);
    }
  }
  Number determinant = 0;
  for (int row = 0; row < 4; ++row) determinant += m[0][row] * adjugate[row][0];
  // Builds with fast-math multiply by the reciprocal in the same way.
  return adjugate * (Number(1) / determinant);
}

using Matrix = const float (&)[16];

Matrix to_matrix(const glm::mat4& m) { return reinterpret_cast<Matrix>(m); }

// Returns a random camera pose: a rotation, in half of the cases mirrored, and a translation.
glm::dmat4 random_pose(RandomInput& random, float far) {
  const glm::dvec3 axis(random.unit_vector());
  glm::dmat4 pose = glm::rotate(glm::dmat4(1.0), double{random.uniform(-3.2f, 3.2f)}, axis);
  if (random.uniform(0.0f, 1.0f) < 0.5f) pose[0] = -pose[0];
  pose[3] = glm::dvec4(double{far} * glm::dvec3(random.unit_vector()), 1.0);
  return pose;
}

void expect_accepted(const glm::mat4& view_from_world, const glm::dmat4& exact) {
  Matrix input = to_matrix(view_from_world);
  ASSERT_TRUE(is_rigid(input));
  const maths::dmat4 rigid = to_rigid(input);
  for (int column = 0; column < 4; ++column) ASSERT_EQ(rigid[column][3], column == 3 ? 1.0 : 0.0);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b)
      ASSERT_NEAR(glm::dot(rigid[a], rigid[b]), a == b ? 1.0 : 0.0, 1e-14);
    ASSERT_LT(glm::distance(rigid[a], exact[a]), 5e-6);
  }
}

TEST(RigidTransform, ViewMatricesInvertedInFloatOrDoubleFarFromTheOriginAreAccepted) {
  RandomInput random;
  int inexact_rows = 0;
  for (int i = 0; i < 20000; ++i) {
    const float far = i % 2 == 0 ? 1e6f : random.log_uniform(1e-2f, 1e6f);
    const glm::dmat4 pose = random_pose(random, far);
    const glm::dmat4 exact = glm::inverse(pose);
    const glm::mat4 fused = inverse_of<float, true>(glm::mat4(pose));
    inexact_rows += fused[3][3] != 1.0f ? 1 : 0;
    for (const glm::mat4& view_from_world :
         {glm::inverse(glm::mat4(pose)), inverse_of<float, false>(glm::mat4(pose)), fused,
          glm::mat4(inverse_of<double, true>(pose)), glm::mat4(glm::inverse(pose))}) {
      expect_accepted(view_from_world, exact);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(inexact_rows, 100) << "the sweep has to meet last rows that are not exactly 0 0 0 1";
}

TEST(RigidTransform, ViewMatricesWithErrorsOfAFewUlpsInEveryElementAreAccepted) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const glm::dmat4 exact = glm::inverse(random_pose(random, random.log_uniform(1e-2f, 1e6f)));
    glm::mat4 rounded(exact);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) rounded[column][row] += random.uniform(-5e-7f, 5e-7f);
    expect_accepted(rounded, exact);
    if (HasFatalFailure()) return;
  }
}

TEST(RigidTransform, ScaledTransposedAndNonFiniteViewMatricesAreRefused) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const glm::mat4 good(glm::inverse(random_pose(random, random.log_uniform(0.1f, 1e6f))));
    ASSERT_TRUE(is_rigid(to_matrix(good)));
    EXPECT_FALSE(is_rigid(to_matrix(glm::transpose(good)))) << "row-major";
    EXPECT_FALSE(is_rigid(to_matrix(good * 1.01f)));
    glm::mat4 scaled = good;
    scaled[1] *= 1.002f;
    EXPECT_FALSE(is_rigid(to_matrix(scaled)));
    glm::mat4 broken = good;
    broken[static_cast<int>(random.bits() % 4)][static_cast<int>(random.bits() % 4)] = NAN;
    EXPECT_FALSE(is_rigid(to_matrix(broken)));
  }
}

TEST(RigidTransform, ExactlyRigidMatricesAreNotChanged) {
  float exact[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  exact[12] = 1e6f;
  exact[13] = -0.3f;
  EXPECT_EQ(maths::mat4(to_rigid(exact)), to_mat4(exact));
}

TEST(TransposedProjection, OnlyRowMajorProjectionsAreDetectedAsTransposed) {
  // If the near plane of a perspective projection is at distance 1, the offset of depth, m[14], is
  // -1, like the factor from z to w, m[11]. The matrix must not be taken for a transposed one, even
  // if rounding errors have changed m[11].
  for (const float w_from_z : {-1.0f, -0.9999999f, -1.0000002f}) {
    float m[16]{};
    m[0] = m[5] = 1.0f;
    m[10] = m[14] = -1.0f;
    m[11] = w_from_z;
    EXPECT_FALSE(is_transposed(m)) << w_from_z;
  }
  float transposed[16]{};
  transposed[0] = transposed[5] = 1.0f;
  transposed[11] = 0.1f;
  transposed[14] = -0.9999999f;
  EXPECT_TRUE(is_transposed(transposed));
}

}  // namespace
}  // namespace alcove::passes

// Tests alcoveConvertCamera, which converts the matrices of engines with other conventions, and
// alcoveMakePerspective, which makes a projection from plain numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "alcove/alcove.h"

namespace {

constexpr float kNear = 0.1f;
constexpr float kFar = 50.0f;
constexpr float kFovY = 0.9f;
constexpr float kAspect = 1.5f;

// The camera of all tests. In the library's convention its view matrix is that of glm::lookAtRH,
// and its projection has depth 0 to 1 and y pointing down.
const glm::vec3 kEye(1.0f, 2.0f, 3.0f);
const glm::vec3 kTarget(-0.5f, 0.3f, -2.0f);
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

glm::mat4 expected_view() { return glm::lookAtRH(kEye, kTarget, kUp); }
glm::mat4 expected_clip() {
  glm::mat4 clip = glm::perspectiveRH_ZO(kFovY, kAspect, kNear, kFar);
  clip[1][1] = -clip[1][1];
  return clip;
}

void expect_near(const glm::mat4& matrix, const glm::mat4& expected) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(matrix[column][row], expected[column][row], 1e-5f) << column << ", " << row;
}

// In Direct3D's view space the camera looks along +Z, x points to the right and y up. World space
// is the same in all conventions.
TEST(CCamera, CameraMatricesOfEveryConventionAreConverted) {
  const glm::mat4 clip = expected_clip(), view = expected_view();
  const glm::mat4 forward = glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 1.0f, -1.0f)) * view;
  struct Case {
    std::uint32_t conventions;
    glm::mat4 clip, view;
  };
  for (const Case& each :
       {Case{0, clip, view},
        {ALCOVE_CAMERA_CONVENTION_GLM, glm::perspectiveRH_ZO(kFovY, kAspect, kNear, kFar), view},
        {ALCOVE_CAMERA_CONVENTION_OPENGL, glm::perspectiveRH_NO(kFovY, kAspect, kNear, kFar), view},
        {ALCOVE_CAMERA_CONVENTION_DIRECT3D, glm::perspectiveLH_ZO(kFovY, kAspect, kNear, kFar),
         forward},
        {ALCOVE_CAMERA_CONVENTION_ROW_MAJOR, glm::transpose(clip), glm::transpose(view)}}) {
    SCOPED_TRACE(each.conventions);
    AlcoveCamera camera{};
    ASSERT_EQ(alcoveConvertCamera(&each.clip[0][0], &each.view[0][0], each.conventions, &camera),
              ALCOVE_SUCCESS);
    expect_near(glm::make_mat4(camera.clip_from_view), clip);
    expect_near(glm::make_mat4(camera.view_from_world), view);
  }
}

TEST(CCamera, NullPointersAndUnknownConventionsAreErrors) {
  const glm::mat4 m(1.0f);
  AlcoveCamera camera{};
  EXPECT_EQ(alcoveConvertCamera(nullptr, &m[0][0], 0, &camera), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveConvertCamera(&m[0][0], nullptr, 0, &camera), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveConvertCamera(&m[0][0], &m[0][0], 0, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveConvertCamera(&m[0][0], &m[0][0], 16, &camera), ALCOVE_ERROR_INVALID_INPUT);
}

AlcovePerspective perspective() {
  return {.struct_size = sizeof(AlcovePerspective),
          .fov_y = kFovY,
          .near_plane = kNear,
          .far_plane = kFar,
          .width = 300,
          .height = 200};
}

TEST(CCamera, PerspectiveMadeFromAngleAndPlanesEqualsThatOfGlmAndProjectsItsPlanesToZeroAndOne) {
  const AlcovePerspective plain = perspective();
  float clip_from_view[16];
  ASSERT_EQ(alcoveMakePerspective(&plain, clip_from_view), ALCOVE_SUCCESS);
  expect_near(glm::make_mat4(clip_from_view), expected_clip());
  for (const bool reversed : {false, true}) {
    for (const float far : {kFar, 0.0f, std::numeric_limits<float>::infinity()}) {
      AlcovePerspective info = perspective();
      info.reversed = reversed ? VK_TRUE : VK_FALSE;
      info.far_plane = far;
      float clip[16];
      ASSERT_EQ(alcoveMakePerspective(&info, clip), ALCOVE_SUCCESS);
      const auto depth_at = [&](float distance) {
        const glm::vec4 p = glm::make_mat4(clip) * glm::vec4(0.0f, 0.0f, -distance, 1.0f);
        return p.z / p.w;
      };
      EXPECT_NEAR(depth_at(kNear), reversed ? 1.0f : 0.0f, 1e-6f);
      EXPECT_NEAR(depth_at(far == kFar ? kFar : 1e9f), reversed ? 0.0f : 1.0f, 1e-6f);
    }
  }
}

TEST(CCamera, JitterGivenInPixelsShiftsTheImageByThatManyPixels) {
  AlcovePerspective info = perspective();
  float still[16], moved[16];
  ASSERT_EQ(alcoveMakePerspective(&info, still), ALCOVE_SUCCESS);
  info.jitter_px[0] = 0.25f;
  info.jitter_px[1] = -0.5f;
  ASSERT_EQ(alcoveMakePerspective(&info, moved), ALCOVE_SUCCESS);
  const auto pixel_of = [](const float* clip, const glm::vec3& p) {
    const glm::vec4 at = glm::make_mat4(clip) * glm::vec4(p, 1.0f);
    return (glm::vec2(at) / at.w * 0.5f + 0.5f) * glm::vec2(300.0f, 200.0f);
  };
  const glm::vec3 p(0.7f, -0.4f, -3.0f);
  const glm::vec2 shift = pixel_of(moved, p) - pixel_of(still, p);
  EXPECT_NEAR(shift.x, 0.25f, 1e-3f);
  EXPECT_NEAR(shift.y, -0.5f, 1e-3f);
}

TEST(CCamera, PerspectiveParametersOutOfRangeAreErrors) {
  using P = AlcovePerspective;
  for (const auto change : {+[](P& p) { p.struct_size = 0; }, +[](P& p) { p.fov_y = 0.0f; },
                            +[](P& p) { p.fov_y = 4.0f; }, +[](P& p) { p.near_plane = 0.0f; },
                            +[](P& p) { p.near_plane = NAN; }, +[](P& p) { p.far_plane = 0.05f; },
                            +[](P& p) { p.far_plane = -1.0f; }, +[](P& p) { p.width = 0; },
                            +[](P& p) { p.jitter_px[1] = NAN; }}) {
    AlcovePerspective info = perspective();
    change(info);
    float clip[16];
    EXPECT_EQ(alcoveMakePerspective(&info, clip), ALCOVE_ERROR_INVALID_INPUT);
  }
}

}  // namespace

// Converts cameras of other conventions, and makes cameras from plain numbers.
#include <algorithm>
#include <cmath>

#include "alcove/alcove.h"
#include "maths/language.h"

namespace {

using alcove::maths::mat4;

constexpr std::uint32_t kKnownConventions =
    ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP | ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE |
    ALCOVE_CAMERA_CONVENTION_FORWARD_Z | ALCOVE_CAMERA_CONVENTION_ROW_MAJOR;

// Reads a matrix that lies in memory column by column.
mat4 read(const float* values) {
  mat4 result;
  for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = values[i];
  return result;
}

void write(const mat4& matrix, float* values) {
  for (int i = 0; i < 16; ++i) values[i] = matrix[i / 4][i % 4];
}

void scale_row(mat4& matrix, int row, float scale) {
  for (int column = 0; column < 4; ++column) matrix[column][row] *= scale;
}

}  // namespace

AlcoveResult alcoveConvertCamera(const float* clip_from_view, const float* view_from_world,
                                 uint32_t conventions, AlcoveCamera* camera) {
  if (clip_from_view == nullptr || view_from_world == nullptr || camera == nullptr ||
      (conventions & ~kKnownConventions) != 0)
    return ALCOVE_ERROR_INVALID_INPUT;
  mat4 clip = read(clip_from_view);
  mat4 view = read(view_from_world);
  if ((conventions & ALCOVE_CAMERA_CONVENTION_ROW_MAJOR) != 0) {
    clip = alcove::maths::transpose(clip);
    view = alcove::maths::transpose(view);
  }
  if ((conventions & ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE) != 0)
    for (int column = 0; column < 4; ++column)
      clip[column][2] = 0.5f * (clip[column][2] + clip[column][3]);
  if ((conventions & ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP) != 0) scale_row(clip, 1, -1.0f);
  if ((conventions & ALCOVE_CAMERA_CONVENTION_FORWARD_Z) != 0) {
    clip[2] *= -1.0f;
    scale_row(view, 2, -1.0f);
  }
  write(clip, camera->clip_from_view);
  write(view, camera->view_from_world);
  return ALCOVE_SUCCESS;
}

AlcoveResult alcoveMakePerspective(const AlcovePerspective* perspective, float* clip_from_view) {
  if (perspective == nullptr || perspective->struct_size != sizeof *perspective ||
      clip_from_view == nullptr)
    return ALCOVE_ERROR_INVALID_INPUT;
  const AlcovePerspective& p = *perspective;
  const bool infinite = p.far_plane == 0.0f || p.far_plane == INFINITY;
  const bool good = p.fov_y > 0.0f && p.fov_y < 3.14159f && p.near_plane > 0.0f &&
                    std::isfinite(p.near_plane) && (infinite || p.far_plane > p.near_plane) &&
                    p.width > 0 && p.height > 0 && std::isfinite(p.jitter_px[0]) &&
                    std::isfinite(p.jitter_px[1]);
  if (!good) return ALCOVE_ERROR_INVALID_INPUT;
  const double scale = 1.0 / std::tan(0.5 * p.fov_y);
  const double near = p.near_plane;
  const double at_near = p.reversed != VK_FALSE ? 1.0 : 0.0;
  const double at_far = 1.0 - at_near;
  // Depth is (a z + b) / -z. The two coefficients are such that it is at_near at z = -near and
  // at_far at z = -far.
  const double far = p.far_plane;
  const double a = infinite ? -at_far : -(at_far * far - at_near * near) / (far - near);
  mat4 clip(0.0f);
  clip[0][0] = static_cast<float>(scale * p.height / p.width);
  clip[1][1] = static_cast<float>(-scale);
  // The jitter adds jitter * w to clip x, and w is -z.
  clip[2][0] = -2.0f * p.jitter_px[0] / static_cast<float>(p.width);
  clip[2][1] = -2.0f * p.jitter_px[1] / static_cast<float>(p.height);
  clip[2][2] = static_cast<float>(a);
  clip[2][3] = -1.0f;
  clip[3][2] = static_cast<float>(near * (at_near + a));
  write(clip, clip_from_view);
  return ALCOVE_SUCCESS;
}

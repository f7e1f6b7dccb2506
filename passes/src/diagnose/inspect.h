// Finds mistakes of the caller by means of the pixels of a view's inputs. A few thousand samples of
// depth, normals and motion vectors are compared with the cameras and the formats that the caller
// states, in one frame and from frame to frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "work/view_parameters.h"

namespace alcove::passes {

enum class Mistake : std::uint8_t {
  // Mistakes that show in the calls.
  index_repeats,
  index_goes_back,
  previous_is_this,        // previous_camera is this frame's although the camera moved
  previous_is_another,     // it is neither this frame's nor the last one's
  projection_is_another,   // only its projection is not the last frame's
  previous_size_is_wrong,  // previous_width and previous_height are not the last frame's
  static_in_motion,        // static_frames is not 0 although the image changed
  history_reset,
  // Mistakes that show in the pixels of one frame.
  slot_reused,
  image_too_small,       // the image is smaller than the part of it that is in use
  image_too_large,       // the pixels fit the camera if the whole image is in use
  size_changes,          // dynamic resolution without a largest size
  depth_outside,         // depth is not from 0 to 1
  depth_format,          // depth has steps of another format
  depth_reversed,        // depth is reversed and the projection is not, or the other way round
  depth_from_minus_one,  // the projection is OpenGL's, with depth from -1 to 1
  depth_converted_from_minus_one,  // the projection was converted as if it were OpenGL's
  field_of_view,                   // the pixels fit another field of view or other planes
  flipped_y,                       // y of the projection has the wrong sign for the image
  radius_too_small,
  radius_too_large,
  normal_space,      // normals are in world space instead of view space, or the other way round
  normal_encoding,   // normals fit with another encoding
  normal_forward_z,  // z of the normals has the wrong sign
  view_inverted,     // view_from_world is world_from_view
  normals_disagree,  // normals fit depth under no reading
  // Mistakes that show in the pixels of successive frames.
  camera_of_another_frame,  // camera or depth is that of the frame before
  jitter_missing,           // depth has a jitter that the cameras lack
  jitter_unused,            // the cameras have a jitter that depth lacks
  jitter_wrong,       // the jitter of the cameras has another sign or scale than that of depth
  translation_scale,  // the camera moves further, or less far, than view_from_world says
  no_translation,     // view_from_world lacks the translation
  cameras_disagree,   // the cameras fit depth under no reading
  motion_zero,
  motion_sign,
  motion_unit,
  motion_jitter,
  count,
};

inline constexpr std::size_t kMistakes = static_cast<std::size_t>(Mistake::count);

// The findings of one frame: for each mistake whether it could be seen, and whether it was.
struct Findings {
  std::uint64_t judged = 0;  // a bit for each mistake
  std::uint64_t seen = 0;
  std::array<float, kMistakes> measures{};  // the number of the sentence, where there is one

  void set(Mistake mistake, bool is_seen, double measure = 0.0);
};

// A sampled pixel: its depth and those of its four neighbours, its normal and its motion vector,
// all as they are stored in the textures.
struct PixelSample {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  float depth = 0.0f;
  float left = 0.0f;
  float right = 0.0f;
  float up = 0.0f;
  float down = 0.0f;
  std::array<float, 3> normal{};
  std::array<float, 2> motion{};
};

// A frame of a view as the engine describes it, and its samples. They lie on the grid of
// inspect.comp, row by row.
struct InspectedFrame {
  AlcoveCamera camera{};
  VkExtent2D size{};        // of the part of the images that is in use
  VkExtent2D depth_size{};  // of the whole images, as the device reports them
  VkExtent2D normals_size{};
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool has_normals = false;
  bool has_motion = false;
  NormalConvention normals;
  MotionConvention motion;
  float radius = 0.0f;
  bool is_static = false;          // static_frames is not 0
  bool continues_history = false;  // there is a history, which reset_history does not discard
  bool has_largest_size = false;
  bool has_area = false;  // the view says which part of the images is in use
  std::vector<PixelSample> samples;
};

// Returns what a frame shows. `frames` begins with this frame, followed by up to two earlier frames
// of the view, the newest first. With too few samples, nothing is judged.
[[nodiscard]] Findings inspect(std::span<const InspectedFrame> frames);

}  // namespace alcove::passes

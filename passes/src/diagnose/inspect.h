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
#define ALCOVE_MISTAKE(name, sentence) name,
#include "diagnose/mistakes.inc"
#undef ALCOVE_MISTAKE
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
  AlcoveCamera previous_camera{};
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

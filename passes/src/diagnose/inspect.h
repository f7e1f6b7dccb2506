// Finds mistakes of the caller by means of the pixels of a view's inputs. A few thousand samples of
// depth, normals and motion vectors are compared with the cameras and the formats that the caller
// states, in one frame and from frame to frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alcove/alcove.h"

namespace alcove::passes {

enum class Mistake : std::uint8_t {
#define ALCOVE_MISTAKE(name, sentence) name,
#include "diagnose/mistakes.inc"
#undef ALCOVE_MISTAKE
  count,  // also: no mistake
};

// The frames of a view that could show a mistake.
struct Sighting {
  std::uint32_t frames = 0;  // a bit for each of them, the newest first: whether it showed
  float measure = 0.0f;      // the number of the sentence, where there is one
};

class Sightings {
 public:
  void note(Mistake mistake, bool is_seen, double measure = 0.0) {
    Sighting& sighting = of_.at(static_cast<std::size_t>(mistake));
    sighting.frames = sighting.frames << 1 | (is_seen ? 1 : 0);
    if (is_seen) sighting.measure = static_cast<float>(measure);
  }
  // Notes that a frame shows `found`, and no other mistake from `first` to `last`.
  void note_all(Mistake first, Mistake last, Mistake found, double measure = 0.0) {
    for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i)
      note(static_cast<Mistake>(i), static_cast<Mistake>(i) == found, measure);
  }
  const Sighting& operator[](std::size_t mistake) const { return of_.at(mistake); }

 private:
  std::array<Sighting, static_cast<std::size_t>(Mistake::count)> of_{};
};

// A sampled pixel: its depth and those of its four neighbours, its normal and its motion vector,
// all as they are stored in the textures, and in the order in which inspect.comp writes them.
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
  std::uint32_t serial = 0;  // counts the frames of the context
  AlcoveViewInfo info{};     // its settings are these, and no longer those of the engine
  AlcoveSettings settings{};
  VkExtent2D size{};        // of the part of the images that is in use
  VkExtent2D depth_size{};  // of the whole images, as the device reports them
  VkExtent2D normals_size{};
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool has_normals = false;
  bool has_motion = false;
  std::vector<PixelSample> samples;

  // There is a history, which reset_history does not discard.
  [[nodiscard]] bool continues_history() const {
    return info.reset_history == 0 && settings.history_frames > 0;
  }
};

// Returns whether two cameras differ in their translation and projection at most.
[[nodiscard]] bool same_rotation(AlcoveCamera a, const AlcoveCamera& b);

// Notes what a frame shows. `frames` begins with this frame, followed by up to two earlier frames
// of the view, the newest first. A mistake that its samples are too few to show is not noted.
void inspect(std::span<const InspectedFrame> frames, Sightings& sightings);

}  // namespace alcove::passes

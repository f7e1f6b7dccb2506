// Finds mistakes of the caller by means of the pixels of a view's inputs. A few thousand samples of
// depth, normals and motion vectors are compared with the cameras and the formats that the caller
// states, in one frame and from frame to frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alcove/alcove.h"
#include "diagnose/mistakes.h"

namespace alcove::passes {

// The frames of a view that could show a mistake, from the first that showed it.
struct Sighting {
  const Mistake* mistake = nullptr;
  std::uint32_t frames = 0;  // a bit for each of them, the newest first: whether it showed
  float measure = 0.0f;      // the number of the sentence, where there is one
  std::uint32_t last = 0;    // the record of the view in which it was noted last that it showed
};

class Sightings {
 public:
  void begin_record() { ++record_; }
  // Notes whether a frame shows a mistake.
  void note(const Mistake& mistake, bool is_seen, double measure = 0.0) {
    const auto place = std::ranges::find_if(seen_, [&](const Sighting& sighting) {
      return sighting.mistake == &mistake || sighting.mistake == nullptr;
    });
    if (place->mistake == nullptr && !is_seen) return;
    place->mistake = &mistake;
    place->frames = place->frames << 1 | (is_seen ? 1 : 0);
    if (!is_seen) return;
    place->measure = static_cast<float>(measure);
    place->last = record_;
  }
  // Notes that a frame shows `found`, if it is not null, and no other mistake of these groups.
  void note_groups(unsigned groups, const Mistake* found, double measure = 0.0) {
    for (Sighting& sighting : seen_)
      if (sighting.mistake != nullptr && sighting.mistake != found &&
          (sighting.mistake->group & groups) != 0)
        sighting.frames <<= 1;
    if (found != nullptr) note(*found, true, measure);
  }
  // Frames that cannot show a mistake count too, so that its sentence leaves when the engine no
  // longer does what was wrong.
  bool is_recent(const Sighting& sighting) const { return record_ - sighting.last < 32; }
  auto begin() const { return seen_.begin(); }
  auto end() const { return seen_.end(); }

 private:
  std::uint32_t record_ = 0;
  std::array<Sighting, 64> seen_{};  // more than there are mistakes
};

// A sampled pixel, as inspect.comp writes it: its depth and those of its four neighbours, its
// normal and its motion vector, all as they are stored in the textures, and its position in the
// image.
struct PixelSample {
  float depth = 0.0f;
  float left = 0.0f;
  float right = 0.0f;
  float up = 0.0f;
  float down = 0.0f;
  std::array<float, 3> normal{};
  std::array<float, 2> motion{};
  float x = 0.0f;
  float y = 0.0f;
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

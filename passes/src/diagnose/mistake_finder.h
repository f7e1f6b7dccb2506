// Collects the mistakes of the engine that show in the calls and in the pixels of recent frames.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "diagnose/inspect.h"
#include "maths/language.h"

namespace alcove::passes {

// A mistake is reported if most of the last frames that could show it did show it. It is then named
// whenever it begins, and no longer once it has been mended. Only describe() allocates memory.
class MistakeFinder {
 public:
  // The sentence about views that are never dropped.
  static const char* const kTooManyViews;

  // Observes the arguments of a frame that was recorded. Returns true the first time that there are
  // more views with a history than an engine could mean.
  bool observe(const AlcoveFrame& frame);
  // Returns what the recent frames of a view show, or null if the view is unknown.
  Sightings* sightings(std::uint32_t view_id);
  void drop_view(std::uint32_t id);

  // Returns a line for each mistake, or an empty text if there is none.
  [[nodiscard]] std::string describe() const;

 private:
  struct View {
    bool used = false;
    bool has_history = false;
    std::uint32_t id = 0;
    std::uint32_t last_frame = 0;  // in which it was recorded
    // Values of the last recorded frame:
    std::uint32_t index = 0;
    AlcoveCamera camera{};
    std::array<maths::dvec3, 3> eyes{};  // of the last three records
    std::uint32_t half_resolution = 0;
    VkExtent2D size{};
    Sightings sightings;
  };
  View* find(std::uint32_t id);
  View& create(const AlcoveView& given);
  static void judge(View& view, const AlcoveView& given, std::uint32_t index);

  std::array<View, std::size_t{4} * ALCOVE_MAX_VIEWS> views_;
  std::uint32_t frames_ = 0;
  bool is_new_ = false;         // a view of this frame is new and has a history
  std::uint8_t new_views_ = 0;  // the same for the last eight frames, a bit each
  bool too_many_views_ = false;
  bool told_of_views_ = false;
};

}  // namespace alcove::passes

// Finds mistakes of the engine in the arguments of successive frames of a context.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "alcove/alcove.h"

namespace alcove::passes {

// Observes the arguments of calls. It reads no pixel, and only describe() allocates memory.
class CallObserver {
 public:
  // Call it for each frame that was recorded.
  void observe(const AlcoveFrame& frame);

  // Returns a line for each mistake, or an empty text if there is none.
  [[nodiscard]] std::string describe() const;

 private:
  // Counts the frames in which a mistake was seen, and the frames in which it could be seen. Counts
  // stop at a thousand.
  struct Share {
    std::uint32_t seen = 0;
    std::uint32_t of = 0;
    void add(bool now) {
      if (of < 1000) {
        ++of;
        seen += now ? 1 : 0;
      }
    }
    // Returns true if the mistake was seen in all of at least kSureFrames frames.
    bool always() const { return of >= kSureFrames && seen == of; }
    static constexpr std::uint32_t kSureFrames = 8;
  };
  struct View {
    bool used = false;
    std::uint32_t id = 0;
    AlcoveCamera camera{};        // of the last recorded frame
    Share previous_is_this;       // previous_camera is this frame's although the camera moved
    Share previous_is_another;    // it is neither this frame's nor the last one's
    Share projection_is_another;  // only its projection is not the last frame's
    Share static_in_motion;       // static_frames is not 0 although the camera moved
    Share reset;                  // reset_history is set, after the first frame
  };
  void observe(View& view, const AlcoveView& given);

  std::array<View, ALCOVE_MAX_VIEWS> views_;
  bool began_ = false;
  std::uint32_t index_ = 0;
  std::uint32_t same_index_ = 0;  // frames in a row with this index
};

}  // namespace alcove::passes

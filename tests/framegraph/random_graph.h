// Declares random valid frames for tests, with every kind of resource and access that a pass can
// have.
#pragma once

#include <cstdint>
#include <span>

#include "alcove/framegraph/graph.h"

namespace alcove::framegraph {

// A source of random choices: either a random number generator with a seed, or the bytes of a
// fuzzer.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  explicit Dice(std::span<const std::uint8_t> bytes) : bytes_(bytes), from_bytes_(true) {}

  // Returns 0 to sides - 1, and always 0 after all bytes are used.
  std::uint32_t roll(std::uint32_t sides) {
    if (sides <= 1) return 0;
    if (from_bytes_) {
      if (bytes_.empty()) return 0;
      std::uint32_t value = bytes_[0];
      bytes_ = bytes_.subspan(1);
      if (sides > 256 && !bytes_.empty()) {
        value = value << 8 | bytes_[0];
        bytes_ = bytes_.subspan(1);
      }
      return value % sides;
    }
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t value = state_;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::uint32_t>((value >> 32) % sides);
  }
  bool chance(std::uint32_t of_256) { return roll(256) < of_256; }
  bool empty() const { return from_bytes_ && bytes_.empty(); }

 private:
  std::uint64_t state_ = 1;
  std::span<const std::uint8_t> bytes_;
  bool from_bytes_ = false;
};

struct RandomOptions {
  std::uint32_t most_passes = 14;
  std::uint32_t most_side = 256;
  bool imports = true;
  bool histories = true;
  bool transient_buffers = true;
  bool queues = false;              // with passes on compute and transfer queues
  std::uint32_t side_effects = 20;  // probability in 1/256 that a pass has side effects
  bool any_states = false;          // with imports in any initial and final state
  bool mistakes = false;            // with stale and foreign handles, wrong ranges and sizes
};

// Declares a frame. The callbacks record nothing.
void declare_random(Graph& graph, Dice& dice, const RandomOptions& options = {});

// Declares passes that each read up to three of the last 16 textures and write one or two new ones
// of random size. No pass is culled. `width` is the width of the first texture of the pass in the
// middle; 0: it is random too.
void declare_sizes(Graph& graph, Dice& dice, std::uint32_t passes, std::uint32_t width = 0);

}  // namespace alcove::framegraph

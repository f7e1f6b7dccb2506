// Computes which accesses of a replayed plan are ordered, available and visible, by Vulkan's memory
// model ("Execution and Memory Dependencies" of the specification). It does not depend on how plans
// are made.
//
// It keeps the barriers, signals and waits of the replay in a list. To answer a question about an
// operation, it follows them from the operation on, and collects the stages and accesses that the
// operation has reached. The cost of an answer is proportional to their number since the operation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "alcove/framegraph/plan.h"

namespace alcove::framegraph::verifier {

using Stages = VkPipelineStageFlags2;
using Accesses = VkAccessFlags2;

// Replace stage and access bits that stand for several others by those others.
Stages expand_stages(Stages stages);
Accesses expand_accesses(Accesses accesses);
bool is_write(Accesses accesses);
Accesses reads_of(Accesses accesses);
// Return whether a queue can run these stages, and whether the stages can make each of the
// accesses.
bool supports(QueueClass queue, Stages stages);
bool supports(Stages stages, Accesses accesses);

// One access of a command to a subresource, or the effect of a barrier on it.
struct Operation {
  bool is_change = false;  // a layout change: it happens before any command of `stages`
  std::uint8_t queue = 0;
  std::size_t time = 0;  // HappensBefore::now()
  Stages stages = 0;     // expanded by expand_stages()
  Accesses writes = 0;   // of an access: its bits that write
  Accesses seen_by = 0;  // of a change: the accesses of `stages` that see it
  bool operator==(const Operation&) const = default;
};

// A barrier with expanded scopes. `memory` is true if its memory dependency covers all resources,
// and false if it covers only one image.
struct Barrier {
  std::uint8_t queue = 0;
  Stages src = 0;
  Accesses src_access = 0;
  Stages dst = 0;
  Accesses dst_access = 0;
  bool memory = false;
};
Barrier barrier_of(const Transition& transition, QueueClass queue);

class HappensBefore {
 public:
  std::size_t now() const { return steps_.size(); }
  // Applies the barriers of one command. They are not ordered among each other.
  void apply(const std::vector<Barrier>& barriers) {
    steps_.push_back({Step::Kind::barriers, 0, 0, barriers});
  }
  // signal() records the signal of a submission, numbered from 0. wait() makes these stages of a
  // queue wait for the last signal of that number.
  void signal(std::uint8_t queue, std::uint32_t submission);
  void wait(std::uint8_t queue, std::uint32_t submission, Stages stages);

  // is_before() returns whether the operation is ordered before the barrier's second scope.
  // is_available_by() returns whether its writes are also available there, if the barrier's memory
  // dependency covers the operation's resource.
  bool is_before(const Operation& operation, const Barrier& barrier) const;
  bool is_available_by(const Operation& operation, const Barrier& barrier) const;
  // Functions about the next command of these stages on this queue. is_ordered() returns whether
  // the operation happens before that command. is_available() returns whether the operation's
  // writes are then also available. is_visible() returns whether they are visible to these
  // accesses.
  bool is_ordered(const Operation& operation, std::uint8_t queue, Stages stages) const;
  bool is_available(const Operation& operation, std::uint8_t queue, Stages stages) const;
  bool is_visible(const Operation& operation, std::uint8_t queue, Stages stages,
                  Accesses accesses) const;

 private:
  // The barriers of one command, or a signal or wait of a queue.
  struct Step {
    enum class Kind : std::uint8_t { barriers, signal, wait };
    Kind kind = Kind::barriers;
    std::uint8_t queue = 0;
    std::size_t signal = 0;         // the step that a wait waits for
    std::vector<Barrier> barriers;  // of a wait: one, whose second scope is that of the wait
  };
  // A part of an operation, and what comes after it. A part is one stage of an access with one of
  // its writes, or without one. A layout change has one part.
  struct Part {
    std::uint8_t queue = 0;
    Stages source = 0;   // barriers over these stages wait for the part directly
    Accesses write = 0;  // one bit, or 0
    // By queue: the stages whose next command comes after the part, and those for which its write
    // is also available.
    std::array<Stages, kQueueClasses> ordered{};
    std::array<Stages, kQueueClasses> available{};

    bool is_before(const Barrier& barrier) const;
    bool is_available_by(const Barrier& barrier, bool covers) const;
  };
  struct Reach : Part {
    struct Sight {
      std::uint8_t queue = 0;
      Stages stages = 0;
      Accesses accesses = 0;
    };
    std::vector<Sight> visible;

    void add(const Barrier& barrier, bool makes_available);
    bool is_seen(std::uint8_t by, Stages stages, Accesses accesses) const;
  };

  void follow(std::size_t from, Reach& reach) const;
  // Returns whether f(reach) is true for all parts of an operation.
  template <typename Function>
  bool all_parts(const Operation& operation, const Function& f) const;

  std::vector<Step> steps_;
  std::vector<std::size_t> signals_;  // by submission: the step of its last signal
};

}  // namespace alcove::framegraph::verifier

// Computes which accesses of a replayed plan are ordered, available and visible, by Vulkan's memory
// model ("Execution and Memory Dependencies" of the specification). It does not depend on how plans
// are made.
//
// Time counts the commands of the replay. A source is a queue, a stage, and a write access or none.
// A destination is a queue and a stage. For each pair of a source and a destination, the model
// keeps one time: all accesses of the source up to it happen before the next command of the
// destination. One time is enough, because a barrier that orders a command of a stage orders all
// earlier commands of that stage and queue too. The cost of a barrier therefore depends on the
// number of stages, and not on the number of earlier commands.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "alcove/framegraph/plan.h"

namespace alcove::framegraph::verifier {

using Stages = VkPipelineStageFlags2;
using Accesses = VkAccessFlags2;
using Time = std::uint32_t;

// Replace stage and access bits that stand for several others by those others.
Stages expand_stages(Stages stages);
Accesses expand_accesses(Accesses accesses);
bool is_write(Accesses accesses);
Accesses reads_of(Accesses accesses);

// One access of a command to a subresource, or the effect of a barrier on it.
struct Operation {
  enum class Kind : std::uint8_t {
    access,
    change,   // a layout change; it happens before any command of `stages`, its second scope
    release,  // an ownership release; only the signal of its submission comes after it
  };
  Kind kind = Kind::access;
  std::uint8_t queue = 0;
  Time time = 0;
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
  // Creates an empty model. `stages` and `accesses` contain every expanded bit that an access or a
  // barrier of the plan names. `queues` is the number of queue classes.
  HappensBefore(Stages stages, Accesses accesses, std::uint32_t queues);

  // Returns the stages that the constructor was given.
  Stages tracked_stages() const {
    return std::accumulate(stages_.begin(), stages_.end(), Stages{0});
  }

  // Starts the next command and returns its time.
  Time next() { return ++now_; }
  Time now() const { return now_; }
  // Applies the barriers of one command. They are not ordered among each other.
  void apply(std::span<const Barrier> barriers);
  // signal() records the signal of a submission, numbered from 0. wait() makes a queue wait for it.
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
  // Returns whether the operation happens before the next command of any of these stages.
  bool is_before_any(const Operation& operation, std::uint8_t queue, Stages stages) const;

 private:
  // For each source, the times up to which one barrier of the current batch orders its accesses.
  struct ScopeTimes {
    std::vector<Time> ordered;
    std::vector<Time> available;  // by source and write access
  };

  std::size_t place(std::uint8_t queue, std::size_t stage) const {
    return queue * stages_.size() + stage;
  }
  Time& ordered(std::size_t source, std::size_t to) { return ordered_[source * places_ + to]; }
  Time ordered(std::size_t source, std::size_t to) const { return ordered_[source * places_ + to]; }
  Time& available(std::size_t source, std::size_t write, std::size_t to) {
    return available_[(source * writes_.size() + write) * places_ + to];
  }
  Time available(std::size_t source, std::size_t write, std::size_t to) const {
    return available_[(source * writes_.size() + write) * places_ + to];
  }
  // Returns the array of times, one for each access of the destination, up to which the writes of a
  // source are visible to a destination. `write` is writes_.size() if the source does not write.
  Time* visible(std::size_t source, std::size_t write, std::size_t to) {
    return &visible_[((source * (writes_.size() + 1) + write) * places_ + to) * accesses_.size()];
  }
  const Time* visible(std::size_t source, std::size_t write, std::size_t to) const {
    return &visible_[((source * (writes_.size() + 1) + write) * places_ + to) * accesses_.size()];
  }
  void reach(const Barrier& barrier, ScopeTimes& scope) const;
  void spread(const Barrier& barrier, const ScopeTimes& scope);
  template <typename Function>
  bool all_stages(Stages stages, Function&& f) const;
  template <typename Function>
  bool any_stage(Stages stages, Function&& f) const;
  template <typename Function>
  bool all_writes(Accesses writes, Function&& f) const;
  // Calls f(index of a source) for each stage of an operation and combines the results. An access
  // requires f for all of its stages, a layout change for any of them.
  template <typename Function>
  bool holds(const Operation& operation, Function&& f) const;
  // Returns whether `stage` is in the second scope of the barrier that made the layout change. The
  // layout change happens before the commands of those stages.
  static bool is_own(const Operation& operation, std::uint8_t queue, Stages stage) {
    return operation.kind == Operation::Kind::change && operation.queue == queue &&
           (operation.stages & stage) != 0;
  }

  std::vector<Stages> stages_;      // one bit each
  std::vector<Accesses> writes_;    // one bit each
  std::vector<Accesses> accesses_;  // one bit each
  std::size_t places_ = 0;          // number of queues times number of stages
  Time now_ = 0;
  std::vector<Time> ordered_;
  std::vector<Time> available_;
  std::vector<Time> visible_;
  std::vector<ScopeTimes> scopes_;            // by barrier of a command
  std::vector<std::vector<Time>> signalled_;  // by submission, by source
};

}  // namespace alcove::framegraph::verifier

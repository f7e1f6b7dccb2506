// Tells which accesses of a replayed plan are ordered, available and visible, by Vulkan's memory
// model
// ("Execution and Memory Dependencies" of the specification). Knows nothing of how plans are made.
//
// Time counts the commands of the replay. The model keeps, for each source (a queue, a stage and an
// access that writes, or none) and each destination (a queue and a stage), the latest time up to
// which the source's accesses happen before the next command of the destination. One time is
// enough: a barrier that orders a command of a stage orders all earlier commands of that stage and
// queue too. A barrier therefore costs time in the number of stages, and not in the number of
// earlier commands.
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

// Stages and accesses that stand for several others, as those others.
Stages expand_stages(Stages stages);
Accesses expand_accesses(Accesses accesses);
bool is_write(Accesses accesses);
Accesses reads_of(Accesses accesses);

// One access of a command, or what a barrier does to a subresource.
struct Operation {
  enum class Kind : std::uint8_t {
    access,
    change,   // a layout change: it happens before any command of `stages`, its second scope
    release,  // an ownership release: nothing on its queue follows it, its submission's signal does
  };
  Kind kind = Kind::access;
  std::uint8_t queue = 0;
  Time time = 0;
  Stages stages = 0;     // expanded
  Accesses writes = 0;   // of an access: the bits that write
  Accesses seen_by = 0;  // of a change: the accesses of `stages` that see it
  bool operator==(const Operation&) const = default;
};

// A barrier with its scopes expanded. `memory`: its memory dependency covers every resource, and
// not one image alone.
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
  // The stages and accesses that the plan's accesses and barriers name, expanded, and the number of
  // queue classes.
  HappensBefore(Stages stages, Accesses accesses, std::uint32_t queues);

  // The stages of the first argument of the constructor.
  Stages tracked_stages() const {
    return std::accumulate(stages_.begin(), stages_.end(), Stages{0});
  }

  // The next command's time.
  Time next() { return ++now_; }
  Time now() const { return now_; }
  // The barriers of one command, which do not follow each other.
  void apply(std::span<const Barrier> barriers);
  // The signal of a submission, numbered from 0, and a wait for it.
  void signal(std::uint8_t queue, std::uint32_t submission);
  void wait(std::uint8_t queue, std::uint32_t submission, Stages stages);

  // Whether the operation comes before the barrier's second scope, and whether its writes are then
  // available, where the barrier's memory dependency covers its resource.
  bool is_before(const Operation& operation, const Barrier& barrier) const;
  bool is_available_by(const Operation& operation, const Barrier& barrier) const;
  // Whether the operation happens before the next command of these stages, whether its writes are
  // then available, and whether these accesses of it see them.
  bool is_ordered(const Operation& operation, std::uint8_t queue, Stages stages) const;
  bool is_available(const Operation& operation, std::uint8_t queue, Stages stages) const;
  bool is_visible(const Operation& operation, std::uint8_t queue, Stages stages,
                  Accesses accesses) const;
  // Whether it happens before the next command of any of these stages.
  bool is_before_any(const Operation& operation, std::uint8_t queue, Stages stages) const;

 private:
  // The times that a barrier of the batch in hand reaches, by source.
  struct Reached {
    std::vector<Time> ordered;
    std::vector<Time> available;  // by write too
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
  // `write` is writes_.size() where the source does not write. The first of all accesses.
  Time* visible(std::size_t source, std::size_t write, std::size_t to) {
    return &visible_[((source * (writes_.size() + 1) + write) * places_ + to) * accesses_.size()];
  }
  const Time* visible(std::size_t source, std::size_t write, std::size_t to) const {
    return &visible_[((source * (writes_.size() + 1) + write) * places_ + to) * accesses_.size()];
  }
  void reach(const Barrier& barrier, Reached& reached) const;
  void spread(const Barrier& barrier, const Reached& reached);
  template <typename Function>
  bool all_stages(Stages stages, Function&& f) const;
  template <typename Function>
  bool any_stage(Stages stages, Function&& f) const;
  template <typename Function>
  bool all_writes(Accesses writes, Function&& f) const;
  // f(place of a source) for the stages of an access, all of them, or of a change, any of them.
  template <typename Function>
  bool holds(const Operation& operation, Function&& f) const;
  // A change is before the stages that its own barrier names.
  static bool is_own(const Operation& operation, std::uint8_t queue, Stages stage) {
    return operation.kind == Operation::Kind::change && operation.queue == queue &&
           (operation.stages & stage) != 0;
  }

  std::vector<Stages> stages_;      // one bit each
  std::vector<Accesses> writes_;    // one bit each
  std::vector<Accesses> accesses_;  // one bit each
  std::size_t places_ = 0;          // queues times stages
  Time now_ = 0;
  std::vector<Time> ordered_;
  std::vector<Time> available_;
  std::vector<Time> visible_;
  std::vector<Reached> reached_;              // by barrier of a command
  std::vector<std::vector<Time>> signalled_;  // by submission, by source
};

}  // namespace alcove::framegraph::verifier

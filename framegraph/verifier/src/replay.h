// The verifier's replay of a plan: see verify.h.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "alcove/framegraph/verify.h"
#include "happens_before.h"

namespace alcove::framegraph::verifier {

// The contents of a subresource: the index of the access that wrote it last, or one of these
// values.
inline constexpr std::uint32_t kGarbage = kNone;      // undefined
inline constexpr std::uint32_t kInitial = kNone - 1;  // the initial contents of an import
inline constexpr std::uint32_t kMissing = kNone - 2;  // the expected writer does not run

// The last operations on a subresource.
struct History {
  std::vector<Operation> writes;  // the last write or layout change; several if before the frame
  std::vector<Operation> reads;   // the reads after those writes
};

struct Sub {
  History last;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::uint32_t content = kGarbage;
  bool spoiled = false;  // a partial write was made over wrong contents
  bool fresh = false;    // it was not used after the resource took its memory
  bool written = false;  // a pass of this frame wrote it
  bool needed = false;   // a later pass, or somebody after the frame, needs the contents
  std::uint32_t declared = kGarbage;  // its contents after the declared frame
  std::size_t changed = 0;            // the time of its last layout change
};

class Replay {
 public:
  Replay(const GraphDescription& graph, const Limits& limits, const Plan& plan, Errors& errors)
      : graph_(graph), limits_(limits), plan_(plan), errors_(errors) {}
  void run();

 private:
  // The last operations on a range of bytes by the resources that occupied it before.
  struct Former {
    std::uint32_t resource = kNone;
    Operation operation;
    bool writes = false;
    bool read_since = false;
    bool operator==(const Former&) const = default;
  };
  struct Resource {
    // The subresource of a mip and layer is at layer * mips + mip.
    std::vector<Sub> subs;
    bool has_memory = false;
    bool used = false;  // by a pass of this frame
    std::vector<Former> former;
  };
  // A range of bytes of a heap, keyed by its end: its owner and its first byte.
  struct Bytes {
    VkDeviceSize begin = 0;
    std::uint32_t resource = kNone;
  };
  using Memory = std::map<VkDeviceSize, Bytes>;

  // Returns the number of the semaphore signal that stands for all work of a queue in the frame.
  // These signals are numbered after those of the submissions.
  std::uint32_t end_signal(std::uint8_t queue) const {
    return static_cast<std::uint32_t>(plan_.submissions.size()) + queue;
  }
  void find_expected();
  void begin_frame();
  void begin(Origin origin);
  void apply_initial_state(Sub& sub, std::uint8_t queue, const State& initial_state);
  void submission(std::uint32_t index);
  void batch(std::uint32_t index, QueueClass queue);
  void change(const Transition& transition, QueueClass queue);
  void check_order_of_change(std::uint32_t resource, const Barrier& barrier, const Sub& sub);
  void check_layout_of_change(const Transition& transition, Sub& sub);
  void check_stores();
  void take_memory(std::uint32_t resource);
  void keep_former(Resource& taker, std::uint32_t resource);
  void pass(std::uint32_t position);

  // accesses.cpp
  void check_access(std::uint32_t position, std::uint32_t access_index);
  void check_read(const AccessRecord& access, std::uint32_t expected, const Sub& sub,
                  std::uint8_t queue);
  void check_write(const AccessRecord& access, std::uint32_t expected, Sub& sub,
                   std::uint8_t queue);
  void check_former(const AccessRecord& access, std::uint8_t queue);
  void apply_access(std::uint32_t position, std::uint32_t access_index);
  void end_frame();
  bool holds(std::uint32_t resource) const;
  void check_final_state(std::uint32_t resource);
  void check_histories();
  void check_final(const FinalState& final);
  void check_final_write(const FinalState& final, const Operation& write, bool is_read);

  template <typename Function>
  void for_each_sub(std::uint32_t resource, const Range& range, Function&& f) {
    auto& subs = resources_[resource].subs;
    const ResourceRecord& record = graph_.resources[resource];
    if (record.kind == ResourceKind::buffer) {
      f(subs[0]);
      return;
    }
    for (std::uint32_t i = range.base_layer; i < range.base_layer + range.layers; ++i)
      for (std::uint32_t mip = 0; mip < range.mips; ++mip)
        f(subs[i * record.mips + range.base_mip + mip]);
  }
  void fail(const std::string& what);
  std::string name(std::uint32_t resource) const;

  const GraphDescription& graph_;
  const Limits& limits_;
  const Plan& plan_;
  Errors& errors_;
  HappensBefore order_;
  std::vector<Resource> resources_;
  std::vector<Memory> memory_;  // by heap
  // expected_ has, for each subresource of each access's range, the contents that the access must
  // find. first_expected_ has the index of the first entry of each access.
  std::vector<std::uint32_t> expected_;
  std::vector<std::size_t> first_expected_;
  std::vector<Barrier> barriers_;  // of the current batch
  std::string where_;
};

// Checks the plan's tables by themselves: indices, passes, lifetimes and heaps. Returns false if a
// replay could read out of bounds.
bool check_tables(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors);

}  // namespace alcove::framegraph::verifier

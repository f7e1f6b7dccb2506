// The verifier's replay of a plan: see verify.h.
#pragma once

#include <string>
#include <vector>

#include "alcove/framegraph/verify.h"
#include "verify_model.h"

namespace alcove::framegraph::verifier {

// What a subresource holds: the access that wrote it last, by index, or one of these.
inline constexpr std::uint32_t kGarbage = kNone;      // nothing, or somebody else's bytes
inline constexpr std::uint32_t kInitial = kNone - 1;  // what an import arrived with
// Where an expected writer does not run.
inline constexpr std::uint32_t kMissing = kNone - 2;

struct Sub {
  std::vector<Piece> writes;  // of the last write or layout change
  std::vector<Piece> reads;   // since
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::uint32_t content = kGarbage;
  bool spoiled = false;          // a partial write fell on contents that were not the expected ones
  std::uint32_t family = kNone;  // owner; kNone: anybody may take it
  bool released = false;         // on its way to `released_to`
  std::uint32_t released_to = kNone;
  VkImageLayout released_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

class Replay {
 public:
  Replay(const GraphDescription& graph, const Limits& limits, const Plan& plan, Errors& errors);
  void run();

 private:
  struct Resource {
    std::vector<Sub> subs;                   // mips within layers
    std::vector<std::uint32_t> overlapping;  // resources on some of the same bytes
  };

  void find_overlaps();
  void find_expected();
  void begin_frame(bool first);
  static void arrive(Sub& sub, std::uint8_t queue, const State& initial_state);
  void submission(std::uint32_t index);
  void batches(std::uint32_t first, std::uint32_t count, std::uint32_t submission);
  void batch(const Batch& batch, QueueClass queue);
  void set_events(const PlannedPass& planned, std::uint32_t submission);
  void wait_for_event(const Batch& batch, std::uint32_t submission);
  Reach reach_of(const Piece& piece, const Batch& batch, std::uint32_t transition,
                 const Scopes& scopes, bool memory) const;
  void apply_batch(const Batch& batch, QueueClass queue, std::uint32_t resource, Piece& piece);
  void change(const Transition& transition, QueueClass queue);
  void check_order_of_change(const Batch& batch, std::uint32_t transition, const Scopes& scopes,
                             const Sub& sub);
  void check_state_of_change(const Transition& transition, const Scopes& scopes, const Sub& sub);
  void pass(std::uint32_t position);
  void check_access(std::uint32_t position, std::uint32_t access_index);
  void check_read(const AccessRecord& access, std::uint32_t expected, const Sub& sub,
                  std::uint8_t queue);
  void check_write(const AccessRecord& access, std::uint32_t expected, Sub& sub,
                   std::uint8_t queue);
  void check_state(const AccessRecord& access, const Sub& sub, std::uint8_t queue);
  void check_shared_memory(const AccessRecord& access, std::uint8_t queue);
  void apply_access(std::uint32_t position, std::uint32_t access_index);
  void end_frame();
  void check_final_state(std::uint32_t resource);
  void check_final(const FinalState& final);
  void check_final_writes(const FinalState& final, const Sub& sub);

  template <typename Function>
  void for_each_piece(Function&& f);
  template <typename Function>
  void for_each_sub(std::uint32_t resource, const Range& range, Function&& f);
  void fail(const std::string& what);
  std::string name(std::uint32_t resource) const;
  std::uint32_t family(std::uint8_t queue) const;

  const GraphDescription& graph_;
  const Limits& limits_;
  const Plan& plan_;
  Errors& errors_;
  std::vector<Resource> resources_;
  // By access, by subresource of its range: what must be there before it.
  std::vector<std::vector<std::uint32_t>> expected_;
  std::vector<std::vector<std::uint32_t>> last_;  // by resource: what must be there in the end
  bool several_queues_ = false;
  std::uint32_t signals_ = 0;          // submissions of earlier frames
  std::vector<std::uint32_t> set_in_;  // by event: the submission that set it
  std::string where_;
};

// The plan's tables by themselves: indices, passes, lifetimes, heaps. False when a replay would not
// be safe.
bool check_tables(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors);

}  // namespace alcove::framegraph::verifier

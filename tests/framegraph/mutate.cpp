#include "mutate.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace alcove::framegraph {
namespace {

class Mutator {
 public:
  Mutator(const GraphDescription& graph, const Plan& plan,
          const std::function<void(const std::string&, const Plan&)>& visit)
      : graph_(graph), plan_(plan), visit_(visit) {}

  void run() {
    for (std::uint32_t i = 0; i < plan_.transitions.size(); ++i) {
      drop_transition(i);
      narrow(i);
      change_layouts(i);
      add_bits(i);
    }
    for (std::uint32_t i = 0; i < plan_.batches.size(); ++i) drop_batch(i);
    for (std::uint32_t i = 0; i < plan_.placements.size(); ++i) {
      shrink_lifetime(i);
      collide(i);
    }
    for (std::uint32_t i = 0; i < plan_.submissions.size(); ++i) drop_waits(i);
    for (std::uint32_t i = 0; i < plan_.finals.size(); ++i) misstate_history(i);
    for (std::uint32_t i = 0; i < plan_.contents.size(); ++i) misstate_contents(i);
    for (const PlannedPass& planned : plan_.passes)
      visit("call a live pass unread", [&](Plan& mutant) {
        mutant.cull_reasons[planned.pass].cull_reason = CullReason::unread;
      });
    for (std::uint32_t i = 0; i < plan_.heaps.size(); ++i) {
      visit("allow no memory type", [=](Plan& mutant) { mutant.heaps[i].memory_types = 0; });
      visit("misstate the lower bound", [=](Plan& mutant) { ++mutant.heaps[i].lower_bound; });
    }
  }

 private:
  template <typename Change>
  void visit(const char* kind, const Change& change) {
    Plan mutant = plan_;
    change(mutant);
    visit_(kind, mutant);
  }

  // Moves the batches after a transition that was inserted (1) or removed (-1). The other
  // transitions of its own batch stay in it.
  static void shift_batches(Plan& plan, std::uint32_t index, int by) {
    for (Batch& batch : plan.batches)
      if (index < batch.first)
        batch.first += static_cast<std::uint32_t>(by);
      else if (index < batch.first + batch.count)
        batch.count += static_cast<std::uint32_t>(by);
  }

  void drop_transition(std::uint32_t index) {
    visit("drop a barrier", [=](Plan& mutant) {
      mutant.transitions.erase(mutant.transitions.begin() + index);
      shift_batches(mutant, index, -1);
    });
  }

  template <typename Mask>
  void narrow_mask(const char* kind, std::uint32_t index, Mask Transition::*mask) {
    for (Mask left = plan_.transitions[index].*mask; left != 0; left &= left - 1)
      visit(kind, [=](Plan& mutant) { mutant.transitions[index].*mask &= ~(left & (~left + 1)); });
  }

  void narrow(std::uint32_t index) {
    narrow_mask("narrow a source stage", index, &Transition::src_stages);
    narrow_mask("narrow a destination stage", index, &Transition::dst_stages);
    narrow_mask("narrow a source access", index, &Transition::src_access);
    narrow_mask("narrow a destination access", index, &Transition::dst_access);
  }

  void change_layouts(std::uint32_t index) {
    const Transition& t = plan_.transitions[index];
    if (t.resource == kNone || t.old_layout == t.new_layout) return;
    visit("swap the layouts", [=](Plan& mutant) {
      std::swap(mutant.transitions[index].old_layout, mutant.transitions[index].new_layout);
    });
    visit("change to another layout", [&](Plan& mutant) {
      mutant.transitions[index].new_layout = t.new_layout == VK_IMAGE_LAYOUT_GENERAL
                                                 ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                                                 : VK_IMAGE_LAYOUT_GENERAL;
    });
    if (t.range.mips > 1)
      visit("leave out a mip", [=](Plan& mutant) { --mutant.transitions[index].range.mips; });
  }

  // Makes mutants of a barrier with an access that its stages lack, with a stage that its queue
  // lacks, and with its layout change listed twice.
  void add_bits(std::uint32_t index) {
    const Transition& t = plan_.transitions[index];
    const bool reads_indices = (t.dst_stages & (VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
                                                VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)) != 0;
    if (!reads_indices)
      visit("add an access that the stages lack", [=](Plan& mutant) {
        mutant.transitions[index].dst_access |= VK_ACCESS_2_INDEX_READ_BIT;
      });
    for (const PlannedPass& planned : plan_.passes)
      if (planned.queue != QueueClass::graphics && planned.batch != kNone &&
          index - plan_.batches[planned.batch].first < plan_.batches[planned.batch].count)
        visit("add a stage that the queue lacks", [=](Plan& mutant) {
          mutant.transitions[index].src_stages |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
        });
    if (t.resource == kNone) return;
    visit("list a layout change twice", [&](Plan& mutant) {
      mutant.transitions.insert(mutant.transitions.begin() + index, t);
      shift_batches(mutant, index, 1);
    });
  }

  void misstate_contents(std::uint32_t index) {
    const AccessRecord& access = graph_.accesses[index];
    if (plan_.placements[access.resource].first == kNone || !is_live(index)) return;
    const auto visit_flag = [&](std::uint8_t flag, const char* kind) {
      visit(kind, [&](Plan& mutant) { mutant.contents[index] ^= flag; });
    };
    const bool draws = (access.access & (VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                         VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT)) != 0;
    if (draws)
      visit_flag(kHasContents,
                 plan_.contents[index] & kHasContents ? "leave out a load" : "load nothing");
    if (plan_.contents[index] & kIsNeeded) visit_flag(kIsNeeded, "leave out a store");
  }

  bool is_live(std::uint32_t access) const {
    std::uint32_t pass = 0;
    while (pass + 1 < graph_.passes.size() && graph_.passes[pass + 1].first_access <= access)
      ++pass;
    return plan_.cull_reasons[pass].is_live();
  }

  void drop_batch(std::uint32_t index) {
    if (plan_.batches[index].count < 2) return;
    visit("drop a batch", [=](Plan& mutant) { mutant.batches[index].count = 0; });
  }

  void shrink_lifetime(std::uint32_t resource) {
    const Placement& placement = plan_.placements[resource];
    if (placement.heap == kNone || placement.first == placement.last) return;
    if (is_used_at(resource, placement.last))
      visit("end a lifetime early", [=](Plan& mutant) { --mutant.placements[resource].last; });
    visit("begin a lifetime late", [=](Plan& mutant) { ++mutant.placements[resource].first; });
  }

  bool is_used_at(std::uint32_t resource, std::uint32_t position) const {
    const auto accesses = graph_.pass_accesses(plan_.passes[position].pass);
    return std::any_of(accesses.begin(), accesses.end(), [resource](const AccessRecord& access) {
      return access.resource == resource;
    });
  }

  // Makes mutants that move a resource to the memory of another one that is live at the same time,
  // and a mutant that moves it beyond the end of its heap.
  void collide(std::uint32_t resource) {
    const Placement& placement = plan_.placements[resource];
    if (placement.heap == kNone) return;
    for (std::uint32_t other = 0; other < plan_.placements.size(); ++other) {
      const Placement& there = plan_.placements[other];
      if (other == resource || there.heap != placement.heap || there.first > placement.last ||
          placement.first > there.last)
        continue;
      visit("shift an offset", [&](Plan& mutant) {
        mutant.placements[resource].offset = there.offset;
        mutant.heaps[placement.heap].size *= 2;
      });
      break;
    }
    visit("shift an offset out of the heap", [&](Plan& mutant) {
      mutant.placements[resource].offset = mutant.heaps[placement.heap].size;
    });
  }

  // Makes mutants that say something else about what the frame has written to a history, or
  // nothing.
  void misstate_history(std::uint32_t index) {
    for (const WriteCoverage written :
         {WriteCoverage::nothing, WriteCoverage::part, WriteCoverage::whole}) {
      if (plan_.finals[index].written == written) continue;
      visit("misstate a history", [=](Plan& mutant) { mutant.finals[index].written = written; });
    }
    visit("omit the final state of a history",
          [=](Plan& mutant) { mutant.finals.erase(mutant.finals.begin() + index); });
  }

  void drop_waits(std::uint32_t index) {
    for (std::uint32_t queue = 0; queue < kQueueClasses; ++queue) {
      if (!(plan_.submissions[index].frame_before & (1u << queue))) continue;
      visit("drop a wait for the frame before", [=](Plan& mutant) {
        mutant.submissions[index].frame_before &= static_cast<std::uint8_t>(~(1u << queue));
      });
    }
    for (std::uint32_t w = 0; w < plan_.submissions[index].wait_count; ++w) {
      const std::uint32_t at = plan_.submissions[index].first_wait + w;
      visit("drop a semaphore", [=](Plan& mutant) {
        mutant.waits.erase(mutant.waits.begin() + at);
        --mutant.submissions[index].wait_count;
        for (Submission& submission : mutant.submissions)
          if (submission.first_wait > at) --submission.first_wait;
      });
      for (VkPipelineStageFlags2 left = plan_.waits[at].stages; left != 0; left &= left - 1)
        visit("narrow a semaphore wait",
              [=](Plan& mutant) { mutant.waits[at].stages &= ~(left & (~left + 1)); });
    }
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  const std::function<void(const std::string&, const Plan&)>& visit_;
};

}  // namespace

void for_each_mutant(const GraphDescription& graph, const Plan& plan,
                     const std::function<void(const std::string&, const Plan&)>& visit) {
  Mutator(graph, plan, visit).run();
}

}  // namespace alcove::framegraph

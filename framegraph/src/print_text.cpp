// Plans as text: passes in order with their barriers, what was culled, and lifetimes against memory
// as a picture.
#include <algorithm>
#include <vector>

#include "alcove/framegraph/print.h"
#include "print_names.h"

namespace alcove::framegraph {
namespace {

constexpr std::size_t kNameWidth = 24;

std::string padded(std::string_view text, std::size_t width) {
  std::string out(text.substr(0, width));
  out.append(width - out.size(), ' ');
  return out;
}

class TextPrinter {
 public:
  TextPrinter(const GraphDescription& graph, const Plan& plan) : graph_(graph), plan_(plan) {}

  std::string print() {
    summary();
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) submission(s);
    culled();
    memory();
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_.append(text).append("\n"); }
  std::string name(std::uint32_t resource) const {
    return std::string(graph_.resource_name(resource));
  }

  void summary() {
    line(std::to_string(plan_.passes.size()) + " of " + std::to_string(graph_.passes.size()) +
         " passes" + (plan_.reordered ? ", reordered" : "") + ", " +
         std::to_string(plan_.batches.size()) + " barrier commands with " +
         std::to_string(plan_.transitions.size()) + " barriers, " +
         std::to_string(plan_.submissions.size()) + " submission(s)");
    for (const Heap& heap : plan_.heaps)
      line("heap: " + byte_size(heap.size) + ", lower bound " + byte_size(heap.lower_bound) +
           ", without aliasing " + byte_size(heap.unaliased));
    line("");
  }

  void submission(std::uint32_t index) {
    const Submission& submission = plan_.submissions[index];
    if (plan_.submissions.size() > 1) {
      std::string text =
          "submission " + std::to_string(index) + " on " + queue_name(submission.queue);
      for (std::uint32_t w = 0; w < submission.wait_count; ++w)
        text += (w ? ", " : " waits for ") +
                std::to_string(plan_.waits[submission.first_wait + w].submission);
      line(text);
    }
    for (std::uint32_t p = 0; p < submission.pass_count; ++p) pass(submission.first_pass + p);
    batches(submission.first_batch, submission.batch_count);
    line("");
  }

  void pass(std::uint32_t position) {
    const PlannedPass& planned = plan_.passes[position];
    batches(planned.first_batch, planned.batch_count);
    std::string text =
        padded(std::to_string(position), 4) + padded(graph_.pass_name(planned.pass), kNameWidth);
    const std::uint32_t first = graph_.passes[planned.pass].first_access;
    const auto accesses = graph_.pass_accesses(planned.pass);
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      const AccessRecord& access = accesses[i];
      const ResourceRecord& record = graph_.resources[access.resource];
      const bool writes = (access.flags & kWrite) != 0;
      text.append(writes ? " >" : " <").append(name(access.resource));
      text.append(".").append(std::to_string(access.version + (writes ? 1 : 0)));
      text.append(range_name(access.range, record.mips, record.layers));
      if (!plan_.live_accesses[first + i]) text += " (unread)";
    }
    line(text);
  }

  void batches(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t b = first; b < first + count; ++b) {
      const Batch& batch = plan_.batches[b];
      for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
        transition(plan_.transitions[t], set_after(plan_, batch));
    }
  }

  void transition(const Transition& t, std::uint32_t event_set_after) {
    std::string text = "      | ";
    if (event_set_after != kNone)
      text.append("event set after ").append(std::to_string(event_set_after)).append(": ");
    text.append(stage_names(t.src_stages)).append(" -> ").append(stage_names(t.dst_stages));
    if (t.resource != kNone) {
      const ResourceRecord& record = graph_.resources[t.resource];
      text.append(": ").append(name(t.resource));
      text.append(range_name(t.range, record.mips, record.layers));
      if (record.kind == ResourceKind::texture)
        text.append(" ")
            .append(layout_name(t.old_layout))
            .append(" -> ")
            .append(layout_name(t.new_layout));
    }
    if (t.src_queue != t.dst_queue)
      text.append(", ")
          .append(queue_name(t.src_queue))
          .append(" gives to ")
          .append(queue_name(t.dst_queue));
    line(text);
  }

  void culled() {
    bool any = false;
    for (std::uint32_t pass = 0; pass < plan_.fates.size(); ++pass) {
      const PassFate& fate = plan_.fates[pass];
      if (fate.fate != Fate::unread && fate.fate != Fate::writes_nothing) continue;
      line("culled: " + std::string(graph_.pass_name(pass)) +
           (fate.fate == Fate::unread ? ", nobody reads what it writes"
                                      : ", it writes nothing and has no side effect"));
      any = true;
    }
    if (any) line("");
  }

  // One row for each transient, by offset; one column for each position (or several, when there
  // are more positions than columns).
  void memory() {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t r = 0; r < plan_.placements.size(); ++r) {
      if (plan_.placements[r].heap != kNone) rows.push_back(r);
    }
    std::sort(rows.begin(), rows.end(), [this](std::uint32_t a, std::uint32_t b) {
      const Placement& x = plan_.placements[a];
      const Placement& y = plan_.placements[b];
      if (x.heap != y.heap) return x.heap < y.heap;
      return x.offset != y.offset ? x.offset < y.offset : x.first < y.first;
    });
    constexpr std::size_t kColumns = 64;
    const std::size_t step = (plan_.passes.size() + kColumns - 1) / kColumns;
    if (rows.empty() || step == 0) return;
    line(padded("memory by offset", kNameWidth) + "  offset      size        positions");
    for (const std::uint32_t r : rows) {
      const Placement& placement = plan_.placements[r];
      std::string text = padded(graph_.resource_name(r), kNameWidth) + "  " +
                         padded(byte_size(placement.offset), 12) +
                         padded(byte_size(placement.size), 12);
      for (std::size_t column = 0; column * step < plan_.passes.size(); ++column) {
        const bool live = placement.first < (column + 1) * step && placement.last >= column * step;
        text += live ? '#' : '.';
      }
      line(text);
    }
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  std::string out_;
};

}  // namespace

std::string print_text(const GraphDescription& graph, const Plan& plan) {
  return TextPrinter(graph, plan).print();
}

}  // namespace alcove::framegraph

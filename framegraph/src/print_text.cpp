// Prints a plan as text: the passes in order with their barriers, the culled passes, and a chart of
// lifetimes and memory offsets.
#include <algorithm>
#include <vector>

#include "alcove/framegraph/print.h"
#include "print_names.h"

namespace alcove::framegraph {
namespace {

constexpr std::size_t kNameWidth = 24;
constexpr std::size_t kLineWidth = 110;

std::string padded(std::string_view text, std::size_t width) {
  std::string out(text.substr(0, width));
  out.append(width - out.size(), ' ');
  return out;
}

// Returns `head` followed by the items, broken into lines.
std::string wrapped(const std::string& head, const std::vector<std::string>& items,
                    const char* separator) {
  std::string out;
  std::string row = head;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string item = items[i] + (i + 1 < items.size() ? separator : "");
    if (row.size() + item.size() > kLineWidth && row.size() > head.size()) {
      out.append(row, 0, row.find_last_not_of(' ') + 1).append("\n");
      row.assign(std::min<std::size_t>(head.size(), 12), ' ');
    }
    row += item;
  }
  return out + row;
}

class TextPrinter {
 public:
  TextPrinter(const GraphDescription& graph, const Plan& plan)
      : graph_(graph), plan_(plan), names_(resource_names(graph)) {}

  std::string print() {
    summary();
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) submission(s);
    culled();
    memory();
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_.append(text).append("\n"); }
  void summary() {
    line(std::to_string(plan_.passes.size()) + " of " + std::to_string(graph_.passes.size()) +
         " passes, " + std::to_string(plan_.batches.size()) + " barrier commands with " +
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
      for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
        const Wait& wait = plan_.waits[submission.first_wait + w];
        text += (w ? ", " : " waits for ") + std::to_string(wait.submission) + " in " +
                stage_names(wait.stages);
      }
      line(text);
    }
    std::uint32_t position = submission.first_pass;
    for (std::uint32_t left = submission.pass_count; left > 0; --left) {
      pass(position);
      position = plan_.passes[position].next;
    }
    batch(submission.end_batch);
    if (index == plan_.final_submission) batch(plan_.final_batch);
    line("");
  }

  void pass(std::uint32_t position) {
    const PlannedPass& planned = plan_.passes[position];
    batch(planned.batch);
    std::string head = padded(std::to_string(position), 4);
    head += padded(graph_.pass_name(planned.pass), kNameWidth) + " ";
    std::vector<std::string> items;
    for (const AccessRecord& used : graph_.pass_accesses(planned.pass))
      items.push_back(access(used));
    items.push_back(
        std::string("(").append(reason(graph_, plan_.cull_reasons[planned.pass])).append(")"));
    line(wrapped(head, items, " "));
  }

  std::string access(const AccessRecord& access) const {
    const ResourceRecord& record = graph_.resources[access.resource];
    const bool writes = (access.flags & kWrite) != 0;
    std::string text = writes ? ">" : "<";
    text.append(names_[access.resource]);
    text.append(".").append(std::to_string(access.version + (writes ? 1 : 0)));
    text.append(range_name(access.range, record.mips, record.layers));
    return text;
  }

  // Prints one line for all transitions of the batch with equal source and destination stages.
  void batch(std::uint32_t index) {
    if (index == kNone) return;
    const Batch& batch = plan_.batches[index];
    std::vector<std::uint8_t> done(batch.count, 0);
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      if (done[i]) continue;
      const Transition& lead = plan_.transitions[batch.first + i];
      std::vector<std::string> items;
      for (std::uint32_t j = i; j < batch.count; ++j) {
        const Transition& t = plan_.transitions[batch.first + j];
        if (t.src_stages != lead.src_stages || t.dst_stages != lead.dst_stages) continue;
        done[j] = 1;
        items.push_back(change(t));
      }
      std::string head = "      | ";
      head.append(stage_names(lead.src_stages)).append(" -> ");
      head.append(stage_names(lead.dst_stages)).append(": ");
      line(wrapped(head, items, ", "));
    }
  }

  std::string change(const Transition& t) const {
    if (t.resource == kNone) return "memory";
    const ResourceRecord& record = graph_.resources[t.resource];
    return std::string(names_[t.resource])
        .append(range_name(t.range, record.mips, record.layers))
        .append(" ")
        .append(layout_name(t.old_layout))
        .append(" -> ")
        .append(layout_name(t.new_layout));
  }

  void culled() {
    bool any = false;
    for (const CullReason cull_reason : {CullReason::unread, CullReason::writes_nothing}) {
      std::vector<std::string> items;
      for (std::uint32_t pass = 0; pass < plan_.cull_reasons.size(); ++pass)
        if (plan_.cull_reasons[pass].cull_reason == cull_reason)
          items.emplace_back(graph_.pass_name(pass));
      if (items.empty()) continue;
      const std::string why = reason(graph_, {cull_reason, kNone, kNone});
      line(wrapped(std::string("culled, ").append(why).append(": "), items, ", "));
      any = true;
    }
    if (any) line("");
  }

  // Prints the chart of memory: one row for each transient in order of offset, and one column for
  // each position. If there are more positions than columns, a column stands for several.
  void memory() {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t r = 0; r < plan_.placements.size(); ++r)
      if (plan_.placements[r].heap != kNone) rows.push_back(r);
    std::sort(rows.begin(), rows.end(), [this](std::uint32_t a, std::uint32_t b) {
      const Placement& x = plan_.placements[a];
      const Placement& y = plan_.placements[b];
      if (x.heap != y.heap) return x.heap < y.heap;
      return x.offset != y.offset ? x.offset < y.offset : x.first < y.first;
    });
    constexpr std::size_t kColumns = 64;
    const std::size_t step = (plan_.passes.size() + kColumns - 1) / kColumns;
    if (rows.empty() || step == 0) return;
    line(padded("memory by offset", kNameWidth) + "  offset      size        " + ruler(step));
    for (const std::uint32_t r : rows) {
      const Placement& placement = plan_.placements[r];
      std::string text = padded(names_[r], kNameWidth) + "  " +
                         padded(byte_size(placement.offset), 12) +
                         padded(byte_size(placement.size), 12);
      for (std::size_t column = 0; column * step < plan_.passes.size(); ++column) {
        const bool live = placement.first < (column + 1) * step && placement.last >= column * step;
        text += live ? '#' : '.';
      }
      line(text);
    }
  }

  // Returns the line with the positions above every tenth column.
  std::string ruler(std::size_t step) const {
    std::string text;
    for (std::size_t column = 0; column * step < plan_.passes.size(); column += 10)
      text += padded(std::to_string(column * step), 10);
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  std::vector<std::string> names_;
  std::string out_;
};

}  // namespace

std::string print_text(const GraphDescription& graph, const Plan& plan) {
  return TextPrinter(graph, plan).print();
}

}  // namespace alcove::framegraph

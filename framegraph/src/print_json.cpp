// Plans as JSON: one object with everything in it.
#include <string_view>

#include "alcove/framegraph/print.h"
#include "print_names.h"

namespace alcove::framegraph {
namespace {

// Writes JSON with its commas right.
class Writer {
 public:
  void begin(char bracket) {
    separate();
    out_ += bracket;
    fresh_ = true;
  }
  void end(char bracket) {
    out_ += bracket;
    fresh_ = false;
  }
  void key(std::string_view name) {
    string(name);
    out_ += ':';
    fresh_ = true;
  }
  void string(std::string_view text) {
    separate();
    out_ += '"';
    for (const char c : text) escape(c);
    out_ += '"';
  }
  void number(std::uint64_t value) {
    separate();
    out_ += std::to_string(value);
  }
  void boolean(bool value) {
    separate();
    out_ += value ? "true" : "false";
  }
  void field(std::string_view name, std::string_view text) {
    key(name);
    string(text);
  }
  void field(std::string_view name, std::uint64_t value) {
    key(name);
    number(value);
  }
  std::string take() { return std::move(out_); }

 private:
  void separate() {
    if (!fresh_) out_ += ',';
    fresh_ = false;
  }
  void escape(char c) {
    constexpr char kDigits[] = "0123456789abcdef";
    if (c == '"' || c == '\\') {
      out_ += '\\';
      out_ += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out_ += "\\u00";
      out_ += kDigits[(c >> 4) & 15];
      out_ += kDigits[c & 15];
    } else {
      out_ += c;
    }
  }

  std::string out_;
  bool fresh_ = true;
};

class JsonPrinter {
 public:
  JsonPrinter(const GraphDescription& graph, const Plan& plan) : graph_(graph), plan_(plan) {}

  std::string print() {
    json_.begin('{');
    json_.key("reordered");
    json_.boolean(plan_.reordered);
    json_.key("submissions");
    json_.begin('[');
    for (const Submission& submission : plan_.submissions) print_submission(submission);
    json_.end(']');
    print_culled();
    print_resources();
    print_heaps();
    json_.end('}');
    return json_.take();
  }

 private:
  void print_submission(const Submission& submission) {
    json_.begin('{');
    json_.field("queue", queue_name(submission.queue));
    json_.key("waits");
    json_.begin('[');
    for (std::uint32_t w = 0; w < submission.wait_count; ++w)
      json_.number(plan_.waits[submission.first_wait + w].submission);
    json_.end(']');
    json_.key("passes");
    json_.begin('[');
    for (std::uint32_t p = 0; p < submission.pass_count; ++p)
      print_pass(plan_.passes[submission.first_pass + p]);
    json_.end(']');
    print_barriers(submission.first_batch, submission.batch_count);
    json_.end('}');
  }

  void print_pass(const PlannedPass& planned) {
    json_.begin('{');
    json_.field("name", graph_.pass_name(planned.pass));
    json_.field("declared", planned.pass);
    json_.field("reason", reason(graph_, plan_.cull_reasons[planned.pass]));
    json_.key("accesses");
    json_.begin('[');
    const std::uint32_t first = graph_.passes[planned.pass].first_access;
    const auto accesses = graph_.pass_accesses(planned.pass);
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      const AccessRecord& access = accesses[i];
      const bool writes = (access.flags & kWrite) != 0;
      json_.begin('{');
      json_.field("resource", graph_.resource_name(access.resource));
      json_.field("index", access.resource);
      json_.field("version", access.version + (writes ? 1u : 0u));
      json_.field("kind", writes ? "write" : "read");
      json_.field("stages", stage_names(access.stages));
      json_.field("accesses", access_names(access.access));
      if (access.kind() == ResourceKind::texture) {
        json_.field("layout", layout_name(access.layout));
        print_range(access.range);
      }
      json_.key("live");
      json_.boolean(plan_.live_accesses[first + i] != 0);
      json_.end('}');
    }
    json_.end(']');
    print_barriers(planned.first_batch, planned.batch_count);
    json_.end('}');
  }

  void print_range(const Range& range) {
    json_.field("base_mip", range.base_mip);
    json_.field("mips", range.mips);
    json_.field("base_layer", range.base_layer);
    json_.field("layers", range.layers);
  }

  void print_barriers(std::uint32_t first, std::uint32_t count) {
    json_.key("barriers");
    json_.begin('[');
    for (std::uint32_t b = first; b < first + count; ++b) {
      const Batch& batch = plan_.batches[b];
      for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
        print_transition(plan_.transitions[t]);
    }
    json_.end(']');
  }

  void print_transition(const Transition& t) {
    json_.begin('{');
    json_.field("src_stages", stage_names(t.src_stages));
    json_.field("src_accesses", access_names(t.src_access));
    json_.field("dst_stages", stage_names(t.dst_stages));
    json_.field("dst_accesses", access_names(t.dst_access));
    if (t.resource != kNone) {
      json_.field("resource", graph_.resource_name(t.resource));
      json_.field("index", t.resource);
      json_.field("old_layout", layout_name(t.old_layout));
      json_.field("new_layout", layout_name(t.new_layout));
      print_range(t.range);
    }
    if (t.src_queue != t.dst_queue) {
      json_.field("src_queue", queue_name(t.src_queue));
      json_.field("dst_queue", queue_name(t.dst_queue));
    }
    json_.end('}');
  }

  void print_culled() {
    json_.key("culled");
    json_.begin('[');
    for (std::uint32_t pass = 0; pass < plan_.cull_reasons.size(); ++pass) {
      const CullReason cull_reason = plan_.cull_reasons[pass].cull_reason;
      if (cull_reason != CullReason::unread && cull_reason != CullReason::writes_nothing) continue;
      json_.begin('{');
      json_.field("name", graph_.pass_name(pass));
      json_.field("reason", reason(graph_, plan_.cull_reasons[pass]));
      json_.end('}');
    }
    json_.end(']');
  }

  void print_resources() {
    json_.key("resources");
    json_.begin('[');
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const ResourceRecord& record = graph_.resources[r];
      const Placement& placement = plan_.placements[r];
      constexpr const char* kOrigins[] = {"transient", "imported", "history"};
      json_.begin('{');
      json_.field("name", graph_.resource_name(r));
      json_.field("kind", record.kind == ResourceKind::texture ? "texture" : "buffer");
      json_.field("origin", kOrigins[static_cast<std::size_t>(record.origin)]);
      if (record.kind == ResourceKind::texture) {
        json_.field("format", static_cast<std::uint64_t>(record.format));
        json_.field("width", record.width);
        json_.field("height", record.height);
        json_.field("depth", record.depth);
        json_.field("mips", record.mips);
        json_.field("layers", record.layers);
      } else {
        json_.field("bytes", record.size);
      }
      if (placement.first != kNone) {
        json_.field("first", placement.first);
        json_.field("last", placement.last);
      }
      if (placement.heap != kNone) {
        json_.field("heap", placement.heap);
        json_.field("offset", placement.offset);
        json_.field("size", placement.size);
      }
      json_.end('}');
    }
    json_.end(']');
  }

  void print_heaps() {
    json_.key("heaps");
    json_.begin('[');
    for (const Heap& heap : plan_.heaps) {
      json_.begin('{');
      json_.field("size", heap.size);
      json_.field("lower_bound", heap.lower_bound);
      json_.field("unaliased", heap.unaliased);
      json_.end('}');
    }
    json_.end(']');
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  Writer json_;
};

}  // namespace

std::string print_json(const GraphDescription& graph, const Plan& plan) {
  return JsonPrinter(graph, plan).print();
}

}  // namespace alcove::framegraph

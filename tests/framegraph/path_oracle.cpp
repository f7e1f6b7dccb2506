#include "path_oracle.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace alcove::framegraph {
namespace {

constexpr VkAccessFlags2 kWriteMask =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 kMeta = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
// All that commands of these tests run in.
constexpr VkPipelineStageFlags2 kCommandStages =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
    VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;

VkPipelineStageFlags2 plain(VkPipelineStageFlags2 stages) {
  if (!(stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)) return stages;
  return (stages & ~VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) | kCommandStages;
}

VkAccessFlags2 plain_access(VkAccessFlags2 access) {
  if (access & VK_ACCESS_2_MEMORY_WRITE_BIT) access |= kWriteMask;
  if (access & VK_ACCESS_2_MEMORY_READ_BIT) access |= ~(kWriteMask | kMeta);
  return access & ~kMeta;
}

// An access of a pass, a layout change, or what came before or comes after the frame.
struct Operation {
  std::uint32_t resource = 0;
  std::uint32_t sub = 0;
  std::size_t queue = 0;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool writes = false;
  bool discards = false;
  bool releases = false;  // to another queue: nothing on this one follows it
  bool departs = false;   // the use after the frame: it comes after reads in other stages too
  std::uint32_t frame = 0;
  std::uint32_t step = 0;  // steps at or above this come after it
  const Transition* change = nullptr;
};

// The barriers recorded by one command, or where a submission or a frame begins or ends; those of
// two frames are numbered through.
struct Step {
  enum class Kind : std::uint8_t { barriers, begins, ends, joins };
  Kind kind = Kind::barriers;
  std::size_t queue = 0;
  std::vector<const Transition*> barriers;
  // What comes before the barriers: operations below the one and steps below the other.
  std::size_t operations_before = 0;
  std::uint32_t steps_before = 0;
  std::vector<Wait> waits;       // of a submission that begins
  std::uint32_t submission = 0;  // that ends
};

// What is known of where an operation's effects have got to.
struct Spread {
  // By queue: stages that come after it, and those after which it is available besides.
  VkPipelineStageFlags2 after[kQueueClasses] = {};
  VkPipelineStageFlags2 available[kQueueClasses] = {};
};

struct Sight {
  std::size_t queue;
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
};

class Oracle {
 public:
  Oracle(const GraphDescription& graph, const Plan& plan) : graph_(graph), plan_(plan) {
    several_ = std::any_of(plan.submissions.begin(), plan.submissions.end(),
                           [](const Submission& s) { return s.queue != QueueClass::graphics; });
  }

  std::string run() {
    for (std::uint32_t frame = 0; frame < 2; ++frame) {
      if (frame == 1 && several_) join();
      unroll(frame);
    }
    for (std::size_t y = 0; y < operations_.size(); ++y) {
      for (std::size_t x = 0; x < y; ++x) {
        if (!conflict(x, y) || ordered(x, y)) continue;
        return describe(operations_[x]).append(" and ").append(describe(operations_[y]));
      }
    }
    return "";
  }

 private:
  // A frame over several queues begins when the one before is done.
  void join() {
    Step step;
    step.kind = Step::Kind::joins;
    steps_.push_back(step);
  }

  void unroll(std::uint32_t frame) {
    set_at_.assign(plan_.sets.size(), {});
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external == kNone) continue;
      const ExternalRecord& record = graph_.externals[external];
      outside(r, record.arrival, frame, static_cast<std::size_t>(record.queue));
    }
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) unroll_submission(s, frame);
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external != kNone && graph_.externals[external].has_departure &&
          plan_.placements[r].first != kNone)
        outside(r, graph_.externals[external].departure, frame, 0, true);
    }
  }

  void unroll_submission(std::uint32_t index, std::uint32_t frame) {
    const Submission& submission = plan_.submissions[index];
    Step step;
    step.queue = static_cast<std::size_t>(submission.queue);
    step.kind = Step::Kind::begins;
    const auto first = frame * static_cast<std::uint32_t>(plan_.submissions.size());
    for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
      step.waits.push_back(plan_.waits[submission.first_wait + w]);
      step.waits.back().submission += first;
    }
    steps_.push_back(step);
    for (std::uint32_t p = 0; p < submission.pass_count; ++p)
      unroll_pass(plan_.passes[submission.first_pass + p], frame);
    batches(submission.first_batch, submission.batch_count, step.queue, frame);
    step.kind = Step::Kind::ends;
    step.submission = first + index;
    steps_.push_back(step);
  }

  void unroll_pass(const PlannedPass& planned, std::uint32_t frame) {
    const auto queue = static_cast<std::size_t>(planned.queue);
    batches(planned.first_batch, planned.batch_count, queue, frame);
    const auto accesses = graph_.pass_accesses(planned.pass);
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      if (plan_.live_accesses[graph_.passes[planned.pass].first_access + i])
        add_access(accesses[i], queue, frame);
    }
    for (std::uint32_t e = planned.first_set; e < planned.first_set + planned.set_count; ++e)
      set_at_[e] = {operations_.size(), static_cast<std::uint32_t>(steps_.size())};
  }

  void outside(std::uint32_t resource, const State& state, std::uint32_t frame, std::size_t queue,
               bool departs = false) {
    const ResourceRecord& r = graph_.resources[resource];
    AccessRecord access;
    access.stages = state.stages;
    access.access = state.access;
    access.flags = plain_access(state.access) & kWriteMask ? kWrite : 0u;
    access.resource = resource;
    access.range = {0, static_cast<std::uint16_t>(r.mips), 0, static_cast<std::uint16_t>(r.layers)};
    if (state.stages == 0) return;
    const std::size_t first = operations_.size();
    add_access(access, queue, frame);
    for (std::size_t i = first; i < operations_.size(); ++i) operations_[i].departs = departs;
  }

  void add_access(const AccessRecord& access, std::size_t queue, std::uint32_t frame) {
    Operation operation;
    operation.queue = queue;
    operation.stages = plain(access.stages);
    operation.access = plain_access(access.access);
    operation.writes = (access.flags & kWrite) != 0;
    operation.discards = (access.flags & kDiscard) != 0;
    add(operation, access.resource, access.range, frame);
  }

  void add(Operation operation, std::uint32_t resource, const Range& range, std::uint32_t frame) {
    const ResourceRecord& r = graph_.resources[resource];
    operation.resource = resource;
    operation.frame = frame;
    operation.step = static_cast<std::uint32_t>(steps_.size());
    if (r.kind == ResourceKind::buffer) {
      operations_.push_back(operation);
      return;
    }
    for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer) {
      for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip) {
        operation.sub = layer * r.mips + mip;
        operations_.push_back(operation);
      }
    }
  }

  void batches(std::uint32_t first, std::uint32_t count, std::size_t queue, std::uint32_t frame) {
    for (std::uint32_t b = first; b < first + count; ++b) {
      const Batch& batch = plan_.batches[b];
      Step step;
      step.queue = queue;
      step.operations_before = operations_.size();
      step.steps_before = static_cast<std::uint32_t>(steps_.size());
      if (batch.event != kNone) {
        step.operations_before = set_at_[batch.event].operations;
        step.steps_before = set_at_[batch.event].steps;
      }
      for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
        step.barriers.push_back(&plan_.transitions[t]);
      steps_.push_back(step);
      for (const Transition* t : step.barriers) {
        if (t->resource != kNone) add_change(*t, queue, frame);
      }
    }
  }

  void add_change(const Transition& t, std::size_t queue, std::uint32_t frame) {
    Operation change;
    change.queue = queue;
    change.writes = change.discards = true;
    change.change = &t;
    change.stages = plain(t.dst_stages);
    change.access = plain_access(t.dst_access);
    change.releases = t.src_queue != t.dst_queue && static_cast<std::size_t>(t.src_queue) == queue;
    add(change, t.resource, t.range, frame);
  }

  bool overlap(std::uint32_t a, std::uint32_t b) const {
    const Placement& x = plan_.placements[a];
    const Placement& y = plan_.placements[b];
    return x.heap != kNone && x.heap == y.heap && x.offset < y.offset + y.size &&
           y.offset < x.offset + x.size;
  }

  bool conflict(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    const bool leaves = y.departs && (x.queue != y.queue || (x.stages & ~y.stages) != 0);
    if (!x.writes && !y.writes && !leaves) return false;
    // One pass's accesses, and one command's changes, are not ordered among themselves.
    if (x.queue == y.queue && x.step == y.step && (x.change != nullptr) == (y.change != nullptr))
      return false;
    const bool external = graph_.resources[x.resource].external != kNone;
    if (external && x.frame != y.frame) return false;
    return (x.resource == y.resource && x.sub == y.sub) ||
           (x.resource != y.resource && overlap(x.resource, y.resource));
  }

  // Whether something between the two does to the same subresource what makes `y` follow it
  // instead of `x`: a write for any, a read for a write.
  bool superseded(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    for (std::size_t i = x_index + 1; i < y_index; ++i) {
      const Operation& z = operations_[i];
      if (z.resource != y.resource || z.sub != y.sub) continue;
      if (z.step == y.step && z.change == nullptr && y.change == nullptr) continue;
      if (z.writes || (y.writes && x.writes)) return true;
    }
    return false;
  }

  bool covers(const Transition& t, const Operation& o) const {
    return t.resource == kNone || t.resource == o.resource || overlap(t.resource, o.resource);
  }

  // Walks what lies between the two, from each stage of x.
  bool ordered(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    const bool same = x.resource == y.resource && x.sub == y.sub;
    // What y must see of x, beyond coming after it.
    VkAccessFlags2 sees = 0;
    if (x.writes && same && y.change == nullptr && !superseded(x_index, y_index)) sees = y.access;
    if (x.change) return Walk(*this, x_index, 0).reaches(y, sees);
    for (VkPipelineStageFlags2 left = x.stages; left != 0; left &= left - 1) {
      if (!Walk(*this, x_index, left & (~left + 1)).reaches(y, sees)) return false;
    }
    return true;
  }

  // From one stage of an operation, or from a layout change, along the steps after it.
  class Walk {
   public:
    Walk(const Oracle& oracle, std::size_t from, VkPipelineStageFlags2 stage)
        : oracle_(oracle), x_(oracle.operations_[from]), from_(from), stage_(stage) {
      if (x_.change) {
        now_.after[x_.queue] = now_.available[x_.queue] = x_.stages;
        sights_.push_back({x_.queue, x_.stages, x_.access});
      } else if (x_.writes) {
        writes_ = x_.access & kWriteMask;
      }
    }

    bool reaches(const Operation& y, VkAccessFlags2 sees) {
      for (std::uint32_t s = x_.step; s < y.step; ++s) {
        before_.push_back(now_);
        const Step& step = oracle_.steps_[s];
        const bool changes = s + 1 == y.step && y.change != nullptr && y.queue == step.queue;
        if (changes && step.kind == Step::Kind::barriers) return reaches_change(step, *y.change);
        if (step.kind == Step::Kind::barriers)
          pass_barriers(step);
        else if (step.kind == Step::Kind::ends)
          pass_end(step);
        else if (step.kind == Step::Kind::joins)
          pass_join();
        else
          pass_begin(step);
      }
      const VkPipelineStageFlags2 there = x_.writes ? now_.available[y.queue] : now_.after[y.queue];
      return (y.stages & ~there) == 0 && is_seen(y, sees);
    }

   private:
    struct Reach {
      bool before = false;
      bool available = false;
    };
    // How x stands to the first scope of a barrier.
    Reach reach(const Step& step, const Transition& t) const {
      const VkPipelineStageFlags2 src = plain(t.src_stages);
      Spread known;
      if (step.steps_before >= x_.step) {
        const std::size_t index = step.steps_before - x_.step;
        known = index < before_.size() ? before_[index] : now_;
      }
      const bool direct = x_.change == nullptr && x_.queue == step.queue &&
                          from_ < step.operations_before && (src & stage_) != 0;
      // Before x itself an event knows nothing of it.
      const bool chained = from_ < step.operations_before && (src & known.after[step.queue]) != 0;
      if (!direct && !chained) return {};
      return {true, (src & known.available[step.queue]) != 0 || writes_ == 0 ||
                        (direct && oracle_.covers(t, x_) &&
                         (writes_ & ~plain_access(t.src_access)) == 0)};
    }

    bool reaches_change(const Step& step, const Transition& change) const {
      const Reach r = reach(step, change);
      return r.before && (!x_.writes || r.available);
    }

    // Barriers of one command do not follow on each other.
    void pass_barriers(const Step& step) {
      Spread next = now_;
      for (const Transition* t : step.barriers) {
        const Reach r = reach(step, *t);
        if (!r.before) continue;
        next.after[step.queue] |= plain(t->dst_stages);
        if (!r.available) continue;
        next.available[step.queue] |= plain(t->dst_stages);
        const bool shows = t->resource == kNone || (t->resource != x_.resource &&
                                                    oracle_.overlap(t->resource, x_.resource));
        if (shows)
          sights_.push_back({step.queue, plain(t->dst_stages), plain_access(t->dst_access)});
      }
      now_ = next;
    }

    // A semaphore's signal follows on all that its queue did before, and shows all of it.
    void pass_end(const Step& step) {
      const bool own = x_.queue == step.queue && (x_.change == nullptr || x_.releases);
      if (own || now_.after[step.queue] != 0) signalled_.push_back(step.submission);
    }

    void pass_begin(const Step& step) {
      for (const Wait& wait : step.waits) {
        if (std::find(signalled_.begin(), signalled_.end(), wait.submission) == signalled_.end())
          continue;
        now_.after[step.queue] |= plain(wait.stages);
        now_.available[step.queue] |= plain(wait.stages);
        sights_.push_back({step.queue, plain(wait.stages), ~VkAccessFlags2{0}});
      }
    }

    void pass_join() {
      for (std::size_t queue = 0; queue < kQueueClasses; ++queue) {
        now_.after[queue] = now_.available[queue] = ~VkPipelineStageFlags2{0};
        sights_.push_back({queue, ~VkPipelineStageFlags2{0}, ~VkAccessFlags2{0}});
      }
    }

    bool is_seen(const Operation& y, VkAccessFlags2 sees) const {
      for (VkPipelineStageFlags2 left = y.stages; left != 0; left &= left - 1) {
        VkAccessFlags2 seen = 0;
        for (const Sight& sight : sights_) {
          if (sight.queue == y.queue && (sight.stages & left & (~left + 1))) seen |= sight.access;
        }
        if (sees & ~seen) return false;
      }
      return true;
    }

    const Oracle& oracle_;
    const Operation& x_;
    std::size_t from_;
    VkPipelineStageFlags2 stage_;
    VkAccessFlags2 writes_ = 0;
    Spread now_;
    std::vector<Spread> before_;  // by step from x's on: what was known before it
    std::vector<Sight> sights_;
    std::vector<std::uint32_t> signalled_;
  };

  std::string describe(const Operation& o) const {
    return std::string(o.change   ? "change of "
                       : o.writes ? "write of "
                                  : "read of ")
        .append(graph_.resource_name(o.resource))
        .append(" after step ")
        .append(std::to_string(o.step))
        .append(" on queue ")
        .append(std::to_string(o.queue));
  }

  struct SetAt {
    std::size_t operations = 0;
    std::uint32_t steps = 0;
  };

  const GraphDescription& graph_;
  const Plan& plan_;
  bool several_ = false;
  std::vector<SetAt> set_at_;  // by event
  std::vector<Step> steps_;
  std::vector<Operation> operations_;
};

}  // namespace

std::string find_unordered_pair(const GraphDescription& graph, const Plan& plan) {
  return Oracle(graph, plan).run();
}

}  // namespace alcove::framegraph

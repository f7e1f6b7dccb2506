#include "alcove/framegraph/compile.h"

#include "workspace.h"

namespace alcove::framegraph {
namespace {

// What the phases append to; the rest they overwrite.
void clear(Plan& plan) {
  plan.batches.clear();
  plan.transitions.clear();
  plan.sets.clear();
  plan.submissions.clear();
  plan.waits.clear();
  plan.heaps.clear();
  plan.finals.clear();
}

}  // namespace

Compiler::Compiler() : workspace_(std::make_unique<Workspace>()) {}
Compiler::~Compiler() = default;

tl::expected<void, Errors> Compiler::compile(const GraphDescription& graph, const Limits& limits,
                                             Plan& plan) {
  Workspace& workspace = *workspace_;
  Errors errors;
  if (!validate(graph, limits, workspace, errors)) {
    plan = {};
    return tl::unexpected(std::move(errors));
  }
  clear(plan);
  cull(graph, workspace, plan);
  order(graph, limits, workspace, plan);
  assign_queues(graph, limits, workspace, plan);
  lifetimes(graph, workspace, plan);
  find_contents(graph, limits, workspace, plan);
  if (!check_images(graph, limits, plan, errors)) {
    plan = {};
    return tl::unexpected(std::move(errors));
  }
  place(graph, limits, workspace, plan);
  synchronise(graph, limits, workspace, plan);
  return {};
}

tl::expected<Plan, Errors> compile(const GraphDescription& graph, const Limits& limits) {
  Compiler compiler;
  Plan plan;
  auto compiled = compiler.compile(graph, limits, plan);
  if (!compiled) return tl::unexpected(std::move(compiled.error()));
  return plan;
}

}  // namespace alcove::framegraph

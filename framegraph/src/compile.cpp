#include "alcove/framegraph/compile.h"

#include "workspace.h"

namespace alcove::framegraph {
namespace {

void clear(Plan& plan) {
  plan.passes.clear();
  plan.batches.clear();
  plan.transitions.clear();
  plan.sets.clear();
  plan.submissions.clear();
  plan.waits.clear();
  plan.placements.clear();
  plan.heaps.clear();
  plan.fates.clear();
  plan.live_accesses.clear();
  plan.finals.clear();
  plan.reordered = false;
}

}  // namespace

Compiler::Compiler() : workspace_(std::make_unique<Workspace>()) {}
Compiler::~Compiler() = default;

tl::expected<void, Errors> Compiler::compile(const GraphDescription& graph, const Limits& limits,
                                             Plan& plan) {
  clear(plan);
  Workspace& workspace = *workspace_;
  Errors errors;
  if (!validate(graph, limits, workspace, errors)) return tl::unexpected(std::move(errors));
  cull(graph, workspace, plan);
  order(graph, limits, workspace, plan);
  assign_queues(graph, limits, workspace, plan);
  lifetimes(graph, limits, workspace, plan);
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

#include "alcove/framegraph/compile.h"

#include "workspace.h"

namespace alcove::framegraph {

Compiler::Compiler() : workspace_(std::make_unique<Workspace>()) {}
Compiler::~Compiler() = default;

tl::expected<void, Errors> Compiler::compile(const GraphDescription& graph, const Limits& limits,
                                             Plan& plan) {
  Workspace& workspace = *workspace_;
  Errors errors;
  plan.submissions.clear();
  plan.waits.clear();
  plan.heaps.clear();
  plan.batches.clear();
  plan.transitions.clear();
  plan.finals.clear();
  if (validate(graph, limits, workspace, plan, errors)) {
    cull(graph, workspace, plan);
    chain(graph, limits, workspace, plan);
    assign_queues(graph, limits, workspace, plan);
    if (check_images(graph, limits, plan, errors) &&
        place(graph, limits, workspace, plan, errors)) {
      synchronise(graph, workspace, plan);
      return {};
    }
  }
  plan = {};
  return tl::unexpected(std::move(errors));
}

tl::expected<Plan, Errors> compile(const GraphDescription& graph, const Limits& limits) {
  Compiler compiler;
  Plan plan;
  auto compiled = compiler.compile(graph, limits, plan);
  if (!compiled) return tl::unexpected(std::move(compiled.error()));
  return plan;
}

tl::expected<Plan, Errors> compile(const Graph& graph, const Limits& limits) {
  auto plan = compile(graph.description(), limits);
  if (!plan) return plan;
  Errors errors;
  for (const PlannedPass& planned : plan->passes)
    if (!graph.has_callback(planned.pass)) errors.push_back(graph.missing_callback(planned.pass));
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return plan;
}

}  // namespace alcove::framegraph

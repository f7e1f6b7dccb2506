#include "alcove/framegraph/compile.h"

#include "workspace.h"

namespace alcove::framegraph {
namespace {

// Assigns queues, computes lifetimes and places memory for the order of execution that the
// workspace holds. Returns the total size of all heaps in bytes. If the device cannot create one of
// the images, adds an error, places nothing and returns 0.
VkDeviceSize schedule(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                      Plan& plan, Errors& errors) {
  plan.submissions.clear();
  plan.waits.clear();
  plan.heaps.clear();
  assign_queues(graph, limits, workspace, plan);
  lifetimes(graph, workspace, plan);
  find_contents(graph, limits, workspace, plan);
  if (!check_images(graph, limits, plan, errors)) return 0;
  place(graph, limits, workspace, plan);
  VkDeviceSize bytes = 0;
  for (const Heap& heap : plan.heaps) bytes += heap.size;
  return bytes;
}

// Schedules the passes in the order of declaration, and in another order if find_lower_order()
// finds one. Keeps the order that needs fewer bytes with the device's memory requirements. Both
// orders use the same queues.
bool schedule_lowest(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                     Plan& plan, Errors& errors) {
  order_as_declared(workspace, plan);
  const VkDeviceSize declared = schedule(graph, limits, workspace, plan, errors);
  plan.reordered = false;
  if (!errors.empty()) return false;
  if (!find_lower_order(graph, limits, workspace, plan)) return true;
  workspace.order = workspace.reorder.order;
  plan.reordered = schedule(graph, limits, workspace, plan, errors) < declared;
  if (plan.reordered) return true;
  workspace.order = workspace.reorder.declared;
  schedule(graph, limits, workspace, plan, errors);
  return true;
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
  plan.batches.clear();
  plan.transitions.clear();
  plan.finals.clear();
  cull(graph, workspace, plan);
  if (!schedule_lowest(graph, limits, workspace, plan, errors)) {
    plan = {};
    return tl::unexpected(std::move(errors));
  }
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

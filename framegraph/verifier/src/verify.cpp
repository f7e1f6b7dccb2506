#include "alcove/framegraph/verify.h"

#include "replay.h"

namespace alcove::framegraph {

tl::expected<void, Errors> verify(const GraphDescription& graph, const Limits& limits,
                                  const Plan& plan) {
  Errors errors;
  if (verifier::check_tables(graph, limits, plan, errors))
    verifier::Replay(graph, limits, plan, errors).run();
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return {};
}

}  // namespace alcove::framegraph

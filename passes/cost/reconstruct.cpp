// Loops of shaders/reconstruct.comp.
#include "pass_work.h"

namespace alcove::passes::cost {

std::optional<double> reconstruct_iterations(const PassWork& /*work*/,
                                             const CompiledLoop& /*loop*/) {
  // The only loops are those of add_ring(), which pixels with a history run only while it is less
  // than two frames old. That is rare, so that the loops are counted as not run.
  return 0.0;
}

}  // namespace alcove::passes::cost

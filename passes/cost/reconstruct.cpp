// Loops of shaders/reconstruct.comp.
#include "pass_work.h"

namespace alcove::passes::cost {

std::optional<double> reconstruct_iterations(const PassWork& work, const CompiledLoop& loop) {
  const bool column = work.settings.tile_size > (work.settings.half_resolution ? 2u : 1u);
  // The outermost loop runs over the blocks of a column. The loops of sum_wide() are counted as not
  // run: pixels with a history run them only while it is less than two frames old, which is rare.
  return column && loop.depth == 1 ? 4.0 : 0.0;
}

}  // namespace alcove::passes::cost

// Passes of which tests make small frames, and their plans.
#pragma once

#include <gtest/gtest.h>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"

namespace alcove::framegraph {

inline const TextureDesc kSmall{VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)};

// Adds a pass that writes all of a texture or buffer, whose earlier contents it does not need.
// Returns what it has written.
inline Texture add_write(Graph& graph, Texture texture, QueueClass queue = QueueClass::graphics,
                         const Access& access = access::storage_write_compute) {
  return graph.add_pass("write", queue).write(texture, access, {}, Contents::discard);
}
inline Texture add_write(Graph& graph, Texture texture, const Access& access) {
  return add_write(graph, texture, QueueClass::graphics, access);
}
// Adds a pass that reads a texture or buffer and is not culled.
inline void add_read(Graph& graph, Texture texture, const Access& access,
                     QueueClass queue = QueueClass::graphics, Range range = {}) {
  PassBuilder pass = graph.add_pass("read", queue);
  pass.read(texture, access, range);
  pass.side_effect();
}

inline void add_read(Graph& graph, Buffer buffer, const Access& access) {
  PassBuilder pass = graph.add_pass("read");
  pass.read(buffer, access);
  pass.side_effect();
}

// Returns the plan of a frame that must be valid, as the plan must be.
inline Plan compile_verified(const Graph& graph, const Limits& limits = {}) {
  auto plan = compile(graph.description(), limits);
  EXPECT_TRUE(plan) << to_string(plan.error());
  const auto verified = verify(graph.description(), limits, plan.value());
  EXPECT_TRUE(verified) << to_string(verified.error());
  return std::move(*plan);
}

}  // namespace alcove::framegraph

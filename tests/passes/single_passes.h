// Adds passes of a view one by one, with textures that a test writes in the place of others.
#pragma once

#include <gtest/gtest.h>

#include "graph/graph_adapter.h"

namespace alcove::passes {

// Adds the passes that `describe(work, view)` describes. `textures` become the written ones.
template <typename Describe>
void add_passes(framegraph::Graph& graph, Pipelines& pipelines, const AlcoveViewInfo& info,
                std::uint32_t index, ViewTextures& textures, const Describe& describe) {
  GraphAdapter work(graph, pipelines, info.id);
  const AlcoveWorkInfo view_work = work_info(graph, info, index, textures);
  const auto view = begin_view(work.list(), view_work);
  ASSERT_TRUE(view) << view.error().message;
  for (std::size_t role = 0; role < textures.size(); ++role)
    if (textures[role]) work.texture(view->images[role]) = textures[role];
  describe(work, *view);
  ASSERT_TRUE(work.list().result());
  ASSERT_TRUE(work.add());
  for (std::size_t role = 0; role < textures.size(); ++role)
    if (textures[role]) textures[role] = work.texture(view->images[role]);
}

}  // namespace alcove::passes

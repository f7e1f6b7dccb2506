// Where passes write what they were asked for, and how.
#pragma once

#include <string_view>

#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// The texture that a caller gave for a result, or else a transient.
[[nodiscard]] inline framegraph::Texture given_or_created(framegraph::Graph& graph,
                                                          framegraph::Texture given,
                                                          std::string_view name,
                                                          const framegraph::TextureDesc& desc) {
  return given ? given : graph.create_texture(name, desc);
}

// Has `pass` write every texel of `texture`, in a shader. What was there may be thrown away, but
// for what an import arrives with: its image may be larger than the part that the graph knows, and
// the rest of it is the caller's.
[[nodiscard]] inline framegraph::Texture write_result(const framegraph::Graph& graph,
                                                      framegraph::PassBuilder& pass,
                                                      framegraph::Texture texture) {
  const framegraph::GraphDescription& declared = graph.description();
  bool keeps = false;
  if (texture.index < declared.resources.size()) {
    const framegraph::ResourceRecord& record = declared.resources[texture.index];
    keeps = record.origin == framegraph::Origin::imported &&
            declared.externals[record.external].has_contents != 0;
  }
  return pass.write(texture, framegraph::access::storage_write_compute, {},
                    keeps ? framegraph::Contents::keep : framegraph::Contents::discard);
}

}  // namespace alcove::passes

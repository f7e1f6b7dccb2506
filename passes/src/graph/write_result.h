// Textures for the results of passes, and their accesses.
#pragma once

#include <string_view>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Returns the texture that the caller gave for a result, or a new transient if it gave none.
[[nodiscard]] inline framegraph::Texture given_or_created(framegraph::Graph& graph,
                                                          framegraph::Texture given,
                                                          std::string_view name,
                                                          const framegraph::TextureDesc& desc) {
  return given ? given : graph.create_texture(name, desc);
}

// Declares that a shader of `pass` writes every texel of `texture`. Earlier contents are discarded,
// unless the texture is an import with contents: its image may be larger than the part that the
// graph uses, and the rest must keep its contents.
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

// Declares that a shader of `pass` writes `channel` of every texel of `texture`. If that is one
// channel, the shader also samples the texture, to write the others back.
[[nodiscard]] inline framegraph::Texture write_channel(const framegraph::Graph& graph,
                                                       framegraph::PassBuilder& pass,
                                                       framegraph::Texture texture,
                                                       VisibilityChannel channel) {
  if (channel == VisibilityChannel::all) {
    return write_result(graph, pass, texture);
  }
  return pass.write(
      texture,
      framegraph::access::sampled_general_compute | framegraph::access::storage_write_compute, {},
      framegraph::Contents::keep);
}

}  // namespace alcove::passes

// The textures of add_reconstruct(): creates them, declares how the pass accesses them, and lists
// them in the order of the shader's bindings.
#pragma once

#include <array>
#include <string_view>

#include "alcove/passes/kernels.h"
#include "alcove/passes/reconstruct.h"
#include "graph/check_reconstruct.h"

namespace alcove::passes {

// A history's texture of the previous frame and that of this frame; null where it is not wanted.
struct HistoryTextures {
  framegraph::Texture previous;
  framegraph::Texture next;
};

// Every texture that the pass accesses; null where it is not wanted.
struct ReconstructTextures {
  ReconstructInputs inputs;
  Occlusion result;               // at half resolution the upsampling pass writes it
  HistoryTextures history;        // at half resolution maths::pack_half_texel()
  HistoryTextures depth_history;  // maths::half_texel_depth(), only at half resolution
  HistoryTextures bent_history;
  HistoryTextures lobe_history;
};

// Pixels per texel of what is reconstructed, in each direction.
[[nodiscard]] inline std::uint32_t texel_size(const OcclusionSettings& settings) {
  return settings.half_resolution ? 2 : 1;
}

// Creates the textures that the pass writes, and declares the histories. Sets `valid` to whether
// the histories of the previous frame can be read.
[[nodiscard]] ReconstructTextures create_reconstruct_textures(
    const Frame& frame, const ReconstructInputs& inputs, const OcclusionSettings& settings,
    const ReconstructSizes& sizes, std::string_view history_name, bool& valid);

// Whether texels of 2x2 pixels are reconstructed, which the upsampling pass reads.
[[nodiscard]] bool is_half(const ReconstructTextures& textures);

// Declares the accesses of the pass, and replaces each written texture by its new version.
void declare_reconstruct_accesses(const framegraph::Graph& graph, framegraph::PassBuilder& pass,
                                  ReconstructTextures& textures);

// A view for each image binding that a variant of the shader can have.
using ReconstructViews = std::array<NamedView, 19>;

// Returns the image views of a dispatch. An image that the shader variant does not use is replaced
// by another image of the same type, because every binding needs a view. The view may be null if
// the variant does not have the binding.
[[nodiscard]] ReconstructViews reconstruct_views(framegraph::RecordContext& context,
                                                 const ReconstructTextures& textures);

}  // namespace alcove::passes

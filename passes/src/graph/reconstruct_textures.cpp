#include "graph/reconstruct_textures.h"

#include <memory_resource>
#include <string>

#include "graph/write_result.h"
#include "work/output_format.h"

namespace alcove::passes {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using framegraph::TextureHistory;

namespace {

// The name of a second history that belongs to `history_name`. The text is stored inside the
// object, so that a frame that repeats an earlier one allocates no memory.
class DerivedHistoryName {
 public:
  DerivedHistoryName(std::string_view history_name, std::string_view suffix) {
    text_.reserve(history_name.size() + suffix.size());
    text_.append(history_name).append(suffix);
  }
  operator std::string_view() const { return text_; }

 private:
  std::array<std::byte, 128> room_;
  std::pmr::monotonic_buffer_resource memory_{room_.data(), room_.size()};
  std::pmr::string text_{&memory_};
};

constexpr std::string_view kDepthSuffix = " depth";
constexpr std::string_view kBentSuffix = " bent normal";
constexpr std::string_view kLobeSuffix = " specular";

// Declares a history. If it is not wanted in this frame, resets it instead, because its contents
// will be out of date when it is wanted again. Sets `valid` to false if the texture of the previous
// frame cannot be read.
HistoryTextures create_history(Graph& graph, bool wanted, std::string_view name, VkFormat format,
                               framegraph::Extent largest, bool& valid) {
  if (!wanted) {
    graph.reset_history(name);
    return {};
  }
  const TextureHistory history = graph.create_texture_history(name, {format, largest});
  valid = valid && history.validity == framegraph::HistoryValidity::valid;
  return {history.previous(), history.current};
}

// Declares the histories; `valid` is whether those of the previous frame can be read.
void create_histories(Graph& graph, const OcclusionSettings& settings,
                      std::string_view history_name, framegraph::Extent largest,
                      ReconstructTextures& textures, bool& valid) {
  const bool wanted = settings.history_frames > 0;
  const RawOcclusionTextures& raw_occlusion = textures.inputs.raw_occlusion;
  valid = wanted;
  const bool half = settings.half_resolution;
  textures.history = create_history(graph, wanted, history_name,
                                    half ? kHalfFormat : kHistoryFormat, largest, valid);
  textures.depth_history =
      create_history(graph, wanted && half, DerivedHistoryName(history_name, kDepthSuffix),
                     kHalfDepthFormat, largest, valid);
  textures.bent_history = create_history(graph, wanted && raw_occlusion.bent,
                                         DerivedHistoryName(history_name, kBentSuffix),
                                         kBentHistoryFormat, largest, valid);
  textures.lobe_history = create_history(graph, wanted && raw_occlusion.lobe,
                                         DerivedHistoryName(history_name, kLobeSuffix),
                                         kLobeHistoryFormat, largest, valid);
}

framegraph::Extent texels(VkExtent2D pixels, const OcclusionSettings& settings) {
  const std::uint32_t size = texel_size(settings);
  return framegraph::Extent::absolute((pixels.width + size - 1) / size,
                                      (pixels.height + size - 1) / size);
}

// Declares what the pass writes for the upsampling pass. Histories are written for it too.
void create_half(Graph& graph, const OcclusionSettings& settings, const ReconstructSizes& sizes,
                 ReconstructTextures& textures) {
  const auto size = texels(sizes.now, settings);
  if (!textures.history.next) {
    textures.history.next = graph.create_texture("half resolution", {kHalfFormat, size});
    textures.depth_history.next =
        graph.create_texture("half-resolution depth", {kHalfDepthFormat, size});
  }
  if (textures.inputs.raw_occlusion.bent && !textures.bent_history.next) {
    textures.bent_history.next =
        graph.create_texture("half-resolution residual", {kBentHistoryFormat, size});
  }
  if (textures.inputs.raw_occlusion.lobe && !textures.lobe_history.next) {
    textures.lobe_history.next =
        graph.create_texture("half-resolution lobe", {kLobeHistoryFormat, size});
  }
}

// Returns the normals, or null if the pass does not read them: at half resolution only the weights
// of GGX lobes need normals.
Texture read_normals(const ReconstructTextures& textures) {
  const bool read = !is_half(textures) || textures.inputs.raw_occlusion.lobe;
  return read ? textures.inputs.normals : Texture{};
}

// One of the results that are wanted.
Texture any_of(const Occlusion& results) {
  if (results.visibility) {
    return results.visibility;
  }
  return results.bent_normal ? results.bent_normal : results.specular;
}

}  // namespace

ReconstructTextures create_reconstruct_textures(const Frame& frame, const ReconstructInputs& inputs,
                                                const OcclusionSettings& settings,
                                                const ReconstructSizes& sizes,
                                                std::string_view history_name, bool& valid) {
  Graph& graph = frame.graph;
  const auto size = inputs.half_size_results
                        ? texels(sizes.now, settings)
                        : framegraph::Extent::absolute(sizes.now.width, sizes.now.height);
  const auto largest = texels(sizes.largest, settings);
  ReconstructTextures textures{.inputs = inputs};
  if (needs_visibility(settings)) {
    textures.result.visibility = given_or_created(graph, inputs.into.visibility, "visibility",
                                                  {scalar_format(settings.precision), size});
  }
  if (inputs.raw_occlusion.bent) {
    textures.result.bent_normal = given_or_created(graph, inputs.into.bent_normal, "bent normal",
                                                   {direction_format(settings.precision), size});
  }
  if (inputs.raw_occlusion.lobe) {
    textures.result.specular = given_or_created(graph, inputs.into.specular, "specular occlusion",
                                                {scalar_format(settings.precision), size});
  }
  create_histories(graph, settings, history_name, largest, textures, valid);
  if (settings.half_resolution) {
    create_half(graph, settings, sizes, textures);
  }
  return textures;
}

bool is_half(const ReconstructTextures& textures) { return bool(textures.depth_history.next); }

void declare_reconstruct_accesses(const Graph& graph, framegraph::PassBuilder& pass,
                                  ReconstructTextures& textures) {
  const auto read = [&](Texture texture, const framegraph::Access& access) {
    if (texture) {
      pass.read(texture, access);
    }
  };
  const auto write = [&](Texture& texture) {
    if (texture) {
      texture = write_result(graph, pass, texture);
    }
  };
  const auto& sampled = framegraph::access::sampled_compute;
  const auto& stored = framegraph::access::storage_read_compute;
  read(textures.inputs.raw_occlusion.raw_occlusion, stored);
  read(textures.inputs.raw_occlusion.bent, stored);
  read(textures.inputs.depth_ndc, sampled);
  read(read_normals(textures), sampled);
  read(textures.inputs.motion, sampled);
  read(textures.inputs.roughness, sampled);
  if (!is_half(textures)) {
    if (Texture& visibility = textures.result.visibility) {
      visibility = write_channel(graph, pass, visibility, textures.inputs.visibility_channel);
    }
    write(textures.result.bent_normal);
    write(textures.result.specular);
  }
  for (HistoryTextures* const history : {&textures.history, &textures.depth_history,
                                         &textures.bent_history, &textures.lobe_history}) {
    read(history->previous, sampled);
    write(history->next);
  }
}

ReconstructViews reconstruct_views(RecordContext& context, const ReconstructTextures& textures) {
  const auto view = [&](Texture texture, Texture instead = {}) -> VkImageView {
    const Texture bound = texture ? texture : instead;
    return bound ? context.view(bound) : VkImageView{VK_NULL_HANDLE};
  };
  const bool half = is_half(textures);
  const ReconstructInputs& in = textures.inputs;
  // At half resolution the upsampling pass writes the results, and this pass writes none.
  const Occlusion out = half ? Occlusion{} : textures.result;
  const Texture written = any_of(out);
  // At half resolution the normals may be null.
  const Texture sampled = half ? in.depth_ndc : in.normals;
  const bool keeps = in.visibility_channel != VisibilityChannel::all;
  const HistoryTextures& history = textures.history;
  return {{{"raw_image", view(in.raw_occlusion.raw_occlusion)},
           {"bent_image", view(in.raw_occlusion.bent, in.raw_occlusion.raw_occlusion)},
           {"depth_image", view(in.depth_ndc)},
           {"normal_image", view(read_normals(textures), sampled)},
           {"half_image", view(half ? history.next : Texture{})},
           {"half_depth_image", view(textures.depth_history.next)},
           {"visibility_image", view(out.visibility, written)},
           {"bent_normal_image", view(out.bent_normal, written)},
           {"kept_image", view(keeps ? out.visibility : sampled)},
           {"history_image", view(history.previous)},
           {"history_depth_image", view(textures.depth_history.previous)},
           {"next_history_image", view(history.next)},
           {"motion_image", view(in.motion, sampled)},
           {"bent_history_image", view(textures.bent_history.previous, history.previous)},
           {"next_bent_history_image", view(textures.bent_history.next, history.next)},
           {"roughness_image", view(in.roughness, sampled)},
           {"specular_image", view(out.specular)},
           {"lobe_history_image", view(textures.lobe_history.previous)},
           {"next_lobe_history_image", view(textures.lobe_history.next)}}};
}

void drop_reconstruct_history(Graph& graph, std::string_view history_name) {
  graph.drop_history(history_name);
  graph.drop_history(DerivedHistoryName(history_name, kDepthSuffix));
  graph.drop_history(DerivedHistoryName(history_name, kBentSuffix));
  graph.drop_history(DerivedHistoryName(history_name, kLobeSuffix));
}

}  // namespace alcove::passes

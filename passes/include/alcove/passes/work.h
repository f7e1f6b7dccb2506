// The work of a frame as data: a list of resources and dispatches that any graph or API can
// execute. The functions that describe a pass are pure, and the functions that add a pass to a
// render graph (add_gtao and so on) add what these describe.
//
// clang-format off
//   AlcoveWork work;
//   WorkList list(work, previous);
//   const Texture depth =
//       list.add(ALCOVE_RESOURCE_KIND_INPUT, "depth", VK_FORMAT_D32_SFLOAT, size);
//   const Texture ao = list.add(ALCOVE_RESOURCE_KIND_OUTPUT, "ao", VK_FORMAT_R8_UNORM, size);
//   describe_occlusion(list, {.view = view}, {.depth_ndc = depth, .into = {.visibility = ao}},
//                      settings);
// clang-format on
//
// The functions take the same structs as those that add passes to a graph. The textures in them are
// here handles of the list: Texture::index is the index of a resource. Results for which the caller
// gives no texture are transients of the list. alcove_work.h documents the list, and declares the
// same for C.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "alcove/alcove_work.h"
#include "alcove/passes/multi_bounce.h"
#include "alcove/passes/occlusion.h"

namespace alcove::passes {

// The histories of a view.
enum class HistoryRole : std::uint8_t { visibility, depth, bent_normal, lobe };

// An image for a binding of a shader, by the variable's name in GLSL, and the mips that are bound.
struct NamedTexture {
  std::string_view name;
  framegraph::Texture texture;
  framegraph::Range range = {};
};

// A request of a pass to run a shader. Constants and images that only other shaders have are
// ignored, so that all variants of a shader can be given the same lists.
struct DispatchInfo {
  const char* label = "";  // static
  Shader shader = Shader::count;
  std::span<const NamedConstant> constants = {};
  std::span<const NamedTexture> images = {};
  std::span<const std::byte> parameters = {};
  VkExtent3D size{};  // invocations
};

// Fills an AlcoveWork. It refers to the list, which must outlive it, and allocates nothing.
class WorkList {
 public:
  // The slots of a history, and whether the contents of `previous` can be read.
  struct History {
    framegraph::Texture previous;
    framegraph::Texture current;
    bool valid = false;
  };
  // Decides about a history instead of `previous`. It is called when the history has been added.
  struct HistorySource {
    bool (*is_valid)(void* user, HistoryRole role, const History& history) = nullptr;
    void* user = nullptr;
  };

  // Begins an empty list. The histories continue those of `previous`, the list of the last executed
  // frame, which may be `work` itself, or null.
  explicit WorkList(AlcoveWork& work, const AlcoveWork* previous = nullptr);

  // Adds an image. Returns a null handle if the list is full.
  framegraph::Texture add(AlcoveResourceKind kind, const char* name, VkFormat format,
                          VkExtent2D size, std::uint32_t mips = 1, std::uint32_t samples = 1);
  // Adds the two slots of a history.
  History add_history(HistoryRole role, VkFormat format, VkExtent2D size);
  void set_history_source(const HistorySource& source) { source_ = source; }

  // Adds a dispatch. The accesses follow from the shader's interface. Errors: a constant or an
  // image of the shader that is missing, or a list that is full.
  [[nodiscard]] tl::expected<void, Error> dispatch(const DispatchInfo& info);

  VkExtent2D size(framegraph::Texture texture) const;
  VkFormat format(framegraph::Texture texture) const;
  std::uint32_t mips(framegraph::Texture texture) const;
  std::uint32_t samples(framegraph::Texture texture) const;  // per pixel
  AlcoveWork& work() const { return work_; }

 private:
  struct KnownHistory {
    const char* name = nullptr;
    std::uint32_t format = 0;
    VkExtent2D size{};
  };
  const AlcoveWorkResource* find(framegraph::Texture texture) const;
  std::uint32_t add_table(const char* name, std::span<const std::uint32_t> words);
  bool bind(AlcoveWorkDispatch& dispatch, const struct ShaderBinding& binding,
            const NamedTexture& given, std::span<const std::uint32_t> table);

  AlcoveWork& work_;
  HistorySource source_;
  KnownHistory previous_[ALCOVE_MAX_WORK_HISTORIES];  // of the last frame
};

// The fields of Frame that the work of a frame depends on.
struct WorkFrame {
  View view;
  std::uint32_t index = 0;
  View previous_view = view;
  std::uint32_t static_frames = 0;
  VkExtent2D largest_size{};
  VkExtent2D previous_size{};
  ImageAreas areas;
};

// Describe what the functions add_linear_depth and so on add, with the same inputs, results and
// errors.
[[nodiscard]] tl::expected<framegraph::Texture, Error> describe_linear_depth(
    WorkList& list, const WorkFrame& frame, framegraph::Texture depth_ndc);
[[nodiscard]] tl::expected<framegraph::Texture, Error> describe_normals(WorkList& list,
                                                                        const WorkFrame& frame,
                                                                        framegraph::Texture depth);
[[nodiscard]] tl::expected<RawOcclusionTextures, Error> describe_gtao(
    WorkList& list, const WorkFrame& frame, const GtaoInputs& inputs,
    const OcclusionSettings& settings);
[[nodiscard]] tl::expected<Occlusion, Error> describe_reconstruct(
    WorkList& list, const WorkFrame& frame, const ReconstructInputs& inputs,
    const OcclusionSettings& settings);
[[nodiscard]] tl::expected<framegraph::Texture, Error> describe_multi_bounce(
    WorkList& list, const WorkFrame& frame, const MultiBounceInputs& inputs,
    Precision precision = Precision::unorm8);
[[nodiscard]] tl::expected<framegraph::Texture, Error> describe_gtso(
    WorkList& list, const WorkFrame& frame, const GtsoInputs& inputs,
    const OcclusionSettings& settings);
[[nodiscard]] tl::expected<OcclusionOutputs, Error> describe_occlusion(
    WorkList& list, const WorkFrame& frame, const OcclusionInputs& inputs,
    const OcclusionSettings& settings);

// Returns the list as text: its resources, and its dispatches with all that they bind.
[[nodiscard]] std::string print_work(const AlcoveWork& work);

}  // namespace alcove::passes

// The work of a view while it is described: what all passes of the view share.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "maths/projection.h"
#include "work/work_builder.h"

namespace alcove::passes {

// The view, its defaults filled in, and its images as handles of the list. The objects that it
// refers to must outlive it.
struct ViewInputs {
  WorkBuilder& list;
  const AlcoveViewInfo& info;
  const AlcoveSettings& settings;
  std::array<ResourceHandle, ALCOVE_IMAGE_COUNT> images{};
  std::uint32_t index = 0;                      // the number that selects the noise
  std::uint32_t static_frames = 0;              // 0 with reset_history
  VkFormat depth_format = VK_FORMAT_UNDEFINED;  // in which depths were first stored
  bool in_part = false;                         // images are read or written in part
  AlcoveArea read{};                            // of the inputs
  AlcoveArea written{};                         // relative to `read`
  VkExtent2D size{};                            // of `read`
  VkExtent2D largest{};                         // of the history
  maths::Projection projection{};

  ResourceHandle image(AlcoveImageRole role) const { return images[role]; }
  // The results that the search and the filter compute.
  bool visibility() const {
    return image(ALCOVE_IMAGE_VISIBILITY) || image(ALCOVE_IMAGE_MULTI_BOUNCE) || by_table();
  }
  bool bent_normal() const { return image(ALCOVE_IMAGE_BENT_NORMAL) || by_table(); }
  bool lobe() const { return specular(ALCOVE_SPECULAR_SLICES); }
  bool by_table() const { return specular(ALCOVE_SPECULAR_TABLE); }
  // Returns the image of roughness if the search and the filter read it.
  ResourceHandle roughness() const {
    return lobe() ? image(ALCOVE_IMAGE_ROUGHNESS) : ResourceHandle{};
  }

 private:
  bool specular(AlcoveSpecular model) const {
    return image(ALCOVE_IMAGE_SPECULAR) && settings.specular == model;
  }
};

// Checks a view, which is done once in a frame, and adds its images to the list.
[[nodiscard]] tl::expected<ViewInputs, Error> begin_view(WorkBuilder& list,
                                                         const AlcoveWorkInfo& info);

// Adds all work of a view to the list. AlcoveWorkInfo::previous is not read.
[[nodiscard]] tl::expected<void, Error> describe_view(WorkBuilder& list,
                                                      const AlcoveWorkInfo& info);

// Returns the pipelines that frames of a view can need: a first frame, frames in motion and static
// ones. `work` is overwritten.
[[nodiscard]] tl::expected<std::vector<AlcoveWorkPipeline>, Error> list_pipelines(
    AlcoveWork& work, const AlcoveWorkInfo& info);

// Returns the area of the inputs that is read; zeros if images are read and written as a whole.
[[nodiscard]] AlcoveArea read_area(const AlcoveViewInfo& info, VkExtent2D depth);
// The text of an area, such as "10x9 pixels at (12, 0)".
[[nodiscard]] std::string area_text(const AlcoveArea& area);

[[nodiscard]] bool same_camera(const AlcoveCamera& a, const AlcoveCamera& b);

// The passes. Each adds its dispatches and returns its results as handles of the list.

// The depth buffers that the passes read. Without several samples and without a mask all three are
// the given depth.
struct Depths {
  ResourceHandle all;        // with one sample per pixel
  ResourceHandle receivers;  // with sky in the place of surfaces that do not receive occlusion
  ResourceHandle occluders;  // with kNoOccluder in the place of surfaces that do not occlude
  ResourceHandle halved{};   // every second pixel of `occluders`, for the search; or null
};
[[nodiscard]] Depths describe_depths(const ViewInputs& view);

// The raw occlusion of a frame, one texel per tile: sums over slices, which reconstruction filters.
struct RawOcclusionImages {
  ResourceHandle sums;  // shaders/maths/raw_occlusion.h draws its layout
  // R32G32_UINT, maths::pack_residual(): sums over the slices, in view space, of the bent-normal
  // residual and of that which is expected without occluders. Null if there are no bent normals.
  ResourceHandle bent;
};
[[nodiscard]] RawOcclusionImages describe_gtao(const ViewInputs& view, const Depths& depths);

// Visibility, bent normals and specular occlusion of every pixel: the images of the view, or
// transients where another pass reads a result that has no image. Null where nothing does.
struct OutputImages {
  ResourceHandle visibility;
  ResourceHandle bent_normal;
  ResourceHandle specular;
};
// Reconstructs every pixel from the traced pixels: spatial filter, upsampling and temporal
// accumulation in one pass (Jimenez et al. 2016, sections 4.4 and 4.5, with other weights). Error:
// a previous camera that cannot be used.
[[nodiscard]] tl::expected<OutputImages, Error> describe_reconstruct(const ViewInputs& view,
                                                                     ResourceHandle depth,
                                                                     const RawOcclusionImages& raw);
// Makes pixels from what is reconstructed at half resolution.
struct HalfTexels {
  ResourceHandle half;       // maths::pack_half_texel()
  ResourceHandle depth;      // maths::half_texel_depth()
  ResourceHandle residuals;  // maths::pack_half_residual(); null where there is no bent normal
  ResourceHandle lobes;      // maths::LobeTexel; null where there is no lobe
};
void describe_upsample(const ViewInputs& view, ResourceHandle depth, const HalfTexels& texels,
                       const OutputImages& results);

// Ground-truth specular occlusion by the table of Jimenez, Wu, Pesce and Jarabo 2016, section 6.
void describe_gtso(const ViewInputs& view, ResourceHandle depth, const OutputImages& results);

// Visibility per colour channel, with the light that occluders reflect ([Jimenez 2016], section 5).
void describe_multi_bounce(const ViewInputs& view, ResourceHandle visibility);

}  // namespace alcove::passes

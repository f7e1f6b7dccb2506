// The inputs of the occlusion passes, and the textures of their results.
#pragma once

#include <array>
#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Converts motion vectors as AlcoveView::motion (alcove.h) says.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{0.0f, 0.0f};
};

struct Occlusion {
  // One channel, [0,1], 1 is open. Null if it was not requested.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of the normals. Null without bent normals.
  framegraph::Texture bent_normal;
  // One channel, the visible fraction of the GGX lobe, [0,1], 1 is open. Null without a lobe.
  framegraph::Texture specular;
};

struct OcclusionInputs {
  // The depth buffer that the view's projection wrote, in any depth format or R32_SFLOAT. If it has
  // several samples per pixel, add_occlusion() first copies sample 0. AlcoveView::depth (alcove.h)
  // says which details its steps can hold.
  framegraph::Texture depth_ndc;
  // The format in which the depths were first stored, if `depth_ndc` is a copy in another format.
  // By default it is the format of `depth_ndc`.
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  // Unit vectors, as `normal_convention` says. AlcoveView::normals documents what happens to
  // normals that face away from the eye, are zero or are not numbers. If null, the passes compute
  // normals from depth.
  framegraph::Texture normals;
  NormalConvention normal_convention;
  // Motion vectors in xy, in the units of `motion_convention`. If null, only the camera is assumed
  // to move. With motion vectors, occluders may move too, which changes the visibility of surfaces
  // that do not move. The history is then replaced where it differs from the mean of about the last
  // four frames by more than noise.
  framegraph::Texture motion;
  framegraph::Texture roughness;  // perceptual, [0,1]; null: OcclusionSettings::roughness
  // The depth of back faces, for ThicknessUnit::back_faces. It is ignored unless
  // needs_back_depth(). Draw the scene a second time with front faces culled, with the same
  // projection, size, clear value and depth test, so that the nearest back face is kept: there the
  // view ray leaves the first solid that it enters. A pixel's occluder has the thickness of the
  // settings instead if this depth is the sky or NaN, or is behind `depth_ndc` by less than a
  // ten-thousandth of the distance.
  framegraph::Texture back_depth_ndc;
  // The second depth layer, for OcclusionSettings::depth_layers = 2. It is ignored unless
  // needs_second_depth(). It holds the nearest front face that the first layer hides. Draw the
  // scene a second time with back faces culled, and discard fragments that are not behind
  // `depth_ndc` (for example by at least a thousandth of the distance). If this depth is the sky or
  // NaN at a pixel, the second layer has no occluder there.
  framegraph::Texture second_depth_ndc;
  // A mask of surfaces, R8_UNORM or R8_UINT, as AlcoveView::mask (alcove.h); null: there is none.
  framegraph::Texture mask;
  std::uint32_t not_receiving = 0;
  std::uint32_t not_occluding = 0;
  // Textures of the caller, of the results' size, to which the results are written completely. If a
  // texture is null, its result is a transient with OcclusionSettings::precision. A texture whose
  // result was not requested is ignored.
  Occlusion into;
  MotionConvention motion_convention;
};

}  // namespace alcove::passes

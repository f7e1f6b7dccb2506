// The constants, parameters and images of reconstruct.comp and, with HALF, reconstruct_half.comp.
// Their variants are compiled with these macros:
//   BENT      there are bent normals
//   SPECULAR  there is a GGX lobe for specular occlusion
// The passes find bindings by name, so that binding numbers have no meaning outside this file.
#ifndef ALCOVE_RECONSTRUCT_BINDINGS_H
#define ALCOVE_RECONSTRUCT_BINDINGS_H

#include "reconstruct_parameters.h"

layout(constant_id = 0) const int kTileSize = 1;
layout(constant_id = 1) const int kFilterRadius = 2;
layout(constant_id = 2) const bool kHistory = false;  // frames are accumulated
layout(constant_id = 3) const bool kMotion = false;
layout(constant_id = 4) const bool kPerspective = true;
layout(constant_id = 5) const bool kStatic = false;  // the previous frame shows the same
layout(constant_id = 6) const bool kRoughnessTexture = false;
layout(constant_id = 7) const int kRoughnessChannel = 0;
layout(constant_id = 8) const bool kFresh = true;         // there is no history to read yet
layout(constant_id = 9) const bool kVisibility = true;    // whether visibility_image is written
layout(constant_id = 10) const uint kNormalEncoding = 0;  // an AlcoveNormalEncoding
layout(constant_id = 11) const bool kShaped = false;      // power or intensity is not 1
layout(constant_id = 12) const bool kReversed = false;    // raw depth is 1 at the near plane
layout(constant_id = 13) const bool kAreas = false;  // images are read or written in part (areas.h)

#ifdef BENT
const bool kBentNormal = true;
#else
const bool kBentNormal = false;
#endif
#ifdef SPECULAR
const bool kLobe = true;
#else
const bool kLobe = false;
#endif

layout(set = 0, binding = 0) uniform Parameters { ReconstructParameters parameters; };
layout(set = 0, binding = 1) uniform sampler nearest_sampler;  // it clamps to the edge
layout(set = 0, binding = 16) uniform utexture2D raw_image;    // one texel a tile
layout(set = 0, binding = 3) uniform texture2D depth_image;    // as the projection wrote it
layout(set = 0, binding = 4) uniform texture2D normal_image;   // xyz

#ifdef HALF
layout(set = 0, binding = 5) uniform writeonly image2D half_image;        // pack_half_texel()
layout(set = 0, binding = 6) uniform writeonly image2D half_depth_image;  // half_texel_depth()
#else
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
#endif

// Bindings that only a history needs are not used without kHistory.
#ifdef HALF
// half_image and half_depth_image of the previous frame.
layout(set = 0, binding = 7) uniform texture2D history_image;
layout(set = 0, binding = 8) uniform texture2D history_depth_image;
#else
layout(set = 0, binding = 7) uniform texture2D history_image;  // pack_history_texel()
layout(set = 0, binding = 8) uniform writeonly image2D next_history_image;
#endif
layout(set = 0, binding = 9) uniform texture2D motion_image;  // read with kMotion

#ifdef BENT
layout(set = 0, binding = 2) uniform utexture2D bent_image;
#ifndef HALF
// In the space of the normals.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
#endif
layout(set = 0, binding = 10) uniform texture2D bent_history_image;  // pack_half_residual()
layout(set = 0, binding = 11) uniform writeonly image2D next_bent_history_image;
#endif

#ifdef SPECULAR
layout(set = 0, binding = 12) uniform texture2D roughness_image;  // perceptual
#ifndef HALF
layout(set = 0, binding = 13) uniform writeonly image2D specular_image;
#endif
layout(set = 0, binding = 14) uniform utexture2D lobe_history_image;  // LobeTexel
layout(set = 0, binding = 15) uniform writeonly uimage2D next_lobe_history_image;
#endif

// Width in pixels of the texels that are reconstructed.
#ifdef HALF
const int kTexelSize = 2;
#else
const int kTexelSize = 1;
#endif

#define GATHERS_DEPTH
#define WRITES_OUTPUTS
#include "areas.h"

#endif

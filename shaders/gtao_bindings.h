// Part of gtao.comp: its constants, inputs and outputs.
#ifndef ALCOVE_GTAO_BINDINGS_H
#define ALCOVE_GTAO_BINDINGS_H

#include "gtao_parameters.h"

layout(constant_id = 0) const uint kSliceCount = 1;
layout(constant_id = 1) const uint kStepCount = 12;    // depth samples of a half-slice
layout(constant_id = 2) const bool kHorizons = false;  // else samples are connected
layout(constant_id = 3) const int kTileSize = 1;  // one pixel is traced in a tile of this width
layout(constant_id = 4) const bool kPerspective = true;
layout(constant_id = 5) const bool kRoughnessTexture = false;
layout(constant_id = 6) const int kRoughnessChannel = 0;
layout(constant_id = 7) const bool kBackFaces = false;     // back_image tells the thickness
layout(constant_id = 8) const uint kSecondStepCount = 0;   // those in second_image; 0: without it
layout(constant_id = 9) const uint kNormalEncoding = 0;    // an AlcoveNormalEncoding
layout(constant_id = 10) const bool kReversed = false;     // raw depth is 1 at the near plane
layout(constant_id = 11) const bool kInfiniteFar = false;  // the far plane is infinitely far away
layout(constant_id = 12) const bool kAreas = false;        // images are read in part (areas.h)
layout(constant_id = 13) const bool kMask = false;         // depth_image has kNoOccluder
layout(constant_id = 14) const bool kUniform = false;      // directions have no cosine weight
layout(constant_id = 15) const bool kHalfSearch = false;   // depth samples are of search_image

const bool kSecondLayer = kSecondStepCount > 0u;

layout(set = 0, binding = 0) uniform Parameters { GtaoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;   // as the projection wrote it
layout(set = 0, binding = 2) uniform texture2D normal_image;  // view_from_normal rotates it
// Packed RawOcclusion and inverse depth; with SPECULAR also those of the GGX lobe and its surface.
layout(set = 0, binding = 3) uniform writeonly uimage2D raw_image;
#ifdef BENT
layout(set = 0, binding = 4) uniform writeonly uimage2D bent_image;
const bool kBentNormal = true;
#else
const bool kBentNormal = false;
#endif
// Depth of the back faces. Without kBackFaces it is never read, and another image is bound in its
// place.
layout(set = 0, binding = 5) uniform texture2D back_image;
// The second depth layer. Without kSecondLayer it is never read, and another image is bound in its
// place.
layout(set = 0, binding = 6) uniform texture2D second_image;
// Depth with sky in the place of surfaces that do not receive occlusion. Without kMask it is never
// read, and another image is bound in its place.
layout(set = 0, binding = 8) uniform texture2D receiver_image;
// Every second pixel of the area of depth_image that is read, along x and y: those with the traced
// pixels among them. Without kHalfSearch it is never read, and another image is bound in its place.
layout(set = 0, binding = 9) uniform texture2D search_image;
#ifdef SPECULAR
layout(set = 0, binding = 7) uniform texture2D roughness_image;  // perceptual
const bool kLobe = true;
#else
const bool kLobe = false;
#endif

#include "areas.h"

#endif

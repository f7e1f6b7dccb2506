// Unpacks the traced pixels around a group of invocations into shared memory, and finds those
// around a pixel there. It is a part of reconstruct.comp.
#ifndef ALCOVE_RECONSTRUCT_TILES_H
#define ALCOVE_RECONSTRUCT_TILES_H

// Whether a pixel averages the traced pixels around it. If not, either every pixel was traced
// itself (kTileSize is 1), or a pixel takes the value of its tile (kFilterRadius is 0).
const bool kBetween = kTileSize > 1 && kFilterRadius > 0;
// Base-2 logarithm of kTileSize.
const int kShift = kTileSize == 8 ? 3 : kTileSize == 4 ? 2 : kTileSize == 2 ? 1 : 0;
// Width in pixels of the square that a group reconstructs.
const int kGroupPixels = 8 * kTexelSize;
// Number of tiles along x and along y whose traced pixels the pixels of a group average.
const int kSpan = kGroupPixels / kTileSize + 2 * kFilterRadius;

// The unpacked raw occlusion of the tiles around the group. x: inverse depth. y: the occluded part
// and z: RawOcclusion::open, neither of them normalised. w: x of the normal's stereographic
// coordinates.
shared vec4 traced[kSpan * kSpan];
shared float traced_stereographic_y[kByNormal ? kSpan * kSpan : 1];
// The arrays of results that are not computed have one element, which nothing reads.
const int kBentSpan = kBentNormal ? kSpan * kSpan : 1;
shared vec4 traced_residual[kBentSpan];           // residual, expected residual x
shared vec2 traced_expected_residual[kBentSpan];  // yz
const int kLobeSpan = kLobe ? kSpan * kSpan : 1;
shared vec2 traced_lobe[kLobeSpan];  // occluded, open
shared uint traced_lobe_surface[kLobeSpan];

// Returns the upper left one of the 2x2 tiles whose traced pixels surround a pixel. If pixels take
// the value of their tile, returns the pixel's own tile.
ivec2 cell_of(ivec2 pixel) {
  return kBetween ? (pixel - parameters.interleave_pixel) >> kShift : pixel >> kShift;
}

// Returns the tile to the upper left of all tiles that the group averages.
ivec2 first_tile_of_group() {
  return cell_of(ivec2(gl_WorkGroupID.xy) * kGroupPixels) -
         (kBetween ? kFilterRadius - 1 : kFilterRadius);
}

void load_tile(ivec2 tile, int i) {
  uvec4 stored = imageLoad(raw_image, tile);
  RawOcclusion raw = unpack_raw_occlusion(stored.x);
  vec2 stereographic = stereographic_of_bits(raw_occlusion_normal(stored.x));
  traced[i] = vec4(uintBitsToFloat(stored.y), raw.open - raw.visible, raw.open, stereographic.x);
  if (kByNormal) {
    traced_stereographic_y[i] = stereographic.y;
  }
  if (kBentNormal) {
    uvec2 bent = imageLoad(bent_image, tile).xy;
    vec3 expected = unpack_residual(bent.y);
    traced_residual[i] = vec4(unpack_residual(bent.x), expected.x);
    traced_expected_residual[i] = expected.yz;
  }
  if (kLobe) {
    RawOcclusion lobe = unpack_lobe(stored.z);
    traced_lobe[i] = vec2(lobe.open - lobe.visible, lobe.open);
    traced_lobe_surface[i] = stored.w;
  }
}

// Unpacks the tiles around the group, each invocation every 64th.
void load_tiles() {
  // i / kSpan is (i * kReciprocal) >> 16 for every index.
  const uint kReciprocal = (65536u + uint(kSpan) - 1u) / uint(kSpan);
  ivec2 first = first_tile_of_group();
  ivec2 last = (size_px() + (kTileSize - 1)) / kTileSize - 1;
  [[unroll]] for (int begin = 0; begin < kSpan * kSpan; begin += 64) {
    int i = begin + int(gl_LocalInvocationIndex);
    int row = int((uint(i) * kReciprocal) >> 16u);
    if (i < kSpan * kSpan) {
      load_tile(clamp(first + ivec2(i - row * kSpan, row), ivec2(0), last), i);
    }
  }
  barrier();
}

// The traced pixels around a pixel.
struct TracedPixels {
  int first_tile;  // index in `traced` of the tile to the upper left
  vec2 offset;     // to the pixel that was traced there, pixels, before clamping to the image
  vec4 range;      // smallest and largest offset of a traced pixel in the image
};

// Returns the traced pixels around `pixel`. Offsets to them are measured from the point that lies
// `centre` pixels right of and below the pixel's centre, which is 0, or 0.5 for a texel of 2x2
// pixels whose first pixel this is.
TracedPixels find_traced(ivec2 pixel, float centre) {
  ivec2 place = cell_of(pixel) - first_tile_of_group();
  TracedPixels found;
  found.first_tile = place.y * kSpan + place.x;
  vec2 to_traced = kBetween ? -vec2((pixel - parameters.interleave_pixel) & (kTileSize - 1))
                            : parameters.interleave_offset - vec2(pixel & (kTileSize - 1));
  found.offset = to_traced - centre;
  found.range = parameters.traced_range - (vec2(pixel) + centre).xyxy;
  return found;
}

// Returns the offset, in pixels, to the traced pixel that lies `i` tiles to the right of the first
// one (axis 0) or below it (axis 1).
float traced_offset(TracedPixels around, int axis, int i) {
  return clamp(around.offset[axis] + float(i * kTileSize), around.range[axis],
               around.range[axis + 2]);
}

#endif

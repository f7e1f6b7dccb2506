// The traced pixels around a texel. A group of invocations unpacks those around its texels into
// shared memory.
#ifndef ALCOVE_RECONSTRUCT_TILES_H
#define ALCOVE_RECONSTRUCT_TILES_H

#include "maths/bent_normal.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "reconstruct_bindings.h"

// Whether the weight of a traced pixel falls with the angle between its normal and the pixel's. At
// half resolution such a weight raises the error by 1 %.
#ifdef HALF
const bool kByNormal = false;
#else
const bool kByNormal = (kFresh || kStatic) && kFilterRadius > 0;
#endif

// Whether a pixel averages the traced pixels around it. If not, either every pixel was traced
// itself (kTileSize is 1), or a pixel takes the value of its tile (kFilterRadius is 0).
const bool kBetween = kTileSize > 1;
// Base-2 logarithm of kTileSize.
const int kShift = kTileSize == 8 ? 3 : kTileSize == 4 ? 2 : kTileSize == 2 ? 1 : 0;
// Width of a block of 8x8 texels in pixels. It is a whole number of tiles.
const int kGroupPixels = 8 * kTexelSize;
// Number of blocks, one below the other, that a group reconstructs. If every texel is traced, the
// tiles of more than one block could exceed the shared memory of a GPU.
const int kBlocks = kTileSize > kTexelSize ? 4 : 1;
// Number of traced pixels on each side that are averaged for a texel with a history.
const int kNearRadius = kFilterRadius == 0 ? 0 : 1;
// Number of traced pixels on each side that are in shared memory.
const int kSharedRadius = kFresh ? kFilterRadius : kNearRadius;
// Number of tiles along x and along y whose traced pixels are in shared memory.
const int kSpan = kGroupPixels / kTileSize + 2 * kSharedRadius;
const int kTiles = kSpan * (kBlocks * kGroupPixels / kTileSize + 2 * kSharedRadius);

// The unpacked raw occlusion of a traced pixel.
struct TileSample {
  float inverse_depth;
  float occluded;      // not normalised
  float open;          // RawOcclusion::open
  vec2 stereographic;  // coordinates of the normal; only with kByNormal
  vec3 residual;       // this and the next only with kBentNormal
  vec3 expected_residual;
  vec2 lobe;  // occluded, open; this and the next only with kLobe
  uint lobe_surface;
};

// The traced pixels around the group. x: inverse depth. y: occluded. z: open. w: x of the normal's
// stereographic coordinates.
shared vec4 shared_traced[kTiles];
// The arrays of results that are not computed have one element, which nothing reads.
shared float shared_stereographic_y[kByNormal ? kTiles : 1];
const int kBentTiles = kBentNormal ? kTiles : 1;
shared vec4 shared_residual[kBentTiles];           // residual, expected residual x
shared vec2 shared_expected_residual[kBentTiles];  // yz
const int kLobeTiles = kLobe ? kTiles : 1;
shared vec2 shared_lobe[kLobeTiles];
shared uint shared_lobe_surface[kLobeTiles];

ivec2 last_tile() { return (size_px() + (kTileSize - 1)) / kTileSize - 1; }

// Returns the upper left one of the 2x2 tiles whose traced pixels surround a pixel. If pixels take
// the value of their tile, returns the pixel's own tile.
ivec2 cell_of(ivec2 pixel) {
  return kBetween ? (pixel - parameters.interleave_pixel) >> kShift : pixel >> kShift;
}

// Returns the first texel of the group. The first group begins at a multiple of 8 texels; at half
// resolution it contains one texel before the first that is written, which upsampling reads.
ivec2 first_texel() {
  ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(8, 8 * kBlocks);
  return kAreas ? first + (max(first_written() / kTexelSize - (kTexelSize - 1), 0) & ~7) : first;
}

// Returns the tile to the upper left of all tiles in shared memory.
ivec2 first_shared_tile() {
  return cell_of(first_texel() * kTexelSize) - (kBetween ? kSharedRadius - 1 : kSharedRadius);
}

// Reads the traced pixel of a tile from the image.
TileSample fetch_tile_sample(ivec2 tile) {
  uvec4 stored = texelFetch(raw_image, tile, 0);
  RawOcclusion raw = unpack_raw_occlusion(stored.x);
  TileSample found;
  found.inverse_depth = uintBitsToFloat(stored.y);
  found.occluded = raw.open - raw.visible;
  found.open = raw.open;
  if (kByNormal) found.stereographic = stereographic_of_bits(raw_occlusion_normal(stored.x));
#ifdef BENT
  uvec2 bent = texelFetch(bent_image, tile, 0).xy;
  found.residual = unpack_residual(bent.x);
  found.expected_residual = unpack_residual(bent.y);
#endif
  if (kLobe) {
    RawOcclusion lobe = unpack_lobe(stored.z);
    found.lobe = vec2(lobe.open - lobe.visible, lobe.open);
    found.lobe_surface = stored.w;
  }
  return found;
}

void store_shared(TileSample found, int i) {
  shared_traced[i] = vec4(found.inverse_depth, found.occluded, found.open, found.stereographic.x);
  if (kByNormal) shared_stereographic_y[i] = found.stereographic.y;
  if (kBentNormal) {
    shared_residual[i] = vec4(found.residual, found.expected_residual.x);
    shared_expected_residual[i] = found.expected_residual.yz;
  }
  if (kLobe) {
    shared_lobe[i] = found.lobe;
    shared_lobe_surface[i] = found.lobe_surface;
  }
}

TileSample load_shared(int i) {
  vec4 stored = shared_traced[i];
  TileSample found;
  found.inverse_depth = stored.x;
  found.occluded = stored.y;
  found.open = stored.z;
  if (kByNormal) found.stereographic = vec2(stored.w, shared_stereographic_y[i]);
  if (kBentNormal) {
    vec4 residual = shared_residual[i];
    found.residual = residual.xyz;
    found.expected_residual = vec3(residual.w, shared_expected_residual[i]);
  }
  if (kLobe) {
    found.lobe = shared_lobe[i];
    found.lobe_surface = shared_lobe_surface[i];
  }
  return found;
}

// Unpacks the tiles around the group, each invocation every 64th.
void load_tiles() {
  // i / kSpan is (i * kReciprocal) >> 16 for every index.
  const uint kReciprocal = (65536u + uint(kSpan) - 1u) / uint(kSpan);
  ivec2 first = first_shared_tile();
  [[unroll]] for (int begin = 0; begin < kTiles; begin += 64) {
    int i = begin + int(gl_LocalInvocationIndex);
    int row = int((uint(i) * kReciprocal) >> 16u);
    if (i < kTiles) {
      ivec2 tile = first + ivec2(i - row * kSpan, row);
      TileSample found = fetch_tile_sample(clamp(tile, ivec2(0), last_tile()));
      if (kBetween && !kFresh) {
        // sum_near() assumes that the pixels are traced at regular distances. A pixel that would
        // lie outside of the image gets a depth that lies on no plane.
        ivec2 pixel = tile * kTileSize + parameters.interleave_pixel;
        bool outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size_px()));
        found.inverse_depth = outside ? 1e30 : found.inverse_depth;
      }
      store_shared(found, i);
    }
  }
  barrier();
}

// The traced pixels around a texel.
struct TracedPixels {
  int first_tile;  // index in shared memory of the upper left one of cell_of()
  vec2 offset;     // from the texel's centre to the pixel that was traced there, pixels, if the
                   // image went on beyond its border
};

// Returns the traced pixels around the texel whose first pixel this is.
TracedPixels find_traced(ivec2 pixel) {
  ivec2 place = cell_of(pixel) - first_shared_tile();
  TracedPixels found;
  found.first_tile = place.y * kSpan + place.x;
  ivec2 to_traced = kBetween ? -((pixel - parameters.interleave_pixel) & (kTileSize - 1))
                             : parameters.interleave_pixel - (pixel & (kTileSize - 1));
  found.offset = vec2(to_traced) - 0.5 * float(kTexelSize - 1);
  return found;
}

#endif

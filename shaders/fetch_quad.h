#ifndef ALCOVE_FETCH_QUAD_H
#define ALCOVE_FETCH_QUAD_H

// Returns the four texels around the corner between `corner - 1` and `corner`, clamped to the
// image, in the order of textureGather. Textures of integers are fetched, because HLSL has no
// gather with a sampler for them.
uvec4 fetch_quad(utexture2D image, ivec2 corner) {
  ivec2 last = textureSize(image, 0) - 1;
  ivec2 low = clamp(corner - 1, ivec2(0), last);
  ivec2 high = clamp(corner, ivec2(0), last);
  return uvec4(texelFetch(image, ivec2(low.x, high.y), 0).r, texelFetch(image, high, 0).r,
               texelFetch(image, ivec2(high.x, low.y), 0).r, texelFetch(image, low, 0).r);
}

#endif

// The surface of a texel of 2x2 pixels, the part of reconstruct.comp with HALF: which of its pixels
// stands for it, and the tangent plane there, both from depth alone.
#ifndef ALCOVE_RECONSTRUCT_HALF_SURFACE_H
#define ALCOVE_RECONSTRUCT_HALF_SURFACE_H

// Tilt up to which a change of depth between neighbouring pixels is taken for a surface although
// the change on the other side has the other sign: about 70 degrees.
const float kPlausibleTilt = 3.0;

// A pixel of the texel and its four neighbours. The inner ones are pixels of the texel too.
struct TexelPixel {
  float inverse_depth;
  vec2 inner;  // inverse depths, the neighbour along x and along y
  vec2 outer;
  ivec2 place;  // 0 or 1
};

// The change of inverse depth along an axis: the smaller of the changes on both sides of a pixel,
// since the larger may lead to another surface. Where they differ in sign both may, as on a thin
// object, so a steep one is then not believed. A change of 0 may be the border of the image.
float gradient_of(float inner_change, float outer_change, float plausible) {
  bool inner =
      outer_change == 0.0 || (inner_change != 0.0 && abs(inner_change) < abs(outer_change));
  float smaller = inner ? inner_change : outer_change;
  bool agree = inner_change * outer_change > 0.0;
  return agree || abs(smaller) < plausible ? smaller : 0.0;
}

// The pixel that stands for the texel: the nearest in one half of the texels and the farthest in
// the other, as on a chessboard. Where two surfaces meet, both are then found among any 2x2 texels.
// The sky stands for a texel only where there is nothing else.
TexelPixel representative(ivec2 texel) {
  vec2 uv = vec2(texel * 2) * parameters.pixel_uv;
  vec2 step = 2.0 * parameters.pixel_uv;
  // Blocks of 2x2 pixels around the corners of the texel: each has one of its pixels.
  vec4 upper_left = textureGather(inverse_depth_image, uv);
  vec4 upper_right = textureGather(inverse_depth_image, uv + vec2(step.x, 0.0));
  vec4 lower_left = textureGather(inverse_depth_image, uv + vec2(0.0, step.y));
  vec4 lower_right = textureGather(inverse_depth_image, uv + step);
  // In the order of textureGather: lower left, lower right, upper right, upper left.
  vec4 inside = vec4(lower_left.z, lower_right.w, upper_right.x, upper_left.y);
  vec4 outer_x = vec4(lower_left.w, lower_right.z, upper_right.y, upper_left.x);
  vec4 outer_y = vec4(lower_left.y, lower_right.x, upper_right.w, upper_left.z);
  float sky = sky_inverse_depth(kPerspective);
  float smallest = min(min(inside.x, inside.y), min(inside.z, inside.w));
  float largest = max(max(inside.x, inside.y), max(inside.z, inside.w));
  bool nearest = ((texel.x ^ texel.y) & 1) == 0;
  float wanted = nearest == kPerspective ? largest : smallest;
  if (wanted == sky) {
    wanted = kPerspective ? largest : smallest;
  }
  // At the border of the image a gather repeats the last pixels, which come first here.
  TexelPixel found;
  found.inverse_depth = wanted;
  if (wanted == inside.w) {
    found.place = ivec2(0, 0);
    found.inner = inside.zx;
    found.outer = vec2(outer_x.w, outer_y.w);
  } else if (wanted == inside.x) {
    found.place = ivec2(0, 1);
    found.inner = inside.yw;
    found.outer = vec2(outer_x.x, outer_y.x);
  } else if (wanted == inside.z) {
    found.place = ivec2(1, 0);
    found.inner = inside.wy;
    found.outer = vec2(outer_x.z, outer_y.z);
  } else {
    found.place = ivec2(1, 1);
    found.inner = inside.xz;
    found.outer = vec2(outer_x.y, outer_y.y);
  }
  return found;
}

Surface fetch_surface(ivec2 texel) {
  TexelPixel found = representative(texel);
  Surface surface;
  surface.texel = texel;
  surface.pixel = texel * 2 + found.place;
  surface.centre = vec2(texel * 2) + 1.0;
  surface.sky = found.inverse_depth == sky_inverse_depth(kPerspective);
  float scale = kPerspective ? found.inverse_depth : 1.0;
  vec2 plausible = kPlausibleTilt * scale * abs(parameters.slope.xy);
  vec2 way = 1.0 - 2.0 * vec2(found.place);  // from the pixel to its inner neighbours
  vec2 inner = (found.inner - found.inverse_depth) * way;
  vec2 outer = (found.inverse_depth - found.outer) * way;
  surface.gradient =
      vec2(gradient_of(inner.x, outer.x, plausible.x), gradient_of(inner.y, outer.y, plausible.y));
  float inverse_scale = 1.0 / scale;
  surface.tilt = surface.gradient * parameters.pixels_per_slope *
                 (kPerspective ? -inverse_scale : inverse_scale);
  // Steeper planes cannot be stored, and none of them is more than 90 degrees.
  surface.tilt = clamp(surface.tilt, -kLargestTilt, kLargestTilt);
  vec2 ray =
      parameters.slope.zw + (kPerspective ? surface.centre * parameters.slope.xy : vec2(0.0));
  float z = 1.0 + dot(surface.tilt, ray);
  float per_length = inversesqrt(dot(surface.tilt, surface.tilt) + z * z);
  surface.n_dot_v = max(per_length, kLeastNDotV);
  // The plane at the texel's centre, bounded where it is seen edge-on.
  float moved = found.inverse_depth + dot(0.5 * way, surface.gradient);
  surface.inverse_depth =
      kPerspective ? clamp(moved, 0.5 * found.inverse_depth, 2.0 * found.inverse_depth) : moved;
  surface.plane_weight = surface.n_dot_v * parameters.tolerance * inverse_scale;
  if (kLobe) {
    surface.lobe = fetch_lobe_surface(surface.pixel, fetch_normal(surface.pixel));
  }
  find_traced(surface);
  return surface;
}

#endif

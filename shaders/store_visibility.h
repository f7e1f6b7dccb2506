#ifndef ALCOVE_STORE_VISIBILITY_H
#define ALCOVE_STORE_VISIBILITY_H

// Returns the texel that stores `visibility`: in every channel or, if `keeps_channels`, in
// `channel` of an image that holds something else in the others, whose contents are `kept_image`.
// No other invocation may write this texel, because its other channels are read and written back.
vec4 visibility_texel(float visibility, bool keeps_channels, int channel, texture2D kept_image,
                      ivec2 texel) {
  vec4 stored = vec4(visibility);
  if (keeps_channels) {
    stored = texelFetch(kept_image, texel, 0);
    stored[channel] = visibility;
  }
  return stored;
}

#endif

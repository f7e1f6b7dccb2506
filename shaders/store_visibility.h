// Writes visibility to every channel of its image, or to one channel of an image that holds
// something else in the others. A shader that includes it must define the constants kKeepsChannels
// and kVisibilityChannel and the images visibility_image and kept_image.
#ifndef ALCOVE_STORE_VISIBILITY_H
#define ALCOVE_STORE_VISIBILITY_H

// No other invocation may write this texel, because its other channels are read and written back.
void store_visibility(ivec2 texel, float visibility) {
  vec4 stored = vec4(visibility);
  if (kKeepsChannels) {
    stored = texelFetch(kept_image, texel, 0);
    stored[kVisibilityChannel] = visibility;
  }
  imageStore(visibility_image, texel, stored);
}

#endif

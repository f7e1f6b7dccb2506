// Mixes two textures into a third, so that a texel shows all that led to it.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform utexture2D sampled_input;
layout(binding = 1, r32ui) uniform readonly uimage2D storage_input;
layout(binding = 2, r32ui) uniform uimage2D result;
layout(push_constant) uniform Parameters {
  uint seed;
  uint keep;  // 1: what is there is mixed in
};

uint mix_in(uint a, uint b) {
  const uint x = (a ^ b) * 0x9e3779b1u;
  return x ^ (x >> 15);
}

void main() {
  const ivec2 size = imageSize(result);
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  uint value = mix_in(seed, uint(texel.y * size.x + texel.x));
  value = mix_in(value, texelFetch(sampled_input, texel % textureSize(sampled_input, 0), 0).x);
  value = mix_in(value, imageLoad(storage_input, texel % imageSize(storage_input)).x);
  if (keep == 1u) value = mix_in(value, imageLoad(result, texel).x);
  imageStore(result, texel, uvec4(value));
}

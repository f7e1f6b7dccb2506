// Mixes a texture and a buffer into another buffer.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 64) in;

layout(binding = 0) uniform utexture2D sampled_input;
layout(binding = 1, std430) readonly buffer Input { uint words[]; }
from;
layout(binding = 2, std430) buffer Result { uint words[]; }
to;
layout(push_constant) uniform Parameters {
  uint seed;
  uint keep;
};

uint mix_in(uint a, uint b) {
  const uint x = (a ^ b) * 0x9e3779b1u;
  return x ^ (x >> 15);
}

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= uint(to.words.length())) return;
  const ivec2 size = textureSize(sampled_input, 0);
  const ivec2 texel = ivec2(int(index) % size.x, (int(index) / size.x) % size.y);
  uint value = mix_in(seed, index);
  value = mix_in(value, texelFetch(sampled_input, texel, 0).x);
  value = mix_in(value, from.words[index % uint(from.words.length())]);
  if (keep == 1u) value = mix_in(value, to.words[index]);
  to.words[index] = value;
}

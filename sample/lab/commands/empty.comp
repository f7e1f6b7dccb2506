#version 460

// Does nothing: `alcove measure` times what a dispatch costs by itself.
layout(local_size_x = 64) in;

void main() {}

// tinygltf, compiled with coverage and sanitisers.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

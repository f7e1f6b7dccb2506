// A program that uses Alcove and is written like a public sample renderer: see renderer.h.
//
//   alcove_host FILE.pgm [--async] [--float-normals] [--size WxH] [--eye X,Y,Z]
//
// The program orbits the scene in a small image, resizes the image to WxH or to the size in
// scene.h, draws the view with a static camera and writes the visibility of the last frame to
// FILE.pgm.
#include <cstdio>
#include <cstring>

#include "renderer.h"
#include "scene.h"

int main(int argc, char** argv) {
  const char* const usage =
      "usage: alcove_host FILE.pgm [--async] [--float-normals] [--size WxH] [--eye X,Y,Z]";
  host::require(argc >= 2, usage);
  host::Options options{.eye = host::kEye};
  VkExtent2D size{host::kWidth, host::kHeight};
  for (int i = 2; i < argc; ++i) {
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    if (std::strcmp(argv[i], "--async") == 0) {
      options.async = true;
    } else if (std::strcmp(argv[i], "--float-normals") == 0) {
      options.float_normals = true;
    } else if (std::strcmp(argv[i], "--size") == 0) {
      host::require(std::sscanf(value, "%ux%u", &size.width, &size.height) == 2, usage);
      ++i;
    } else {
      glm::vec3& eye = options.eye;
      host::require(std::strcmp(argv[i], "--eye") == 0 &&
                        std::sscanf(value, "%f,%f,%f", &eye.x, &eye.y, &eye.z) == 3,
                    usage);
      ++i;
    }
  }
  host::Renderer renderer(options);
  renderer.resize({240, 135});
  for (int i = 0; i < 9; ++i) renderer.draw(-0.3f + 0.03f * static_cast<float>(i));
  renderer.resize(size);
  for (std::uint32_t i = 0; i < host::kStillFrames; ++i) renderer.draw(0.0f);
  renderer.write_visibility(argv[1]);
  return 0;
}

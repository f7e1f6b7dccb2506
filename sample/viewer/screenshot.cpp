#include "viewer/screenshot.h"

#include <optional>
#include <utility>

#include "render/read_back.h"
#include "support/image_io.h"
#include "support/whole_file.h"

namespace alcove::sample {

Image<glm::vec3> screenshot(const HostBuffer& buffer, VkExtent2D size, VkFormat format) {
  const bool blue_first = format == VK_FORMAT_B8G8R8A8_UNORM;
  return to_image<glm::vec3, Byte4>(buffer, size, [&](Byte4 texel) {
    if (blue_first) {
      std::swap(texel[0], texel[2]);
    }
    return from_bytes(texel);
  });
}

tl::expected<std::filesystem::path, std::string> write_screenshot(
    const std::filesystem::path& folder, const Image<glm::vec3>& image) {
  std::optional<OutputFolder> made;
  if (!folder.empty()) {
    auto created = OutputFolder::create(folder);
    if (!created) return tl::unexpected(std::move(created.error()));
    made.emplace(std::move(*created));
  }
  std::filesystem::path file = folder / "view.png";
  for (int i = 2; std::filesystem::exists(file); ++i) {
    file = folder / ("view-" + std::to_string(i) + ".png");
  }
  return write_png(file, image).map([&] { return file; });
}

}  // namespace alcove::sample

#include "work/image_roles.h"

#include <algorithm>
#include <array>
#include <bit>

#include "work/format_name.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

enum class ImageKind : std::uint8_t { depth, colour, signed_colour, mask };

struct Role {
  const char* name;
  ImageKind kind;
  std::uint32_t channels;  // that the format has at least
};

// In the order of AlcoveImageRole.
constexpr std::array<Role, ALCOVE_IMAGE_COUNT> kRoles{
    {{"depth", ImageKind::depth, 1},
     {"normals", ImageKind::signed_colour, 3},
     {"motion vectors", ImageKind::signed_colour, 2},
     {"roughness", ImageKind::colour, 1},
     {"back-face depth", ImageKind::depth, 1},
     {"second depth", ImageKind::depth, 1},
     {"albedo", ImageKind::colour, 3},
     {"mask", ImageKind::mask, 1},
     {"visibility", ImageKind::colour, 1},
     {"bent normals", ImageKind::signed_colour, 3},
     {"specular occlusion", ImageKind::colour, 1},
     {"multi-bounce", ImageKind::colour, 3}}};

struct KnownFormat {
  VkFormat format;
  std::uint32_t channels;
  bool is_signed;
};

// The colour formats that shaders read as floats. Some devices cannot store all of them.
constexpr auto kColourFormats = std::to_array<KnownFormat>({
    {VK_FORMAT_R8_UNORM, 1, false},
    {VK_FORMAT_R8_SNORM, 1, true},
    {VK_FORMAT_R8_SRGB, 1, false},
    {VK_FORMAT_R8G8_UNORM, 2, false},
    {VK_FORMAT_R8G8_SNORM, 2, true},
    {VK_FORMAT_R8G8_SRGB, 2, false},
    {VK_FORMAT_R8G8B8A8_UNORM, 4, false},
    {VK_FORMAT_R8G8B8A8_SNORM, 4, true},
    {VK_FORMAT_R8G8B8A8_SRGB, 4, false},
    {VK_FORMAT_B8G8R8A8_UNORM, 4, false},
    {VK_FORMAT_B8G8R8A8_SNORM, 4, true},
    {VK_FORMAT_B8G8R8A8_SRGB, 4, false},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, 4, false},
    {VK_FORMAT_A8B8G8R8_SNORM_PACK32, 4, true},
    {VK_FORMAT_A8B8G8R8_SRGB_PACK32, 4, false},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, 4, false},
    {VK_FORMAT_A2R10G10B10_SNORM_PACK32, 4, true},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, 4, false},
    {VK_FORMAT_A2B10G10R10_SNORM_PACK32, 4, true},
    {VK_FORMAT_R16_UNORM, 1, false},
    {VK_FORMAT_R16_SNORM, 1, true},
    {VK_FORMAT_R16_SFLOAT, 1, true},
    {VK_FORMAT_R16G16_UNORM, 2, false},
    {VK_FORMAT_R16G16_SNORM, 2, true},
    {VK_FORMAT_R16G16_SFLOAT, 2, true},
    {VK_FORMAT_R16G16B16A16_UNORM, 4, false},
    {VK_FORMAT_R16G16B16A16_SNORM, 4, true},
    {VK_FORMAT_R16G16B16A16_SFLOAT, 4, true},
    {VK_FORMAT_R32_SFLOAT, 1, true},
    {VK_FORMAT_R32G32_SFLOAT, 2, true},
    {VK_FORMAT_R32G32B32_SFLOAT, 3, true},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 4, true},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 3, false},
    {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, 3, false},
});

constexpr std::array kDepthFormats{
    VK_FORMAT_D16_UNORM,         VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT,
    VK_FORMAT_D16_UNORM_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT,   VK_FORMAT_D32_SFLOAT_S8_UINT,
    VK_FORMAT_R32_SFLOAT,
};

// Returns a role with what the view's conventions require of its format.
Role role_of(std::uint32_t number, const AlcoveViewInfo& info) {
  Role role = kRoles.at(number);
  if (number == ALCOVE_IMAGE_NORMALS) {
    const AlcoveNormalEncoding encoding = info.normal_encoding;
    if (encoding == ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ ||
        encoding == ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL)
      role.kind = ImageKind::colour;
    if (encoding == ALCOVE_NORMAL_ENCODING_OCTAHEDRAL ||
        encoding == ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL)
      role.channels = 2;
  }
  if (number == ALCOVE_IMAGE_ROUGHNESS) role.channels = info.settings->roughness_channel + 1;
  return role;
}

bool suits(const Role& role, VkFormat format) {
  if (role.kind == ImageKind::depth)
    return std::ranges::find(kDepthFormats, format) != kDepthFormats.end();
  if (role.kind == ImageKind::mask)
    return format == VK_FORMAT_R8_UNORM || format == VK_FORMAT_R8_UINT;
  const auto known = std::ranges::find(kColourFormats, format, &KnownFormat::format);
  return known != kColourFormats.end() && known->channels >= role.channels &&
         (known->is_signed || role.kind != ImageKind::signed_colour);
}

std::string wanted_format(const Role& role) {
  if (role.kind == ImageKind::depth) return "a depth format or VK_FORMAT_R32_SFLOAT";
  if (role.kind == ImageKind::mask) return "VK_FORMAT_R8_UNORM or VK_FORMAT_R8_UINT";
  return std::string(role.kind == ImageKind::signed_colour ? "a signed normalised or float"
                                                           : "a normalised or float") +
         " format of at least " + std::to_string(role.channels) +
         (role.channels == 1 ? " channel" : " channels");
}

}  // namespace

const char* role_name(std::uint32_t role) { return kRoles.at(role).name; }

std::string image_problem(std::uint32_t number, const AlcoveWorkImage& image,
                          const AlcoveViewInfo& info) {
  const Role role = role_of(number, info);
  if (image.width == 0 || image.height == 0) {
    return "is " + size_text({image.width, image.height}) +
           " pixels; each side must be at least 1.";
  }
  if (image.samples > 1 && number != ALCOVE_IMAGE_DEPTH) {
    return "has " + std::to_string(image.samples) +
           " samples a pixel; resolve it first, depths and normals to sample 0.";
  }
  if (image.samples > 64 || !std::has_single_bit(std::max(image.samples, 1u))) {
    return "has " + std::to_string(image.samples) +
           " samples a pixel; it must be a power of two up to 64.";
  }
  const auto format = static_cast<VkFormat>(image.format);
  return suits(role, format) ? ""
                             : "has the format " + format_name(format) + "; it must be " +
                                   wanted_format(role) + ".";
}

}  // namespace alcove::passes

#include "c/images.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdio>
#include <span>

#include "work/format_name.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;

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

bool suits(const ImageRole& role, VkFormat format) {
  if (role.kind == ImageRole::Kind::depth)
    return std::ranges::find(kDepthFormats, format) != kDepthFormats.end();
  if (role.kind == ImageRole::Kind::mask)
    return format == VK_FORMAT_R8_UNORM || format == VK_FORMAT_R8_UINT;
  const auto known = std::ranges::find(kColourFormats, format, &KnownFormat::format);
  return known != kColourFormats.end() && known->channels >= role.channels &&
         (known->is_signed || role.kind != ImageRole::Kind::signed_colour);
}

std::string wanted_format(const ImageRole& role) {
  if (role.kind == ImageRole::Kind::depth) return "a depth format or VK_FORMAT_R32_SFLOAT";
  if (role.kind == ImageRole::Kind::mask) return "VK_FORMAT_R8_UNORM or VK_FORMAT_R8_UINT";
  return std::string(role.kind == ImageRole::Kind::signed_colour ? "a signed normalised or float"
                                                                 : "a normalised or float") +
         " format of at least " + std::to_string(role.channels) +
         (role.channels == 1 ? " channel" : " channels");
}

bool same_state(const AlcoveState& a, const AlcoveState& b) {
  return a.stages == b.stages && a.access == b.access && a.layout == b.layout;
}

bool same_description(const AlcoveImage& a, const AlcoveImage& b) {
  return a.view == b.view && a.format == b.format && a.width == b.width && a.height == b.height &&
         a.usage == b.usage && a.samples == b.samples &&
         same_state(a.initial_state, b.initial_state) && same_state(a.final_state, b.final_state);
}

framegraph::State to_state(const AlcoveState& state) {
  return {state.stages, state.access, state.layout};
}

}  // namespace

ImageAreas to_areas(const AlcoveView& view) {
  ImageAreas areas{view.read_area, view.written_area, view.output_x, view.output_y};
  const auto is_given = [](const AlcoveArea& area) {
    return area.x != 0 || area.y != 0 || area.width != 0 || area.height != 0;
  };
  const bool used = is_given(areas.written) || view.output_x != 0 || view.output_y != 0 ||
                    view.largest_width != 0 || view.largest_height != 0;
  if (used && !is_given(areas.read)) areas.read = {0, 0, view.depth.width, view.depth.height};
  return areas;
}

tl::expected<void, Failure> check_image(const ImageRole& role, const AlcoveImage& image,
                                        const AlcoveView& view) {
  const auto fail = [&](const std::string& what) {
    return invalid("View " + std::to_string(view.id) + ": the image of " + role.name + " " + what);
  };
  if (image.width == 0 || image.height == 0) {
    return fail("is " + size_text({image.width, image.height}) +
                " pixels; each side must be at least 1.");
  }
  if (image.samples > 1 && !role.may_have_samples) {
    return fail("has " + std::to_string(image.samples) +
                " samples a pixel; resolve it first, depths and normals to sample 0.");
  }
  if (image.samples > 64 || !std::has_single_bit(std::max(image.samples, 1u))) {
    return fail("has " + std::to_string(image.samples) +
                " samples a pixel; it must be a power of two up to 64.");
  }
  if (!suits(role, image.format)) {
    return fail("has the format " + format_name(image.format) + "; it must be " +
                wanted_format(role) + ".");
  }
  if (image.final_state.layout == VK_IMAGE_LAYOUT_UNDEFINED ||
      image.final_state.layout == VK_IMAGE_LAYOUT_PREINITIALIZED)
    return fail("has no layout to be left in; set AlcoveImage::final_state.");
  if (!role.output && image.initial_state.layout == VK_IMAGE_LAYOUT_UNDEFINED) {
    return fail(
        "arrives in VK_IMAGE_LAYOUT_UNDEFINED, without contents; set AlcoveImage::initial_state to "
        "how it was left.");
  }
  const bool lacks_storage = role.output && (image.usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0;
  const bool lacks_sampled = !role.output && (image.usage & VK_IMAGE_USAGE_SAMPLED_BIT) == 0;
  if (lacks_storage || lacks_sampled) {
    return fail(std::string("was made without ") +
                (lacks_storage ? "VK_IMAGE_USAGE_STORAGE_BIT" : "VK_IMAGE_USAGE_SAMPLED_BIT") +
                ", or AlcoveImage::usage does not say so.");
  }
  return {};
}

tl::expected<Texture, Failure> ImageTable::import(framegraph::Graph& graph, const ImageRole& role,
                                                  const AlcoveImage& image,
                                                  const AlcoveView& view) {
  if (image.image == VK_NULL_HANDLE) return Texture{};
  if (auto right = check_image(role, image, view); !right)
    return tl::unexpected(std::move(right.error()));
  const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto found = std::find_if(entries_.begin(), end, [&](const Entry& entry) {
    return entry.image.image == image.image && entry.image.layer == image.layer;
  });
  if (found != end) {
    // Several views may write to an image, each to another area of it.
    const bool in_part = to_areas(view).read.width > 0;
    const bool may_repeat = role.output ? found->output && in_part : !found->output;
    if (!may_repeat || (role.output && found->view == view.id) ||
        !same_description(found->image, image)) {
      return invalid("View " + std::to_string(view.id) + ": the image of " + role.name +
                     " is given twice in the frame; only inputs may be, and outputs of several "
                     "views with areas, described alike.");
    }
    found->view = view.id;
    return graph.latest(found->texture);
  }
  // The name is on the stack, because a steady frame must not allocate memory.
  std::array<char, 64> name{};
  std::snprintf(name.data(), name.size(), "%s of view %u", role.name,
                static_cast<unsigned>(view.id));
  const Texture texture = graph.import_texture(
      name.data(),
      {.image = image.image,
       .view = image.view,
       .desc = {.format = image.format,
                .extent = framegraph::Extent::absolute(image.width, image.height),
                .samples = static_cast<VkSampleCountFlagBits>(std::max(image.samples, 1u))},
       .usage = image.usage,
       .first_layer = image.layer,
       .initial_state = to_state(image.initial_state),
       .final_state = to_state(image.final_state)});
  assert(count_ < entries_.size());
  entries_[count_++] = {image, texture, role.output, view.id};
  return texture;
}

}  // namespace alcove::passes

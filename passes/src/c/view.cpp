#include "c/view.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <span>

#include "diagnose/pixel_observer.h"
#include "work/describe_view.h"
#include "work/image_roles.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;

std::string view_prefix(const AlcoveView& view) {
  return "View " + std::to_string(view.info.id) + ": ";
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

// Returns what is wrong with the states and the usage of an image, as image_problem() does for the
// rest.
std::string vulkan_problem(const AlcoveImage& image, bool output) {
  if (image.final_state.layout == VK_IMAGE_LAYOUT_UNDEFINED ||
      image.final_state.layout == VK_IMAGE_LAYOUT_PREINITIALIZED)
    return "has no layout to be left in; set AlcoveImage::final_state.";
  if (!output && image.initial_state.layout == VK_IMAGE_LAYOUT_UNDEFINED) {
    return "arrives in VK_IMAGE_LAYOUT_UNDEFINED, without contents; set AlcoveImage::initial_state "
           "to how it was left.";
  }
  const VkImageUsageFlags needed = output ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
  if ((image.usage & needed) != 0) return {};
  return std::string("was made without ") +
         (output ? "VK_IMAGE_USAGE_STORAGE_BIT" : "VK_IMAGE_USAGE_SAMPLED_BIT") +
         ", or AlcoveImage::usage does not say so.";
}

// Returns the pixels of the output images that a view writes.
AlcoveArea output_area(const AlcoveView& view) {
  const AlcoveImage& depth = view.images[ALCOVE_IMAGE_DEPTH];
  AlcoveArea area = view.info.written_area;
  if (area.width == 0) area = read_area(view.info, {depth.width, depth.height});
  if (area.width == 0) area = {0, 0, depth.width, depth.height};
  return {view.info.output_x, view.info.output_y, area.width, area.height};
}

bool overlap(const AlcoveArea& a, const AlcoveArea& b) {
  const auto meet = [](std::uint64_t begin, std::uint64_t size, std::uint64_t other,
                       std::uint64_t other_size) {
    return begin < other + other_size && other < begin + size;
  };
  return meet(a.x, a.width, b.x, b.width) && meet(a.y, a.height, b.y, b.height);
}

}  // namespace

tl::expected<Texture, Error> ImageTable::import(framegraph::Graph& graph, const AlcoveView& view,
                                                std::uint32_t role) {
  const AlcoveImage& image = view.images[role];
  if (image.image == VK_NULL_HANDLE) return Texture{};
  const bool output = is_output(role);
  const auto fail = [&](const std::string& problem) {
    return invalid(view_prefix(view) + "The image of " + role_name(role) + " " + problem);
  };
  if (const std::string problem = vulkan_problem(image, output); !problem.empty())
    return fail(problem);
  const AlcoveArea part = output_area(view);
  const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto duplicate = std::find_if(entries_.begin(), end, [&](const Entry& entry) {
    return entry.image.image == image.image && entry.image.layer == image.layer;
  });
  if (duplicate != end) {
    // Several views may write to an image, each to another area of it.
    const bool in_part = read_area(view.info, {image.width, image.height}).width > 0;
    const bool may_repeat = output ? duplicate->output && in_part : !duplicate->output;
    if (!may_repeat || !same_description(duplicate->image, image)) {
      return fail(
          "is given twice in the frame; only inputs may be, and outputs of several views with "
          "areas, described alike.");
    }
    for (const Part& other : std::span(parts_).first(output ? part_count_ : 0)) {
      if (other.entry == &*duplicate && overlap(other.area, part)) {
        return fail("is written by view " + std::to_string(other.view) + " in " +
                    area_text(other.area) + " and by this view in " + area_text(part) +
                    "; give each view pixels of its own by output_x and output_y, or an image of "
                    "its own.");
      }
    }
    if (output) parts_.at(part_count_++) = {&*duplicate, part, view.info.id};
    return graph.latest(duplicate->texture);
  }
  // The name is on the stack, because a steady frame must not allocate memory.
  std::array<char, 64> name{};
  std::snprintf(name.data(), name.size(), "%s of view %u", role_name(role),
                static_cast<unsigned>(view.info.id));
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
  entries_[count_] = {image, texture, output};
  if (output) parts_.at(part_count_++) = {&entries_[count_], part, view.info.id};
  ++count_;
  return texture;
}

Result add_view(framegraph::Graph& graph, Pipelines& pipelines, ImageTable& images,
                const AlcoveView& view, const AlcoveFrame& frame, bool prepare,
                PixelObserver* observer) {
  ViewTextures textures;
  for (std::uint32_t role = 0; role < ALCOVE_IMAGE_COUNT; ++role) {
    auto texture = images.import(graph, view, role);
    if (!texture) return tl::unexpected(std::move(texture.error()));
    textures.at(role) = *texture;
  }
  if (prepare) {
    if (auto done = prepare_view(graph, pipelines, view.info, textures); !done)
      return done.map_error(with_prefix(view_prefix(view)));
  }
  const ViewTextures inputs = textures;
  if (auto done = add_view(graph, pipelines, view.info, frame.index, textures); !done)
    return done.map_error(with_prefix(view_prefix(view)));
  if (observer == nullptr || view.images[ALCOVE_IMAGE_DEPTH].samples > 1) return {};
  return observer->add(graph, pipelines, view, inputs, frame.slot)
      .map_error(with_prefix(view_prefix(view)));
}

}  // namespace alcove::passes

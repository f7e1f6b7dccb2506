// Describes the work of a view for engines that execute it themselves.
#include "alcove/alcove_work.h"

#include <cstring>

#include "c/failure.h"
#include "c/view.h"
#include "work/areas.h"
#include "work/shader_table.h"

using namespace alcove;
using passes::guarded;
using passes::invalid;
using passes::Result;

namespace {

// The image of an engine without Vulkan, as one that could be used with Vulkan. Its number takes
// the place of the handle.
AlcoveImage to_image(const AlcoveWorkImage& image, std::uintptr_t number) {
  if (image.format == 0) return {};
  const AlcoveState state{0, 0, VK_IMAGE_LAYOUT_GENERAL};
  // NOLINTNEXTLINE(performance-no-int-to-ptr): a handle is a pointer or an integer
  return {.image = (VkImage)number,
          .format = static_cast<VkFormat>(image.format),
          .width = image.width,
          .height = image.height,
          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
          .samples = image.samples,
          .initial_state = state,
          .final_state = state};
}

AlcoveView to_alcove_view(const AlcoveWorkInfo& info) {
  AlcoveView view{.struct_size = sizeof(AlcoveView),
                  .normals_in_view_space = info.normals_in_view_space,
                  .normal_encoding = info.normal_encoding,
                  .normals_forward_z = info.normals_forward_z,
                  .settings = info.settings,
                  .largest_width = info.largest_width,
                  .largest_height = info.largest_height,
                  .read_area = info.read_area,
                  .written_area = info.written_area,
                  .output_x = info.output_x,
                  .output_y = info.output_y,
                  .depth = to_image(info.depth, 1),
                  .depth_format = static_cast<VkFormat>(info.depth_format),
                  .normals = to_image(info.normals, 2),
                  .motion = to_image(info.motion, 3),
                  .roughness = to_image(info.roughness, 4),
                  .back_depth = to_image(info.back_depth, 5),
                  .second_depth = to_image(info.second_depth, 6),
                  .albedo = to_image(info.albedo, 7),
                  .mask = to_image(info.mask, 12),
                  .not_receiving = info.not_receiving,
                  .not_occluding = info.not_occluding,
                  .visibility = to_image(info.visibility, 8),
                  .bent_normal = to_image(info.bent_normal, 9),
                  .specular = to_image(info.specular, 10),
                  .multi_bounce = to_image(info.multi_bounce, 11)};
  std::ranges::copy(info.motion_scale, view.motion_scale);
  std::ranges::copy(info.motion_offset, view.motion_offset);
  return view;
}

Result describe(const AlcoveWorkInfo* given, AlcoveWork* work) {
  if (given == nullptr || work == nullptr)
    return invalid("There is no AlcoveWorkInfo or no AlcoveWork.");
  const AlcoveWorkInfo& info = *given;
  if (auto right = passes::check_size(info.struct_size, sizeof info, "AlcoveWorkInfo"); !right)
    return right;
  if (info.previous != nullptr && (info.previous->history_count > ALCOVE_MAX_WORK_HISTORIES ||
                                   info.previous->resource_count > ALCOVE_MAX_WORK_RESOURCES))
    return invalid("AlcoveWorkInfo::previous is not a list that alcoveDescribeWork has filled.");
  passes::WorkFrame frame{.view = passes::to_view(info.camera),
                          .index = info.index,
                          .static_frames = info.static_frames,
                          .largest_size = {info.largest_width, info.largest_height}};
  if (info.previous != nullptr) {
    frame.previous_view = passes::to_view(info.previous->camera);
    frame.previous_size = {info.previous->width, info.previous->height};
  }
  passes::WorkList list(*work, info.previous);
  const AlcoveView view = to_alcove_view(info);
  frame.areas = passes::to_areas(view);
  const VkExtent2D size = passes::read_size(frame, {info.depth.width, info.depth.height});
  work->camera = info.camera;
  work->width = size.width;
  work->height = size.height;
  const auto setup = passes::set_up(
      view, {[](void* user, const passes::ImageRole& role, const AlcoveImage& image,
                const AlcoveView& of) -> tl::expected<framegraph::Texture, passes::Failure> {
               if (image.image == VK_NULL_HANDLE) return framegraph::Texture{};
               return passes::check_image(role, image, of).map([&] {
                 return static_cast<passes::WorkList*>(user)->add(
                     role.output ? ALCOVE_RESOURCE_KIND_OUTPUT : ALCOVE_RESOURCE_KIND_INPUT,
                     role.name, image.format, {image.width, image.height}, 1,
                     std::max(image.samples, 1u));
               });
             },
             &list});
  if (!setup) return tl::unexpected(setup.error());
  if (const auto made = passes::describe_view(list, frame, setup->inputs, setup->settings); !made)
    return tl::unexpected(passes::failure_of(made.error(), "The view"));
  return {};
}

}  // namespace

AlcoveResult alcoveDescribeWork(const AlcoveWorkInfo* info, AlcoveWork* work, char* message) {
  passes::Message said{};
  const AlcoveResult result = guarded(said, [&] { return describe(info, work); });
  if (message != nullptr) std::memcpy(message, said.data(), said.size());
  return result;
}

size_t alcovePrintWork(const AlcoveWork* work, char* text, size_t size) {
  passes::copy_text("", text, size);
  std::size_t length = 0;
  if (work != nullptr) {
    guarded([&]() -> Result {
      length = passes::copy_text(passes::print_work(*work), text, size);
      return {};
    });
  }
  return length;
}

AlcoveResult alcoveGetShader(const char* name, AlcoveShader* shader) {
  const passes::Shader found =
      name == nullptr ? passes::Shader::count : passes::shader_of_name(name);
  if (shader == nullptr || found == passes::Shader::count) return ALCOVE_ERROR_INVALID_INPUT;
  const auto code = passes::shader_source(found).code;
  *shader = {code.data(), code.size_bytes()};
  return ALCOVE_SUCCESS;
}

#include "work/describe_view.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "work/image_roles.h"
#include "work/interleave_offset.h"
#include "work/number_text.h"
#include "work/view_parameters.h"

namespace alcove::passes {

namespace {

using Checked = tl::expected<void, Error>;

tl::unexpected<Error> refusal(std::string message) {
  return tl::unexpected(Error{std::move(message)});
}

bool is_given(const AlcoveArea& area) {
  return area.x != 0 || area.y != 0 || area.width != 0 || area.height != 0;
}

// Whether `size` pixels from `begin` on end within `end`.
bool fits(std::uint32_t begin, std::uint32_t size, std::uint64_t end) {
  return std::uint64_t{begin} + size <= end;
}

VkExtent2D size_of(const AlcoveWorkImage& image) { return {image.width, image.height}; }

// Checks which images are given.
Checked check_required(const AlcoveWorkInfo& info) {
  const AlcoveSettings& settings = *info.view.settings;
  const auto lacks = [&](AlcoveImageRole role) { return info.images[role].format == 0; };
  const auto refuse = [](AlcoveImageRole role, const std::string& what) {
    return refusal(std::string("There is no image of ") + role_name(role) + ", " + what + ".");
  };
  if (lacks(ALCOVE_IMAGE_DEPTH)) return refuse(ALCOVE_IMAGE_DEPTH, "from which everything is made");
  if (!lacks(ALCOVE_IMAGE_MULTI_BOUNCE) && lacks(ALCOVE_IMAGE_ALBEDO))
    return refuse(ALCOVE_IMAGE_ALBEDO, "from which multi-bounce is made");
  if (lacks(ALCOVE_IMAGE_VISIBILITY) && lacks(ALCOVE_IMAGE_BENT_NORMAL) &&
      lacks(ALCOVE_IMAGE_SPECULAR) && lacks(ALCOVE_IMAGE_MULTI_BOUNCE)) {
    return refusal(
        "There is no image to write to; give one of visibility, bent normals, specular occlusion "
        "and multi-bounce.");
  }
  if (!lacks(ALCOVE_IMAGE_SPECULAR) && settings.specular == ALCOVE_SPECULAR_NONE) {
    return refusal(
        "The setting 'specular' is none, but there is an image of specular occlusion; choose "
        "slices or table, or leave the image out.");
  }
  if (needs_back_depth(settings) && lacks(ALCOVE_IMAGE_BACK_DEPTH))
    return refuse(ALCOVE_IMAGE_BACK_DEPTH, "which the setting 'thickness_limit' needs");
  if (needs_second_depth(settings) && lacks(ALCOVE_IMAGE_SECOND_DEPTH)) {
    return refuse(ALCOVE_IMAGE_SECOND_DEPTH,
                  "which the setting 'depth_layers' needs; give it, or set depth_layers to 1");
  }
  return {};
}

// Checks each image, and that all inputs have the same size.
Checked check_images(const AlcoveWorkInfo& info) {
  const VkExtent2D depth = size_of(info.images[ALCOVE_IMAGE_DEPTH]);
  for (std::uint32_t role = 0; role < ALCOVE_IMAGE_COUNT; ++role) {
    const AlcoveWorkImage& image = info.images[role];
    if (image.format == 0) continue;
    std::string problem = image_problem(role, image, info.view);
    if (problem.empty() && !is_output(role) &&
        (image.width != depth.width || image.height != depth.height)) {
      problem = "has " + size_text(size_of(image)) + " pixels, and that of depth " +
                size_text(depth) + "; make them equal.";
    }
    if (!problem.empty())
      return refusal(std::string("The image of ") + role_name(role) + " " + problem);
  }
  return {};
}

Checked check_conventions(const AlcoveWorkInfo& info) {
  const AlcoveViewInfo& view = info.view;
  if (number_of(view.normal_encoding) > ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL) {
    return refusal("AlcoveViewInfo::normal_encoding is " +
                   std::to_string(number_of(view.normal_encoding)) +
                   ", which is none of its values.");
  }
  const MotionConvention motion = motion_of(view);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::isfinite(motion.scale[i]) || motion.scale[i] == 0.0f ||
        !std::isfinite(motion.offset[i])) {
      return refusal("The scale of motion vectors is " + number_text(motion.scale[i]) +
                     " and their offset " + number_text(motion.offset[i]) +
                     "; both must be finite, and the scale not 0.");
    }
  }
  const std::uint32_t bits = view.not_receiving | view.not_occluding;
  if (info.images[ALCOVE_IMAGE_MASK].format != 0 && (bits == 0 || bits > 255)) {
    return refusal("The mask of surfaces is read with the bits " +
                   std::to_string(view.not_receiving) + " of surfaces that do not receive and " +
                   std::to_string(view.not_occluding) +
                   " of surfaces that do not occlude; give at least one bit, and values up to "
                   "255.");
  }
  return {};
}

// Checks that the area that is read lies in the images, and the area that is written in it.
Checked check_areas(const AlcoveArea& read, const AlcoveArea& written, VkExtent2D whole) {
  const auto refuse = [](const char* name, const AlcoveArea& area, const std::string& rule) {
    return refusal("The area that is " + std::string(name) + " has " + area_text(area) + "; " +
                   rule + ".");
  };
  for (const auto& [name, area] : {std::pair{"read", read}, {"written", written}})
    if (is_given(area) && (area.width == 0 || area.height == 0))
      return refuse(name, area, "each side must be at least 1");
  if (!fits(read.x, read.width, whole.width) || !fits(read.y, read.height, whole.height))
    return refuse("read", read, "it must lie within depth's " + size_text(whole));
  const bool inside = written.x >= read.x && written.y >= read.y &&
                      fits(written.x, written.width, std::uint64_t{read.x} + read.width) &&
                      fits(written.y, written.height, std::uint64_t{read.y} + read.height);
  return is_given(written) && !inside
             ? refuse("written", written,
                      "it must lie within the area that is read, " + area_text(read))
             : Checked();
}

// Checks that the outputs have room for the results, and without areas exactly their size.
Checked check_outputs(const ViewInputs& view, const AlcoveWorkInfo& info) {
  const std::uint32_t x = view.info.output_x, y = view.info.output_y;
  const VkExtent2D written{view.written.width, view.written.height};
  for (std::uint32_t role = ALCOVE_IMAGE_FIRST_OUTPUT; role < ALCOVE_IMAGE_COUNT; ++role) {
    const VkExtent2D size = size_of(info.images[role]);
    const bool room = fits(x, written.width, size.width) && fits(y, written.height, size.height);
    const bool same = size.width == written.width && size.height == written.height;
    if (info.images[role].format == 0 || (view.in_part ? room : same)) continue;
    return refusal(std::string("The image of ") + role_name(role) + " is " + size_text(size) +
                   " pixels; it needs " +
                   (view.in_part ? "room for " + area_text({x, y, written.width, written.height})
                                 : size_text(written)) +
                   ".");
  }
  return {};
}

Checked check_largest(const ViewInputs& view) {
  if (view.size.width <= view.largest.width && view.size.height <= view.largest.height) return {};
  return refusal("The depth has " + size_text(view.size) + " pixels; it must be within " +
                 size_text(view.largest) + ", the largest size.");
}

// Sets the sizes and areas of a view whose images and areas have been checked.
void set_areas(ViewInputs& view, const AlcoveArea& read, VkExtent2D whole) {
  const AlcoveViewInfo& info = view.info;
  view.in_part = read.width > 0;
  view.read = view.in_part ? read : AlcoveArea{0, 0, whole.width, whole.height};
  view.size = {view.read.width, view.read.height};
  const AlcoveArea& written = info.written_area;
  view.written = is_given(written) ? AlcoveArea{written.x - read.x, written.y - read.y,
                                                written.width, written.height}
                                   : AlcoveArea{0, 0, view.size.width, view.size.height};
  const bool bounded =
      view.settings.history_frames > 0 && (info.largest_width != 0 || info.largest_height != 0);
  view.largest = bounded ? VkExtent2D{info.largest_width, info.largest_height} : view.size;
}

}  // namespace

std::string area_text(const AlcoveArea& area) {
  return size_text({area.width, area.height}) + " pixels at (" + std::to_string(area.x) + ", " +
         std::to_string(area.y) + ")";
}

AlcoveArea read_area(const AlcoveViewInfo& info, VkExtent2D depth) {
  // With dynamic resolution, images may be larger than the part that is in use.
  const bool used = is_given(info.written_area) || info.output_x != 0 || info.output_y != 0 ||
                    info.largest_width != 0 || info.largest_height != 0;
  return used && !is_given(info.read_area) ? AlcoveArea{0, 0, depth.width, depth.height}
                                           : info.read_area;
}

bool same_camera(const AlcoveCamera& a, const AlcoveCamera& b) {
  return std::ranges::equal(a.clip_from_view, b.clip_from_view) &&
         std::ranges::equal(a.view_from_world, b.view_from_world);
}

tl::expected<ViewInputs, Error> begin_view(WorkBuilder& list, const AlcoveWorkInfo& request) {
  const AlcoveViewInfo& info = request.view;
  if (info.settings == nullptr)
    return refusal("There are no settings: alcoveGetSettings gives some.");
  const AlcoveWorkImage& depth = request.images[ALCOVE_IMAGE_DEPTH];
  const AlcoveArea read = read_area(info, size_of(depth));
  ViewInputs view{.list = list, .info = info, .settings = *info.settings};
  const auto checked =
      validate(view.settings)
          .and_then([&] { return check_required(request); })
          .and_then([&] { return check_conventions(request); })
          .and_then([&] { return check_images(request); })
          .and_then([&] { return check_areas(read, info.written_area, size_of(depth)); })
          .and_then([&] {
            set_areas(view, read, size_of(depth));
            return check_outputs(view, request);
          })
          .and_then([&] { return check_largest(view); })
          .and_then([&] { return projection_of(info.camera, view.size); });
  if (!checked) return tl::unexpected(checked.error());
  view.projection = *checked;
  view.index = has_static_noise(view.settings) ? kStaticNoise : request.index;
  view.static_frames = info.reset_history != 0 ? 0 : info.static_frames;
  view.depth_format =
      static_cast<VkFormat>(info.depth_format != 0 ? info.depth_format : depth.format);
  for (std::uint32_t role = 0; role < ALCOVE_IMAGE_COUNT; ++role) {
    const AlcoveWorkImage& image = request.images[role];
    if (image.format == 0) continue;
    view.images[role] = list.add(
        is_output(role) ? ALCOVE_RESOURCE_KIND_OUTPUT : ALCOVE_RESOURCE_KIND_INPUT, role_name(role),
        static_cast<VkFormat>(image.format), size_of(image), std::max(image.samples, 1u), role);
  }
  AlcoveWork& work = list.work();
  work.camera = info.camera;
  work.width = view.size.width;
  work.height = view.size.height;
  return view;
}

tl::expected<void, Error> describe_view(WorkBuilder& list, const AlcoveWorkInfo& info) {
  const auto begun = begin_view(list, info);
  if (!begun) return tl::unexpected(begun.error());
  const ViewInputs& view = *begun;
  const Depths depths = describe_depths(view);
  const RawOcclusionImages raw = describe_gtao(view, depths);
  return describe_reconstruct(view, depths.receivers, raw)
      .and_then([&](const OutputImages& results) {
        if (view.by_table()) describe_gtso(view, depths.receivers, results);
        if (view.image(ALCOVE_IMAGE_MULTI_BOUNCE)) describe_multi_bounce(view, results.visibility);
        return list.result();
      });
}

tl::expected<std::vector<AlcoveWorkPipeline>, Error> list_pipelines(AlcoveWork& work,
                                                                    const AlcoveWorkInfo& info) {
  enum class Past : std::uint8_t { none, moving, unchanged };
  std::vector<AlcoveWorkPipeline> pipelines;
  for (const Past past : {Past::none, Past::moving, Past::unchanged}) {
    AlcoveWorkInfo frame = info;
    AlcoveViewInfo& view = frame.view;
    view.reset_history = view.previous_width = view.previous_height = 0;
    view.static_frames = past == Past::unchanged ? 1 : 0;
    view.previous_camera = view.camera;
    if (past == Past::moving) {
      float& x = view.previous_camera.view_from_world[12];
      x = x == 0.0f ? 1.0f : 0.0f;
    }
    WorkBuilder list(work);
    if (past != Past::none)
      list.set_history_source({[](void*, HistoryRole, const auto&) { return true; }});
    if (auto described = describe_view(list, frame); !described)
      return tl::unexpected(std::move(described.error()));
    for (std::uint32_t i = 0; i < work.dispatch_count; ++i) {
      const AlcoveWorkDispatch& dispatch = work.dispatches[i];
      AlcoveWorkPipeline pipeline{dispatch.shader, dispatch.constant_count, {}};
      std::ranges::copy_n(dispatch.constants, dispatch.constant_count, pipeline.constants);
      const bool known = std::ranges::any_of(pipelines, [&](const AlcoveWorkPipeline& other) {
        return other.shader == pipeline.shader &&
               std::ranges::equal(other.constants, pipeline.constants, {},
                                  &AlcoveWorkConstant::value, &AlcoveWorkConstant::value);
      });
      if (!known) pipelines.push_back(pipeline);
    }
  }
  return pipelines;
}

}  // namespace alcove::passes

// Describes the work of a view for engines that execute it themselves.
#include "alcove/alcove_work.h"

#include <algorithm>
#include <memory>

#include "c/failure.h"
#include "work/describe_view.h"
#include "work/shader_table.h"

using namespace alcove;
using passes::guarded;
using passes::invalid;
using passes::Result;

namespace {

Result check(const AlcoveWorkInfo* info) {
  if (info == nullptr) return invalid("There is no AlcoveWorkInfo.");
  if (auto valid = passes::check_size(info->struct_size, sizeof *info, "AlcoveWorkInfo"); !valid)
    return valid;
  const AlcoveWork* const previous = info->previous;
  const bool filled =
      previous == nullptr ||
      (previous->history_count <= ALCOVE_MAX_WORK_HISTORIES &&
       previous->resource_count <= ALCOVE_MAX_WORK_RESOURCES &&
       std::all_of(previous->histories, previous->histories + previous->history_count,
                   [&](const AlcoveWorkHistory& history) {
                     return history.current < previous->resource_count;
                   }));
  if (filled) return {};
  return invalid("AlcoveWorkInfo::previous is not a list that alcoveDescribeWork has filled.");
}

Result describe(const AlcoveWorkInfo& original, AlcoveWork& work) {
  AlcoveWorkInfo info = original;
  AlcoveViewInfo& view = info.view;
  const AlcoveWork* const previous = view.reset_history != 0 ? nullptr : original.previous;
  if (previous != nullptr) {
    view.previous_camera = previous->camera;
    view.previous_width = previous->width;
    view.previous_height = previous->height;
  }
  passes::WorkBuilder list(work, previous);
  return passes::describe_view(list, info).map_error(passes::with_prefix("The view: "));
}

Result list_pipelines(const AlcoveWorkInfo& info, std::uint32_t& count,
                      AlcoveWorkPipeline* pipelines) {
  const auto work = std::make_unique<AlcoveWork>();
  return passes::list_pipelines(*work, info)
      .map_error(passes::with_prefix("The view: "))
      .map([&](const auto& list) {
        const auto there = static_cast<std::uint32_t>(list.size());
        count = pipelines == nullptr ? there : std::min(count, there);
        if (pipelines != nullptr) std::copy_n(list.begin(), count, pipelines);
      });
}

}  // namespace

AlcoveResult alcoveDescribeWork(const AlcoveWorkInfo* info, AlcoveWork* work, char* message) {
  return guarded(message, [&]() -> Result {
    if (work == nullptr) return invalid("There is no AlcoveWork.");
    return check(info).and_then([&] { return describe(*info, *work); });
  });
}

AlcoveResult alcoveListPipelines(const AlcoveWorkInfo* info, uint32_t* count,
                                 AlcoveWorkPipeline* pipelines, char* message) {
  return guarded(message, [&]() -> Result {
    if (count == nullptr) return invalid("There is no place for the number of pipelines.");
    return check(info).and_then([&] { return list_pipelines(*info, *count, pipelines); });
  });
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
  const passes::Shader id = name == nullptr ? passes::Shader::count : passes::shader_of_name(name);
  if (shader == nullptr || id == passes::Shader::count) return ALCOVE_ERROR_INVALID_INPUT;
  const auto code = passes::shader_source(id).code;
  *shader = {code.data(), code.size_bytes()};
  return ALCOVE_SUCCESS;
}

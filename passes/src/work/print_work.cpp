#include <array>
#include <string>

#include "work/format_name.h"
#include "work/shader_table.h"
#include "work/work_builder.h"

namespace alcove::passes {
namespace {

// Appends texts and numbers.
class Text {
 public:
  Text& operator<<(std::string_view text) {
    text_.append(text);
    return *this;
  }
  Text& operator<<(std::uint64_t number) {
    text_.append(std::to_string(number));
    return *this;
  }
  std::string& text() { return text_; }

 private:
  std::string text_;
};

void print(Text& to, const AlcoveWorkResource& resource) {
  constexpr std::array kKinds{"input",           "output", "transient", "previous history",
                              "current history", "table"};
  to << resource.name << ": " << kKinds.at(resource.kind);
  if (resource.kind != ALCOVE_RESOURCE_KIND_TABLE) {
    to << ", " << format_name(static_cast<VkFormat>(resource.format)) << ", "
       << std::uint64_t{resource.width} << "x" << std::uint64_t{resource.height};
  }
  if (resource.size > 0) to << ", " << resource.size << " bytes";
  if (resource.first_dispatch == ALCOVE_WORK_NONE) {
    to << ", not used\n";
  } else {
    to << ", dispatches " << std::uint64_t{resource.first_dispatch} << " to "
       << std::uint64_t{resource.last_dispatch} << "\n";
  }
}

void print(Text& to, const AlcoveWorkBinding& binding, const AlcoveWork& work) {
  constexpr std::array kTypes{"parameters", "table", "sampler", "fetched", "storage"};
  constexpr std::array kAccesses{"", " reads ", " writes ", " reads and writes "};
  to << "    binding " << std::uint64_t{binding.number} << " " << kTypes.at(binding.type);
  if (binding.resource != ALCOVE_WORK_NONE) {
    to << " " << binding.name << kAccesses.at(binding.access) << std::uint64_t{binding.resource}
       << " " << work.resources[binding.resource].name;
  }
  to << "\n";
}

void print(Text& to, const AlcoveWorkDispatch& dispatch, const AlcoveWork& work) {
  to << dispatch.label << ": shader " << dispatch.shader << ", "
     << std::uint64_t{dispatch.groups[0]} << "x" << std::uint64_t{dispatch.groups[1]} << "x"
     << std::uint64_t{dispatch.groups[2]} << " groups, " << std::uint64_t{dispatch.parameter_bytes}
     << " bytes of parameters\n";
  const ShaderInterface& shader = shader_interface(shader_of_name(dispatch.shader));
  for (std::uint32_t i = 0; i < dispatch.constant_count; ++i) {
    to << (i == 0 ? "    constants " : " ") << shader.constants[i].name << "="
       << std::uint64_t{dispatch.constants[i].value}
       << (i + 1 == dispatch.constant_count ? "\n" : "");
  }
  for (std::uint32_t i = 0; i < dispatch.binding_count; ++i) print(to, dispatch.bindings[i], work);
}

}  // namespace

std::string print_work(const AlcoveWork& work) {
  Text to;
  to << "resources\n";
  for (std::uint32_t i = 0; i < work.resource_count; ++i) {
    to << "  " << std::uint64_t{i} << " ";
    print(to, work.resources[i]);
  }
  to << "dispatches\n";
  for (std::uint32_t i = 0; i < work.dispatch_count; ++i) {
    to << "  " << std::uint64_t{i} << " ";
    print(to, work.dispatches[i], work);
  }
  if (work.history_count > 0)
    to << "histories, " << (work.history_valid != 0 ? "which continue\n" : "which begin\n");
  for (std::uint32_t i = 0; i < work.history_count; ++i) {
    const AlcoveWorkHistory& history = work.histories[i];
    to << "  " << work.resources[history.current].name << ": " << std::uint64_t{history.current}
       << " becomes " << std::uint64_t{history.previous} << " of the next frame\n";
  }
  return std::move(to.text());
}

}  // namespace alcove::passes

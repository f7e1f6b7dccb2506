// Writes lists of work, with their inputs and the results of Vulkan, for webgpu_run.mjs: one file
// of JSON per test, in the working folder. Numbers in it are those of alcove_work.h.
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "../passes/c_interface_fixture.h"

namespace alcove::passes {
namespace {

using Json = nlohmann::json;

template <typename Element>
Json array(const Element* elements, std::size_t count, Json (*json)(const Element&)) {
  Json all = Json::array();
  for (const Element& each : std::span(elements, count)) all.push_back(json(each));
  return all;
}

Json number(const unsigned char& byte) { return byte; }

Json json(const AlcoveWorkConstant& of) { return {{"id", of.id}, {"value", of.value}}; }

Json json(const AlcoveWorkBinding& of) {
  return {{"number", of.number}, {"type", of.type}, {"resource", of.resource}};
}

Json json(const AlcoveWorkResource& of) {
  const auto* data = static_cast<const unsigned char*>(of.data);
  return {{"name", of.name},     {"kind", of.kind},
          {"role", of.role},     {"size", {of.width, of.height}},
          {"format", of.format}, {"data", array(data, data != nullptr ? of.size : 0, number)}};
}

Json json(const AlcoveWorkDispatch& of) {
  return {{"shader", of.shader},
          {"groups", of.groups},
          {"constants", array(of.constants, of.constant_count, json)},
          {"bindings", array(of.bindings, of.binding_count, json)},
          {"parameters", array(of.parameters, of.parameter_bytes, number)}};
}

class WebGpuLists : public CInterface {
 protected:
  // Writes a series of frames of 240x136 pixels to a file that is named after the preset.
  void write(const PresetCase& preset) {
    HostView from = draw_view(240, 136, ball_on_floor(), 0.5f, preset);
    from.motion = {};
    Json all;
    for (const InputMember& each : kInputs) all["inputs"][each.role] = (from.*each.texels).texels;
    const auto work = std::make_unique<AlcoveWork>();
    for (std::uint32_t index = 0; index < kSeriesFrames; ++index) {
      advance(from, index);
      const AlcoveView view = create_view(from);
      const AlcoveWorkInfo info = work_info(view, index, index > 0 ? work.get() : nullptr);
      ASSERT_EQ(alcoveDescribeWork(&info, work.get(), nullptr), ALCOVE_SUCCESS);
      Json& frame = all["frames"][index];
      frame = {{"resources", array(work->resources, work->resource_count, json)},
               {"dispatches", array(work->dispatches, work->dispatch_count, json)}};
      const auto results = run_view(view, index);
      for (const OutputMember& each : kOutputs)
        frame["results"][each.role] = (results.*each.texels).texels;
    }
    ASSERT_TRUE(std::ofstream(std::string(preset.name) + ".json") << all);
  }
};

// A test each, because a list begins without a history.
TEST_F(WebGpuLists, Low) { write({"low", ALCOVE_QUALITY_LOW}); }
TEST_F(WebGpuLists, Medium) { write({"medium", ALCOVE_QUALITY_MEDIUM}); }
TEST_F(WebGpuLists, Console) { write({"console", ALCOVE_QUALITY_CONSOLE}); }
TEST_F(WebGpuLists, AllOutputs) { write({"all_outputs", ALCOVE_QUALITY_LOW, request_all_outputs}); }
TEST_F(WebGpuLists, Table) {
  write({"table", ALCOVE_QUALITY_LOW,
         [](HostView& view) { view.settings.specular = ALCOVE_SPECULAR_TABLE; }});
}

}  // namespace
}  // namespace alcove::passes

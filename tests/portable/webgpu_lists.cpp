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
  // Writes a series of frames of 240x136 pixels with the settings of a preset, which `change`
  // changes.
  void write(
      AlcoveQuality quality, void (*change)(HostView& view) = [](HostView&) {}) {
    HostView from = draw_view(240, 136);
    const std::uint32_t roughness_channel = from.settings.roughness_channel;
    from.settings = OcclusionSettings(quality, 0.5f);
    from.settings.roughness_channel = roughness_channel;
    from.motion = {};
    change(from);
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
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    ASSERT_TRUE(std::ofstream(name + ".json") << all);
  }
};

TEST_F(WebGpuLists, low) { write(ALCOVE_QUALITY_LOW); }
TEST_F(WebGpuLists, medium) { write(ALCOVE_QUALITY_MEDIUM); }
TEST_F(WebGpuLists, console) { write(ALCOVE_QUALITY_CONSOLE); }
TEST_F(WebGpuLists, all_outputs) { write(ALCOVE_QUALITY_LOW, request_all_outputs); }
TEST_F(WebGpuLists, table) {
  write(ALCOVE_QUALITY_LOW, [](HostView& view) { view.settings.specular = ALCOVE_SPECULAR_TABLE; });
}

}  // namespace
}  // namespace alcove::passes

// Tests that declaring the lighting pass again allocates nothing.
#include <gtest/gtest.h>

#include "alcove/passes/apply.h"
#include "framegraph/allocation_counter.h"
#include "gpu/gpu.h"
#include "maths/spherical_harmonics.h"

namespace alcove::passes {
namespace {

using framegraph::Extent;
using framegraph::Graph;

// Returns all inputs, or the required ones only.
ApplyInputs inputs_of(Graph& graph, bool all) {
  const auto make = [&](const char* name) {
    return graph.create_texture(name, {VK_FORMAT_R32G32B32A32_SFLOAT, Extent::absolute(8, 6)});
  };
  ApplyInputs inputs{.depth = make("depth"), .normals = make("normals"), .albedo = make("albedo")};
  inputs.harmonics = graph.create_texture(
      "harmonics", {VK_FORMAT_R32G32B32A32_SFLOAT, Extent::absolute(maths::kHarmonics, 1)});
  if (all) {
    inputs.roughness = make("roughness");
    inputs.metallic = make("metallic");
    inputs.visibility = make("visibility");
    inputs.bent_normal = make("bent normal");
    inputs.specular_occlusion = make("specular occlusion");
    inputs.light = make("light");
    inputs.map =
        graph.create_texture("map", {VK_FORMAT_R32G32B32A32_SFLOAT, Extent::absolute(16, 16), 2});
  }
  return inputs;
}

TEST(SteadyLightingPass, DeclaringTheUnchangedLightingPassAgainAllocatesNoHostMemory) {
  const auto gpu = sample::Gpu::create();
  ASSERT_TRUE(gpu) << gpu.error();
  View view;
  view.clip_from_view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
  for (const bool all : {false, true}) {
    Graph graph;
    std::size_t steady = 0;
    for (int i = 0; i < 20; ++i) {
      const std::size_t before = framegraph::allocations();
      graph.reset();
      const Frame frame{graph, (*gpu)->kernels(), view};
      const auto light = add_apply(frame, inputs_of(graph, all), {.parts = true});
      ASSERT_TRUE(light) << light.error().message;
      steady += i < 10 ? 0 : framegraph::allocations() - before;
    }
    EXPECT_EQ(steady, 0u) << all;
  }
}

}  // namespace
}  // namespace alcove::passes

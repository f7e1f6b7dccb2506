// Tests the interfaces that are read from the embedded shaders, and the errors of passes that do
// not match them.
#include "work/shader_interface.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "pass_fixture.h"
#include "vulkan/descriptor_sets.h"
#include "work/shader_table.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Shader> all_shaders() {
  std::vector<Shader> shaders;
  for (int i = 0; i < static_cast<int>(Shader::count); ++i) {
    shaders.push_back(static_cast<Shader>(i));
  }
  return shaders;
}

TEST(ShaderInterface, BindingNamesNumbersAndTypesReadFromSpirvAreThoseOfTheGlslFile) {
  const ShaderInterface found = read_shader_interface(shader_source(Shader::gtso_by_table).code);
  std::vector<std::string> bindings, constants;
  for (const ShaderBinding& binding : found.bindings) {
    bindings.push_back(std::to_string(binding.number) + " " + std::string(binding.name) + " " +
                       std::to_string(binding.type));
  }
  for (const ShaderConstant& constant : found.constants) {
    constants.push_back(std::to_string(constant.id) + " " + std::string(constant.name));
  }
  // The blocks have no instance name.
  const std::string sampled = std::to_string(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  EXPECT_THAT(bindings,
              ElementsAre("0  " + std::to_string(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER),
                          "1 visibility_image " + sampled, "2 bent_normal_image " + sampled,
                          "3 normal_image " + sampled, "4 depth_image " + sampled,
                          "5 roughness_image " + sampled,
                          "6 result_image " + std::to_string(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE),
                          "7  " + std::to_string(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)));
  EXPECT_THAT(constants, ElementsAre("0 kRoughnessTexture", "1 kRoughnessChannel",
                                     "2 kNormalEncoding", "3 kVisibilityChannel"));
}

TEST(ShaderInterface, CombinedImageSamplersAreDistinguishedFromSampledImages) {
  const ShaderInterface found = read_shader_interface(shader_source(Shader::upsample).code);
  for (const ShaderBinding& binding : found.bindings) {
    if (binding.name == "half_image") {
      EXPECT_EQ(binding.type, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    } else if (binding.name == "normal_image") {
      EXPECT_EQ(binding.type, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
    }
  }
}

TEST(ShaderInterface, EveryShaderHasUniqueBindingNumbersKnownTypesAndOneParameterBlock) {
  for (const Shader shader : all_shaders()) {
    SCOPED_TRACE(shader_source(shader).name);
    const ShaderInterface found = read_shader_interface(shader_source(shader).code);
    EXPECT_LE(found.bindings.size(), kMaxBindings);
    EXPECT_LE(found.constants.size(), Kernels::kMaxConstants);
    std::set<std::uint32_t> numbers, ids;
    std::size_t parameter_blocks = 0, tables = 0;
    for (const ShaderBinding& binding : found.bindings) {
      EXPECT_TRUE(numbers.insert(binding.number).second) << binding.name;
      EXPECT_NE(binding.type, VK_DESCRIPTOR_TYPE_MAX_ENUM) << binding.name;
      parameter_blocks += binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? 1 : 0;
      tables += binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? 1 : 0;
    }
    for (const ShaderConstant& constant : found.constants) {
      EXPECT_TRUE(ids.insert(constant.id).second) << constant.name;
      EXPECT_THAT(std::string(constant.name), testing::StartsWith("k"));
    }
    EXPECT_EQ(parameter_blocks, 1u);
    EXPECT_EQ(tables, shader_source(shader).table.empty() ? 0u : 1u);
  }
}

class KernelsByName : public PassTest {
 protected:
  // Dispatches the shader `linear_depth` with one view for each of the names.
  tl::expected<framegraph::FrameReport, std::string> run_linear_depth(
      const std::vector<std::string_view>& names) {
    const auto kernel = gpu().kernels().get(Shader::linear_depth);
    if (!kernel) {
      return tl::unexpected(kernel.error().message);
    }
    return gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
      const Texture depth = upload(graph, {8, 8, std::vector<float>(64, 0.5f), 1});
      auto pass = graph.add_pass("linear depth");
      pass.read(depth, framegraph::access::sampled_compute);
      pass.side_effect();
      pass.record([this, names, kernel = *kernel, depth](RecordContext& context) {
        std::vector<NamedView> views;
        for (const std::string_view name : names) {
          views.push_back({name, context.view(depth)});
        }
        const std::array<std::byte, 64> parameters{};
        gpu().kernels().dispatch(context, kernel, views, parameters, {8, 8, 1});
      });
      return {};
    });
  }
};

TEST_F(KernelsByName, SpecialisationConstantWithoutAValueIsReportedByName) {
  const auto kernel = gpu().kernels().get(
      Shader::gtso,
      std::to_array<NamedConstant>(
          {{"kRoughnessTexture", 0}, {"kRoughnesChannel", 0}, {"kNormalEncoding", 0}}));
  ASSERT_FALSE(kernel);
  EXPECT_THAT(kernel.error().message,
              HasSubstr("The shader 'gtso' has a specialisation constant 'kRoughnessChannel', for "
                        "which its pass gives no value"));
}

TEST_F(KernelsByName, SpecialisationConstantsMayBeGivenInAnyOrderTogetherWithThoseOfOtherShaders) {
  const auto ordered =
      gpu().kernels().get(Shader::gtso, std::to_array<NamedConstant>({{"kRoughnessTexture", 1},
                                                                      {"kRoughnessChannel", 2},
                                                                      {"kNormalEncoding", 3},
                                                                      {"kVisibilityChannel", 1}}));
  const auto shuffled =
      gpu().kernels().get(Shader::gtso, std::to_array<NamedConstant>({{"kTileSize", 9},
                                                                      {"kVisibilityChannel", 1},
                                                                      {"kNormalEncoding", 3},
                                                                      {"kRoughnessTexture", 1},
                                                                      {"kRoughnessChannel", 2}}));
  ASSERT_TRUE(ordered && shuffled);
  EXPECT_EQ(ordered->pipeline, shuffled->pipeline);
}

TEST_F(KernelsByName, SpecialisationConstantThatNoShaderDeclaresIsReportedByName) {
  const auto kernel =
      gpu().kernels().get(Shader::gtso, std::to_array<NamedConstant>({{"kRoughnessTexture", 1},
                                                                      {"kRoughnessChannel", 2},
                                                                      {"kNormalEncoding", 3},
                                                                      {"kVisibilityChannel", 1},
                                                                      {"kTilesize", 9}}));
  ASSERT_FALSE(kernel);
  EXPECT_THAT(kernel.error().message,
              HasSubstr("The pass of the shader 'gtso' gives a value for a specialisation constant "
                        "'kTilesize', which no shader declares"));
}

TEST_F(KernelsByName, ShaderBindingWithoutAnImageViewIsReportedByName) {
  const auto done = run_linear_depth({"depth_ndc_image", "linear_image"});
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(),
              HasSubstr("view of the binding 'linear_depth_image' of the shader 'linear_depth'"));
}

TEST_F(KernelsByName, ImageViewForABindingThatNoShaderDeclaresIsReportedByName) {
  const auto done = run_linear_depth({"depth_ndc_image", "linear_depth_image", "linear_image"});
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(), HasSubstr("view 'linear_image' of the shader 'linear_depth', a name "
                                      "that no shader declares"));
}

}  // namespace
}  // namespace alcove::passes

// Tests the interfaces that the build reads from the shaders, and the errors of passes that do not
// match them.
#include <gmock/gmock.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "vulkan/descriptor_sets.h"
#include "work/shader_table.h"
#include "work/work_builder.h"

namespace alcove::passes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Shader> all_shaders() {
  std::vector<Shader> shaders;
  for (int i = 0; i < static_cast<int>(Shader::count); ++i)
    shaders.push_back(static_cast<Shader>(i));
  return shaders;
}

TEST(ShaderInterface, BindingNamesNumbersAndTypesReadFromSpirvAreThoseOfTheGlslFile) {
  const ShaderInterface& description = shader_interface(Shader::gtso);
  std::vector<std::string> bindings, constants;
  for (const ShaderBinding& binding : description.bindings) {
    bindings.push_back(std::to_string(binding.number) + " " + std::string(binding.name) + " " +
                       std::to_string(binding.type));
  }
  for (const ShaderConstant& constant : description.constants)
    constants.push_back(std::to_string(constant.id) + " " + std::string(constant.name));
  // The blocks have no instance name.
  const std::string sampled = std::to_string(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  EXPECT_THAT(bindings,
              ElementsAre("0  " + std::to_string(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER),
                          "1 visibility_image " + sampled, "2 bent_normal_image " + sampled,
                          "3 normal_image " + sampled, "4 depth_image " + sampled,
                          "5 roughness_image " + sampled,
                          "6 result_image " + std::to_string(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE),
                          "7  " + std::to_string(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)));
  EXPECT_THAT(constants,
              ElementsAre("0 kRoughnessTexture", "1 kRoughnessChannel", "2 kNormalEncoding",
                          "3 kAreas", "4 kPerspective", "5 kReversed"));
}

// Storage images that are read need typed loads, which Direct3D 12 does not guarantee.
TEST(ShaderInterface, ShadersHaveAtMostOneSamplerAndStorageImagesAreOnlyWritten) {
  for (const Shader shader : all_shaders()) {
    SCOPED_TRACE(shader_source(shader).name);
    int samplers = 0;
    for (const ShaderBinding& binding : shader_interface(shader).bindings) {
      samplers += binding.type == VK_DESCRIPTOR_TYPE_SAMPLER ? 1 : 0;
      EXPECT_EQ(binding.access, std::uint32_t{binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                  ? ALCOVE_WORK_ACCESS_WRITE
                                                  : ALCOVE_WORK_ACCESS_READ})
          << binding.name;
    }
    EXPECT_LE(samplers, 1);
  }
}

// naga, which translates SPIR-V to WGSL, refuses these: copies of whole structs of two layouts,
// which SPIR-V has from 1.4 on, constants that select a float, and counts of bits of another type
// than the bits.
TEST(ShaderInterface, ModulesHaveNoInstructionThatWebGpuLacks) {
  constexpr std::uint32_t kExtended = 12, kTypeFloat = 22, kSpecConstantOp = 52, kBitCount = 205;
  constexpr std::uint32_t kFindLowestBit = 73;
  for (const Shader shader : all_shaders()) {
    SCOPED_TRACE(shader_source(shader).name);
    const auto words = shader_source(shader).code;
    EXPECT_EQ(words[1], 0x10300u) << "not SPIR-V 1.3";
    std::set<std::uint32_t> floats;
    std::map<std::uint32_t, std::uint32_t> types;  // of results
    for (std::size_t i = 5; i < words.size(); i += words[i] >> 16) {
      const std::uint32_t op = words[i] & 0xffffu;
      if (op == kTypeFloat) floats.insert(words[i + 1]);
      EXPECT_FALSE(op == kSpecConstantOp && floats.contains(words[i + 1]));
      if (op == kBitCount) {
        EXPECT_EQ(types[words[i + 3]], words[i + 1]);
      }
      if (op == kExtended && words[i + 4] == kFindLowestBit) {
        EXPECT_EQ(types[words[i + 5]], words[i + 1]);
      }
      const bool is_value = op == kExtended || op == 61 || op == 81 || (op >= 109 && op <= 245);
      if (is_value) types[words[i + 2]] = words[i + 1];
    }
  }
}

TEST(ShaderInterface, EveryShaderHasUniqueBindingNumbersAndOneParameterBlock) {
  for (const Shader shader : all_shaders()) {
    SCOPED_TRACE(shader_source(shader).name);
    const ShaderInterface& description = shader_interface(shader);
    EXPECT_LE(description.bindings.size(), kMaxBindings);
    EXPECT_LE(description.constants.size(), std::size_t{ALCOVE_MAX_WORK_CONSTANTS});
    std::set<std::uint32_t> numbers, ids;
    std::size_t parameter_blocks = 0, tables = 0;
    for (const ShaderBinding& binding : description.bindings) {
      EXPECT_TRUE(numbers.insert(binding.number).second) << binding.name;
      parameter_blocks += binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? 1 : 0;
      tables += binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? 1 : 0;
    }
    for (const ShaderConstant& constant : description.constants) {
      EXPECT_TRUE(ids.insert(constant.id).second) << constant.name;
      EXPECT_THAT(std::string(constant.name), testing::StartsWith("k"));
    }
    EXPECT_EQ(parameter_blocks, 1u);
    EXPECT_EQ(tables, shader_source(shader).table.empty() ? 0u : 1u);
  }
}

class DispatchByName : public testing::Test {
 protected:
  // Adds a dispatch of a shader with these constants, and with an image for each of the names.
  tl::expected<void, Error> add(Shader shader, const std::vector<NamedConstant>& constants,
                                const std::vector<std::string_view>& names) {
    WorkBuilder list(*work_);
    const auto image = list.add(ALCOVE_RESOURCE_KIND_INPUT, "image", VK_FORMAT_R32_SFLOAT, {8, 8});
    std::vector<NamedImage> images;
    for (const std::string_view name : names) images.push_back({name, image});
    list.dispatch({.shader = shader, .constants = constants, .images = images, .size = {8, 8, 1}});
    return list.result();
  }
  tl::expected<void, Error> add_gtso(const std::vector<NamedConstant>& constants) {
    return add(Shader::gtso, constants,
               {"visibility_image", "bent_normal_image", "normal_image", "depth_image",
                "roughness_image", "result_image"});
  }

  std::unique_ptr<AlcoveWork> work_ = std::make_unique<AlcoveWork>();
};

TEST_F(DispatchByName, SpecialisationConstantWithoutAValueIsReportedByName) {
  const auto result =
      add_gtso({{"kRoughnessTexture", 0}, {"kRoughnesChannel", 0}, {"kNormalEncoding", 0}});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message,
              HasSubstr("The shader 'gtso' has a specialisation constant 'kRoughnessChannel', for "
                        "which its pass gives no value"));
}

TEST_F(DispatchByName, SpecialisationConstantsMayBeGivenInAnyOrderTogetherWithThoseOfOtherShaders) {
  const auto result = add_gtso({{"kTileSize", 9},
                                {"kAreas", 0},
                                {"kNormalEncoding", 3},
                                {"kRoughnessTexture", 1},
                                {"kReversed", 5},
                                {"kPerspective", 4},
                                {"kRoughnessChannel", 2}});
  ASSERT_TRUE(result) << result.error().message;
  std::vector<std::uint32_t> values;
  for (const AlcoveWorkConstant& constant :
       std::span(work_->dispatches[0].constants).first(work_->dispatches[0].constant_count))
    values.push_back(constant.value);
  EXPECT_THAT(values, ElementsAre(1, 2, 3, 0, 4, 5));
}

TEST_F(DispatchByName, ShaderBindingWithoutAnImageIsReportedByName) {
  const auto result = add(Shader::resolve_depth, {}, {"depth_image", "copied_image"});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message,
              HasSubstr("The shader 'resolve_depth' has a binding 'copy_image', for which its "
                        "pass gives no image"));
}

TEST_F(DispatchByName, ListThatIsFullIsAnError) {
  WorkBuilder list(*work_);
  while (list.add(ALCOVE_RESOURCE_KIND_INPUT, "image", VK_FORMAT_R32_SFLOAT, {8, 8})) {
  }
  EXPECT_EQ(work_->resource_count, std::uint32_t{ALCOVE_MAX_WORK_RESOURCES});
  const NamedImage images[] = {{"depth_image", {0}}, {"copy_image", {}}};
  list.dispatch({.shader = Shader::resolve_depth, .images = images, .size = {8, 8, 1}});
  ASSERT_FALSE(list.result());
  EXPECT_THAT(list.result().error().message,
              HasSubstr("'copy_image', for which its pass gives no"));
}

}  // namespace
}  // namespace alcove::passes

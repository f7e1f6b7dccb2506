#include "work/shader_interface.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>

#include "alcove/alcove_work.h"

namespace alcove::passes {
namespace {

// Numbers of the SPIR-V specification, version 1.5.
constexpr std::uint32_t kHeaderWords = 5;
constexpr std::uint32_t kBoundWord = 3;  // all ids of the module are below this word of its header
enum Op : std::uint32_t {
  kOpName = 5,
  kOpTypeImage = 25,
  kOpTypeSampler = 26,
  kOpTypePointer = 32,
  kOpFunction = 54,
  kOpVariable = 59,
  kOpDecorate = 71,
};
constexpr std::uint32_t kDecorationSpecId = 1;
constexpr std::uint32_t kDecorationNonWritable = 24;
constexpr std::uint32_t kDecorationNonReadable = 25;
constexpr std::uint32_t kDecorationBinding = 33;
constexpr std::uint32_t kStorageClassUniform = 2;
constexpr std::uint32_t kStorageClassStorageBuffer = 12;
constexpr std::uint32_t kImageWithoutSampler = 2;  // operand `Sampled` of OpTypeImage

using Words = std::span<const std::uint32_t>;

// The module's statements about one id.
struct Id {
  std::string_view name;
  Words definition;  // the instruction of a type or a variable, with its first word
  std::optional<std::uint32_t> binding;
  std::optional<std::uint32_t> constant_id;
  bool non_writable = false;
  bool non_readable = false;
};

// A literal string has its first character in the lowest byte of its first word.
std::string_view string_of(Words words) {
  static_assert(std::endian::native == std::endian::little);
  // Characters may be read through a pointer of their type whatever the object is.
  const std::string_view all(reinterpret_cast<const char*>(words.data()), words.size_bytes());
  return all.substr(0, all.find('\0'));
}

std::uint32_t opcode_of(Words instruction) { return instruction[0] & 0xffffu; }

void read_instruction(Words words, std::vector<Id>& ids) {
  switch (opcode_of(words)) {
    case kOpName:
      ids.at(words[1]).name = string_of(words.subspan(2));
      break;
    case kOpDecorate:
      if (words[2] == kDecorationBinding)
        ids.at(words[1]).binding = words[3];
      else if (words[2] == kDecorationSpecId)
        ids.at(words[1]).constant_id = words[3];
      else if (words[2] == kDecorationNonWritable)
        ids.at(words[1]).non_writable = true;
      else if (words[2] == kDecorationNonReadable)
        ids.at(words[1]).non_readable = true;
      break;
    case kOpTypeImage:
    case kOpTypeSampler:
    case kOpTypePointer:
      ids.at(words[1]).definition = words;
      break;
    case kOpVariable:
      ids.at(words[2]).definition = words;
      break;
    default:
      break;
  }
}

std::vector<Id> ids_of(Words module) {
  std::vector<Id> ids(module[kBoundWord]);
  for (std::size_t at = kHeaderWords; at < module.size();) {
    const Words instruction = module.subspan(at, module[at] >> 16);
    if (opcode_of(instruction) == kOpFunction)
      break;  // names, decorations, types and variables come before the functions
    read_instruction(instruction, ids);
    at += instruction.size();
  }
  return ids;
}

VkDescriptorType descriptor_type(const std::vector<Id>& ids, const Id& variable) {
  const std::uint32_t storage_class = variable.definition[3];
  if (storage_class == kStorageClassUniform) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (storage_class == kStorageClassStorageBuffer) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const Words pointer = ids.at(variable.definition[1]).definition;
  const Words type = ids.at(pointer[3]).definition;
  if (type.empty()) return VK_DESCRIPTOR_TYPE_MAX_ENUM;
  if (opcode_of(type) == kOpTypeSampler) return VK_DESCRIPTOR_TYPE_SAMPLER;
  return type[7] == kImageWithoutSampler ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                         : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
}

// Only storage images are written. (The members of a storage block, not the variable, have the
// decoration of a block that is only read. The blocks of this library are tables.)
std::uint32_t access_of(const Id& variable, VkDescriptorType type) {
  if (type != VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) return ALCOVE_WORK_ACCESS_READ;
  std::uint32_t access = ALCOVE_WORK_ACCESS_READ | ALCOVE_WORK_ACCESS_WRITE;
  if (variable.non_readable) access &= ~std::uint32_t{ALCOVE_WORK_ACCESS_READ};
  if (variable.non_writable) access &= ~std::uint32_t{ALCOVE_WORK_ACCESS_WRITE};
  return access;
}

}  // namespace

ShaderInterface read_shader_interface(Words module) {
  const std::vector<Id> ids = ids_of(module);
  ShaderInterface result;
  for (const Id& id : ids) {
    if (id.binding) {
      const VkDescriptorType type = descriptor_type(ids, id);
      result.bindings.push_back({id.name, *id.binding, type, access_of(id, type)});
    } else if (id.constant_id) {
      result.constants.push_back({id.name, *id.constant_id});
    }
  }
  std::ranges::sort(result.bindings, {}, &ShaderBinding::number);
  std::ranges::sort(result.constants, {}, &ShaderConstant::id);
  return result;
}

}  // namespace alcove::passes

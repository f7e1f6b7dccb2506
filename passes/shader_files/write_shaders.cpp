// Writes the shaders of the library as files, for engines that execute the list of work themselves:
//
//   alcove_write_shaders DIRECTORY
//
// Each shader becomes DIRECTORY/NAME.spv. DIRECTORY/interfaces.json has their bindings, their
// specialisation constants, and the members of their parameters.
#include <cstdio>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "work/shader_table.h"

namespace {

using namespace alcove::passes;
using Words = std::span<const std::uint32_t>;

// Numbers of the SPIR-V specification, version 1.5.
enum Op : std::uint32_t {
  kOpMemberName = 6,
  kOpTypeBool = 20,
  kOpTypeInt = 21,
  kOpTypeFloat = 22,
  kOpTypeVector = 23,
  kOpTypeMatrix = 24,
  kOpTypeStruct = 30,
  kOpTypePointer = 32,
  kOpSpecConstantTrue = 48,
  kOpSpecConstantFalse = 49,
  kOpSpecConstant = 50,
  kOpVariable = 59,
  kOpDecorate = 71,
  kOpMemberDecorate = 72,
};
constexpr std::uint32_t kDecorationSpecId = 1;
constexpr std::uint32_t kDecorationOffset = 35;
constexpr std::uint32_t kStorageClassUniform = 2;

// Declarations of a module about its types, its uniform block and its specialisation constants.
struct Module {
  struct Member {
    std::string name;
    std::uint32_t offset = 0;
  };
  std::map<std::uint32_t, Words> definitions;  // of types and constants, by id
  std::map<std::pair<std::uint32_t, std::uint32_t>, Member> members;  // by struct and index
  std::map<std::uint32_t, std::uint32_t> constants;                   // id by constant_id
  std::uint32_t block = 0;  // the struct of the uniform block

  explicit Module(Words words) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
      read(words.subspan(at, words[at] >> 16));
  }

  void read(Words words) {
    switch (words[0] & 0xffffu) {
      case kOpMemberName:
        members[{words[1], words[2]}].name = reinterpret_cast<const char*>(words.data() + 3);
        break;
      case kOpMemberDecorate:
        if (words[3] == kDecorationOffset) members[{words[1], words[2]}].offset = words[4];
        break;
      case kOpDecorate:
        if (words[2] == kDecorationSpecId) constants[words[3]] = words[1];
        break;
      case kOpTypeBool:
      case kOpTypeInt:
      case kOpTypeFloat:
      case kOpTypeVector:
      case kOpTypeMatrix:
      case kOpTypeStruct:
      case kOpTypePointer:
        definitions[words[1]] = words;
        break;
      case kOpSpecConstantTrue:
      case kOpSpecConstantFalse:
      case kOpSpecConstant:
        definitions[words[2]] = words;
        break;
      case kOpVariable:
        if (words[3] == kStorageClassUniform) block = definitions[words[1]][3];
        break;
      default:
        break;
    }
  }

  // Returns the name of a type in GLSL.
  std::string type(std::uint32_t id) const {
    const Words words = definitions.at(id);
    switch (words[0] & 0xffffu) {
      case kOpTypeBool:
        return "bool";
      case kOpTypeInt:
        return words[3] != 0 ? "int" : "uint";
      case kOpTypeFloat:
        return "float";
      case kOpTypeVector: {
        const std::string of = type(words[2]);
        return (of == "float" ? "" : of.substr(0, 1)) + "vec" + std::to_string(words[3]);
      }
      default:
        return "mat" + std::to_string(words[3]);
    }
  }

  // Adds the members of a struct, with those of the structs in it.
  void add_members(std::uint32_t id, std::uint32_t offset, const std::string& prefix,
                   std::vector<std::string>& rows) const {
    const Words words = definitions.at(id);
    for (std::uint32_t i = 0; i + 2 < words.size(); ++i) {
      const Member& member = members.at({id, i});
      const std::uint32_t of = words[i + 2];
      if ((definitions.at(of)[0] & 0xffffu) == kOpTypeStruct) {
        // The struct of the block itself has no name that a reader needs.
        add_members(of, offset + member.offset, id == block ? "" : prefix + member.name + ".",
                    rows);
      } else {
        rows.push_back("{\"name\": \"" + prefix + member.name + "\", \"type\": \"" + type(of) +
                       "\", \"offset\": " + std::to_string(offset + member.offset) + "}");
      }
    }
  }

  // Returns the type and the default of a specialisation constant.
  std::string constant(std::uint32_t constant_id) const {
    const Words words = definitions.at(constants.at(constant_id));
    const std::uint32_t op = words[0] & 0xffffu;
    const std::uint32_t value = op == kOpSpecConstant ? words[3] : op == kOpSpecConstantTrue;
    return "\"type\": \"" + type(words[1]) + "\", \"default\": " + std::to_string(value);
  }
};

std::string array(const char* name, const std::vector<std::string>& rows) {
  std::string text = std::string("      \"") + name + "\": [";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += (i == 0 ? "\n        " : ",\n        ") + rows[i];
  return text + (rows.empty() ? "]" : "\n      ]");
}

const char* type_name(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "parameters";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "table";
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return "sampler";
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "fetched image";
    default:
      return "storage image";
  }
}

std::string describe(Shader shader) {
  const ShaderSource source = shader_source(shader);
  const ShaderInterface& interface = shader_interface(shader);
  const Module module(source.code);
  std::vector<std::string> bindings, constants, parameters;
  for (const ShaderBinding& binding : interface.bindings) {
    constexpr const char* kAccesses[] = {"", "read", "write", "read and write"};
    bindings.push_back("{\"binding\": " + std::to_string(binding.number) + ", \"name\": \"" +
                       std::string(binding.name) + "\", \"type\": \"" + type_name(binding.type) +
                       "\", \"access\": \"" + kAccesses[binding.access] + "\"}");
  }
  for (const ShaderConstant& constant : interface.constants) {
    constants.push_back("{\"id\": " + std::to_string(constant.id) + ", \"name\": \"" +
                        std::string(constant.name) + "\", " + module.constant(constant.id) + "}");
  }
  module.add_members(module.block, 0, "", parameters);
  return "    {\n      \"name\": \"" + std::string(source.name) + "\",\n" +
         array("bindings", bindings) + ",\n" + array("constants", constants) + ",\n" +
         array("parameters", parameters) + "\n    }";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("Usage: alcove_write_shaders DIRECTORY\n", stderr);
    return 1;
  }
  const std::string folder = std::string(argv[1]) + "/";
  std::ofstream json(folder + "interfaces.json");
  json << "{\n  \"entry_point\": \"main\",\n  \"group_size\": [8, 8, 1],\n  \"shaders\": [\n";
  for (int i = 0; i < static_cast<int>(Shader::count); ++i) {
    const ShaderSource source = shader_source(static_cast<Shader>(i));
    std::ofstream file(folder + std::string(source.name) + ".spv", std::ios::binary);
    file.write(reinterpret_cast<const char*>(source.code.data()),
               static_cast<std::streamsize>(source.code.size_bytes()));
    json << (i == 0 ? "" : ",\n") << describe(static_cast<Shader>(i));
    if (!file) {
      std::fprintf(stderr, "The shaders cannot be written to %s.\n", argv[1]);
      return 1;
    }
  }
  json << "\n  ]\n}\n";
  return json ? 0 : 1;
}

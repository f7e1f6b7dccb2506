// A build tool that reads the interfaces of the shaders from their SPIR-V, which has debug names:
//
//   alcove_read_shaders HEADER JSON MODULE...
//
// HEADER includes the words of all modules and has their bindings and specialisation constants for
// the library. JSON has them for engines that execute the list of work themselves, with the members
// of the parameters. The name of a shader is that of its file.
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using Words = std::span<const std::uint32_t>;

// Numbers of the SPIR-V specification, version 1.3.
constexpr std::uint32_t kHeaderWords = 5;
enum Op : std::uint32_t {
  kOpName = 5,
  kOpMemberName = 6,
  kOpTypeVoid = 19,  // the first of the types
  kOpTypeBool = 20,
  kOpTypeInt = 21,
  kOpTypeFloat = 22,
  kOpTypeVector = 23,
  kOpTypeImage = 25,
  kOpTypeSampler = 26,
  kOpTypeStruct = 30,
  kOpTypeFunction = 33,  // the last of the types that have an id in their first operand
  kOpSpecConstantTrue = 48,
  kOpSpecConstantFalse = 49,
  kOpSpecConstant = 50,
  kOpVariable = 59,
  kOpDecorate = 71,
  kOpMemberDecorate = 72,
};
constexpr std::uint32_t kDecorationSpecId = 1;
constexpr std::uint32_t kDecorationNonWritable = 24;
constexpr std::uint32_t kDecorationNonReadable = 25;
constexpr std::uint32_t kDecorationBinding = 33;
constexpr std::uint32_t kDecorationOffset = 35;
constexpr std::uint32_t kStorageClassUniform = 2;
constexpr std::uint32_t kStorageClassStorageBuffer = 12;
constexpr std::uint32_t kImageWithoutSampler = 2;  // operand `Sampled` of OpTypeImage

// A value in the header and in the JSON.
struct Text {
  const char* cpp;
  const char* json;
};
constexpr Text kParameters{"VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER", "parameters"};
constexpr Text kTable{"VK_DESCRIPTOR_TYPE_STORAGE_BUFFER", "table"};
constexpr Text kSampler{"VK_DESCRIPTOR_TYPE_SAMPLER", "sampler"};
constexpr Text kFetchedImage{"VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE", "fetched image"};
constexpr Text kStorageImage{"VK_DESCRIPTOR_TYPE_STORAGE_IMAGE", "storage image"};
constexpr Text kRead{"ALCOVE_WORK_ACCESS_READ", "read"};
constexpr Text kWrite{"ALCOVE_WORK_ACCESS_WRITE", "write"};
constexpr Text kReadAndWrite{"ALCOVE_WORK_ACCESS_READ | ALCOVE_WORK_ACCESS_WRITE",
                             "read and write"};

// A literal string has its first character in the lowest byte of its first word.
std::string string_of(Words words) {
  static_assert(std::endian::native == std::endian::little);
  return reinterpret_cast<const char*>(words.data());
}

std::uint32_t opcode_of(Words instruction) { return instruction[0] & 0xffffu; }

// The statements of a module about one id, or about one member of a struct.
struct Declared {
  std::string name;
  Words definition;  // the instruction of a type, a variable or a constant, with its first word
  std::map<std::uint32_t, std::uint32_t> decorations;  // their operands; 0 if they have none
};

class Module {
 public:
  explicit Module(Words words) {
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16)
      read(words.subspan(at, words[at] >> 16));
  }

  // The ids with a decoration that numbers them, by that number.
  std::map<std::uint32_t, const Declared*> numbered(std::uint32_t decoration) const {
    std::map<std::uint32_t, const Declared*> found;
    for (const auto& [id, declared] : ids_)
      if (const auto number = declared.decorations.find(decoration);
          number != declared.decorations.end())
        found[number->second] = &declared;
    return found;
  }

  // Throws if the type is unknown, as that of a combined image sampler, which exists in neither
  // Direct3D 12, Metal nor WebGPU.
  Text binding_type(const Declared& variable) const {
    const std::uint32_t storage_class = variable.definition[3];
    if (storage_class == kStorageClassUniform) return kParameters;
    if (storage_class == kStorageClassStorageBuffer) return kTable;
    const Words type = definition(pointee(variable));
    if (opcode_of(type) == kOpTypeSampler) return kSampler;
    if (opcode_of(type) != kOpTypeImage)
      throw std::runtime_error("the binding '" + variable.name + "' has an unknown type");
    return type[7] == kImageWithoutSampler ? kStorageImage : kFetchedImage;
  }

  // Only storage images are written. (The members of a storage block, not the variable, have the
  // decoration of a block that is only read. The blocks of this library are tables.)
  Text access(const Declared& variable) const {
    if (binding_type(variable).json != kStorageImage.json ||
        variable.decorations.contains(kDecorationNonWritable))
      return kRead;
    return variable.decorations.contains(kDecorationNonReadable) ? kWrite : kReadAndWrite;
  }

  // Returns the name of a type in GLSL.
  std::string type(std::uint32_t id) const {
    const Words words = definition(id);
    switch (opcode_of(words)) {
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

  // Returns the members of the uniform block as JSON, with those of the structs in it.
  std::vector<std::string> parameters() const {
    std::vector<std::string> rows;
    for (const auto& [id, declared] : ids_) {
      const Words words = declared.definition;
      if (!words.empty() && opcode_of(words) == kOpVariable && words[3] == kStorageClassUniform) {
        // The struct in the block has no name that a reader needs.
        add_members(definition(pointee(declared))[2], 0, "", rows);
      }
    }
    return rows;
  }

 private:
  void read(Words words) {
    const std::uint32_t op = opcode_of(words);
    if (op == kOpName)
      ids_[words[1]].name = string_of(words.subspan(2));
    else if (op == kOpMemberName)
      members_[{words[1], words[2]}].name = string_of(words.subspan(3));
    else if (op == kOpDecorate)
      ids_[words[1]].decorations[words[2]] = words.size() > 3 ? words[3] : 0;
    else if (op == kOpMemberDecorate)
      members_[{words[1], words[2]}].decorations[words[3]] = words.size() > 4 ? words[4] : 0;
    else if (op >= kOpTypeVoid && op <= kOpTypeFunction)
      ids_[words[1]].definition = words;
    else if (op == kOpVariable || (op >= kOpSpecConstantTrue && op <= kOpSpecConstant))
      ids_[words[2]].definition = words;
  }

  Words definition(std::uint32_t id) const { return ids_.at(id).definition; }

  std::uint32_t pointee(const Declared& variable) const {
    return definition(variable.definition[1])[3];
  }

  void add_members(std::uint32_t id, std::uint32_t start, const std::string& prefix,
                   std::vector<std::string>& rows) const {
    const Words words = definition(id);
    for (std::uint32_t i = 0; i + 2 < words.size(); ++i) {
      const Declared& member = members_.at({id, i});
      const std::uint32_t offset = start + member.decorations.at(kDecorationOffset);
      const std::string name = prefix + member.name;
      const std::uint32_t of = words[i + 2];
      if (opcode_of(definition(of)) == kOpTypeStruct) {
        add_members(of, offset, name + ".", rows);
      } else {
        rows.push_back("{\"name\": \"" + name + "\", \"type\": \"" + type(of) +
                       "\", \"offset\": " + std::to_string(offset) + "}");
      }
    }
  }

  std::map<std::uint32_t, Declared> ids_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Declared> members_;  // by struct and index
};

// A list in the header and in the JSON, which is built row by row.
struct List {
  std::string cpp;
  std::vector<std::string> json;
};

List bindings(const Module& module) {
  List list;
  for (const auto& [number, variable] : module.numbered(kDecorationBinding)) {
    const Text type = module.binding_type(*variable), access = module.access(*variable);
    const std::string name = "\"" + variable->name + "\"", digits = std::to_string(number);
    list.cpp += "    {" + name + ", " + digits + ", " + type.cpp + ", " + access.cpp + "},\n";
    list.json.push_back("{\"binding\": " + digits + ", \"name\": " + name + ", \"type\": \"" +
                        type.json + "\", \"access\": \"" + access.json + "\"}");
  }
  return list;
}

List constants(const Module& module) {
  List list;
  for (const auto& [id, constant] : module.numbered(kDecorationSpecId)) {
    const Words words = constant->definition;
    const std::uint32_t value =
        opcode_of(words) == kOpSpecConstant ? words[3] : opcode_of(words) == kOpSpecConstantTrue;
    const std::string name = "\"" + constant->name + "\"", digits = std::to_string(id);
    list.cpp += "    {" + name + ", " + digits + "},\n";
    list.json.push_back("{\"id\": " + digits + ", \"name\": " + name + ", \"type\": \"" +
                        module.type(words[1]) + "\", \"default\": " + std::to_string(value) + "}");
  }
  return list;
}

std::string json_array(const char* name, const std::vector<std::string>& rows) {
  std::string text = std::string("      \"") + name + "\": [";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += (i == 0 ? "\n        " : ",\n        ") + rows[i];
  return text + (rows.empty() ? "]" : "\n      ]");
}

// gtao_bent -> kGtaoBent, as in shaders/embed.cmake
std::string variable_name(const std::string& shader) {
  std::string name = "k";
  bool begins = true;
  for (const char letter : shader) {
    if (letter != '_') name += begins ? static_cast<char>(std::toupper(letter)) : letter;
    begins = letter == '_';
  }
  return name;
}

// Adds a shader to the texts of the header and of the JSON.
void describe(const std::filesystem::path& path, std::string& header, std::string& json) {
  std::vector<std::uint32_t> words(std::filesystem::file_size(path) / sizeof(std::uint32_t));
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(words.data()),
            static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
  const Module module(words);
  const std::string shader = path.stem().string(), variable = variable_name(shader);
  const List bound = bindings(module), specialised = constants(module);
  header += "constexpr ShaderBinding " + variable + "Bindings[] = {\n" + bound.cpp + "};\n";
  if (!specialised.cpp.empty())
    header +=
        "constexpr ShaderConstant " + variable + "Constants[] = {\n" + specialised.cpp + "};\n";
  header += "constexpr ShaderInterface " + variable + "Interface{" + variable + "Bindings, " +
            (specialised.cpp.empty() ? "{}" : variable + "Constants") + "};\n";
  json += "    {\n      \"name\": \"" + shader + "\",\n" + json_array("bindings", bound.json) +
          ",\n" + json_array("constants", specialised.json) + ",\n" +
          json_array("parameters", module.parameters()) + "\n    }";
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) throw std::runtime_error("usage: alcove_read_shaders HEADER JSON MODULE...");
  std::string includes = "#pragma once\n", header, json;
  for (const std::filesystem::path path : std::span(argv, argv + argc).subspan(3)) {
    includes += "#include \"spirv/" + path.stem().string() + ".h\"\n";
    json += json.empty() ? "" : ",\n";
    describe(path, header, json);
  }
  std::ofstream to_header(argv[1]), to_json(argv[2]);
  to_header << includes << "namespace alcove::passes {\n" << header << "}\n";
  to_json << "{\n  \"entry_point\": \"main\",\n  \"group_size\": [8, 8, 1],\n  \"shaders\": [\n"
          << json << "\n  ]\n}\n";
  to_header.close();
  to_json.close();
  if (!to_header || !to_json) throw std::runtime_error("the files cannot be written");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "alcove_read_shaders: %s\n", error.what());
  return 1;
}

// A build tool that writes a lookup table of the passes as a C++ array: make_tables NAME FILE. NAME
// is `gtso` or `reflectance`.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tables.h"

namespace alcove::passes {
namespace {

bool write(const char* file, const std::string& name, const std::vector<std::uint32_t>& words) {
  std::ofstream out(file);
  out << "const std::uint32_t " << name << "[" << words.size() << "] = {";
  for (std::size_t i = 0; i < words.size(); ++i)
    out << (i % 8 == 0 ? "\n" : "") << words[i] << "u,";
  out << "\n};\n";
  out.close();
  return !out.fail();
}

}  // namespace
}  // namespace alcove::passes

int main(int argc, char** argv) {
  using namespace alcove::passes;
  const std::string name = argc == 3 ? argv[1] : "";
  bool written = false;
  if (name == "reflectance") written = write(argv[2], "kReflectanceTable", reflectance_table());
  if (name == "gtso") written = write(argv[2], "kGtsoTable", gtso_table());
  if (!written)
    std::fprintf(stderr, "make_tables: no table '%s', or it could not be written\n", name.c_str());
  return written ? 0 : 1;
}

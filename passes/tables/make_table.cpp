// A build tool that writes the table of specular occlusion as a C++ array: make_table FILE.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

#include "gtso_table.h"

int main(int argc, char** argv) {
  const std::vector<std::uint32_t> words = alcove::passes::gtso_table();
  std::ofstream out(argc == 2 ? argv[1] : "");
  out << "const std::uint32_t kGtsoTable[" << words.size() << "] = {";
  for (std::size_t i = 0; i < words.size(); ++i)
    out << (i % 8 == 0 ? "\n" : "") << words[i] << "u,";
  out << "\n};\n";
  out.close();
  if (out.fail()) std::fprintf(stderr, "make_table: the table could not be written\n");
  return out.fail() ? 1 : 0;
}

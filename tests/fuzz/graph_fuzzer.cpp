// Fuzzes the render graph with libFuzzer. The bytes choose a declaration, which may be valid or
// not. An invalid one must be refused with error sentences. A valid one must give a plan that the
// verifier accepts and that can be printed.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "alcove/framegraph/verify.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

void fail(const char* what, const Errors& errors) {
  std::fprintf(stderr, "%s: %s\n", what, to_string(errors).c_str());
  std::abort();
}

Limits limits_of(std::uint8_t choice) {
  Limits limits;
  limits.alias = (choice & 1) == 0;
  if (choice & 4) limits.buffer_image_granularity = 1024;
  if (choice & 8) limits.queue_families[1] = choice & 16 ? 1 : 0;
  if (choice & 32) limits.queue_families[2] = 2;
  return limits;
}

void run(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return;
  const Limits limits = limits_of(bytes[0]);
  RandomOptions options;
  options.queues = (bytes[1] & 1) != 0;
  options.mistakes = (bytes[1] & 2) != 0;
  options.most_passes = 24;
  static Graph graph;
  static Compiler compiler;
  static Plan plan;
  graph.reset();
  if (bytes[1] & 4) graph.reset_histories();
  Dice dice(bytes.subspan(2));
  declare_random(graph, dice, options);
  const GraphDescription& description = graph.description();
  if (const auto compiled = compiler.compile(description, limits, plan); !compiled) {
    if (compiled.error().empty()) fail("refused without a reason", {});
    for (const Error& error : compiled.error())
      if (error.message.empty()) fail("an error without a sentence", compiled.error());
    if (!options.mistakes) fail("a right graph was refused", compiled.error());
    return;
  }
  if (const auto verified = verify(description, limits, plan); !verified)
    fail("a wrong plan", verified.error());
  // Printing takes longer than all before it.
  if ((bytes[1] & 24) != 0) return;
  if (print_text(description, plan).empty() || print_dot(description, plan).empty())
    fail("nothing printed", {});
}

}  // namespace
}  // namespace alcove::framegraph

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alcove::framegraph::run({data, size});
  return 0;
}

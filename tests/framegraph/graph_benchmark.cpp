// Measures the time of declaring and compiling frames. It is a program and not a test.
//
// For each number of passes and each of three shapes (chain: each pass reads what the previous one
// wrote and writes its own texture; random: each pass reads two of the last 32 textures; sizes: as
// random, with textures of differing sizes), it prints the median over many runs, in nanoseconds of
// processor time per pass:
//   setup    declaring a frame that differs from the previous one
//   compile  Compiler::compile with all working memory already allocated
//   steady   declaring the same frame again and finding its plan
//   record   declaring the same frame again and recording it with an executor, on a device whose
//            functions do nothing, which is the usual cost of a frame
// and the number of allocations of a steady frame, counted by replacing operator new.
//
// Then it prints the cost in milliseconds of a frame whose declaration changes, with the ratio of
// the memory peak to the lower bound (the most bytes live at once):
//   all sizes  all textures change their size in each frame
//   one size   one texture changes its size in each frame, as with dynamic resolution
// Finally, it prints how long verify() takes for the plans of `random`.
//
// With --against PROGRAM, it runs this program of another build in turn with its own, three times
// each, and prints the ratios of own to other times for the rows that both print. With --rows, it
// prints only these rows.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "allocation_counter.h"
#include "null_device.h"
#include "random_graph.h"

#ifdef _WIN32
#define popen _popen
#define pclose _pclose
#endif

namespace alcove::framegraph {
namespace {

enum class Shape { chain, random, sizes };

// The two earlier passes whose textures a pass reads.
struct Reads {
  std::uint32_t first = kNone;
  std::uint32_t second = kNone;
};

// Chooses the reads of all passes in advance, because the choice is not part of the measured time.
std::vector<Reads> choose_reads(Shape shape, std::uint32_t passes) {
  std::vector<Reads> reads(passes);
  Dice dice(passes);
  for (std::uint32_t i = 1; i < passes; ++i) {
    const std::uint32_t window = shape == Shape::chain ? 1 : std::min(i, 32u);
    reads[i].first = i - 1 - dice.roll(window);
    reads[i].second = i - 1 - dice.roll(window);
  }
  return reads;
}

void declare(Graph& graph, std::span<const Reads> reads, std::span<Texture> textures,
             std::uint32_t width = 1920, bool sizes = false) {
  graph.reset();
  TextureDesc desc{VK_FORMAT_R16G16B16A16_SFLOAT, Extent::absolute(width, 1080)};
  for (std::size_t i = 0; i < reads.size(); ++i) {
    if (sizes) desc.extent.height = 64 + static_cast<std::uint32_t>(i * 7919 % 1017);
    Texture texture = graph.create_texture("texture", desc);
    PassBuilder pass = graph.add_pass("pass");
    const auto [first, second] = reads[i];
    if (first != kNone) pass.read(textures[first], access::sampled_compute);
    if (second != first) pass.read(textures[second], access::sampled_compute);
    texture = pass.write(texture, access::storage_write_compute, {}, Contents::discard);
    pass.record([texture](RecordContext& context) { (void)context.view(texture); });
    textures[i] = texture;
  }
  graph.output(textures.back());
}

double median(std::vector<double>& values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Returns the processor time of one call, as a mean over many calls, because the clock is coarse.
// Other programs hardly affect processor time.
template <typename Function>
double time_ns(int repeats, Function&& f) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < repeats; ++i) f();
  return static_cast<double>(std::clock() - start) * 1e9 / CLOCKS_PER_SEC / repeats;
}

// Returns the time of declaring and recording an unchanged frame, in nanoseconds.
double time_record(std::span<const Reads> reads, std::span<Texture> textures, bool sizes,
                   int repeats) {
  auto executor = Executor::create(null_device());
  if (!executor) std::abort();
  Graph graph;
  std::vector<double> times;
  for (int run = 0; run < 51; ++run) {
    times.push_back(time_ns(repeats, [&] {
      declare(graph, reads, textures, 1920, sizes);
      if (!executor->record(graph, VK_NULL_HANDLE)) std::abort();
    }));
  }
  return median(times);
}

void measure(Shape shape, std::uint32_t passes) {
  Graph graph;
  const bool sizes = shape == Shape::sizes;
  const std::vector<Reads> reads = choose_reads(shape, passes);
  std::vector<Texture> textures(passes);
  Compiler compiler;
  Plan plan;
  const Limits limits;
  std::vector<double> setup;
  std::vector<double> compile;
  std::vector<double> steady;
  GraphDescription kept;
  const int repeats = static_cast<int>(std::max(1u, 2000u / passes));
  constexpr int kRuns = 51;
  std::size_t steady_allocations = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::uint32_t width = 1920;
    setup.push_back(time_ns(repeats, [&] { declare(graph, reads, textures, ++width, sizes); }));
    declare(graph, reads, textures, 1920, sizes);
    kept = graph.description();
    compile.push_back(time_ns(repeats, [&] {
      if (!compiler.compile(graph.description(), limits, plan)) std::abort();
    }));
    const std::size_t before = allocations();
    steady.push_back(time_ns(repeats, [&] {
      declare(graph, reads, textures, 1920, sizes);
      if (!same_declaration(graph.description(), kept)) std::abort();
    }));
    if (run > 0) steady_allocations += allocations() - before;
    steady.reserve(steady.size() + 1);
  }
  const double count = passes;
  const double setup_ns = median(setup) / count;
  const double compile_ns = median(compile) / count;
  const double record = time_record(reads, textures, sizes, repeats);
  std::printf("%-7s %5u  %8.1f %8.1f %8.1f  %8.1f %8.1f  %6zu   %zu of %u live\n",
              shape == Shape::chain ? "chain"
              : sizes               ? "sizes"
                                    : "random",
              passes, setup_ns, compile_ns, setup_ns + compile_ns, median(steady) / count,
              record / count, steady_allocations, plan.passes.size(), passes);
}

void measure_changes(bool all_sizes, std::uint32_t passes) {
  Graph graph;
  Compiler compiler;
  Plan plan;
  Limits limits;
  std::vector<double> times;
  std::vector<double> ratios;
  constexpr std::uint32_t kFrames = 201;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    times.push_back(time_ns(1,
                            [&] {
                              graph.reset();
                              Dice dice(all_sizes ? frame : 1);
                              declare_sizes(graph, dice, passes, all_sizes ? 0 : 960 + 4 * frame);
                              if (!compiler.compile(graph.description(), limits, plan))
                                std::abort();
                            }) *
                    1e-6);
    ratios.push_back(static_cast<double>(plan.heaps[0].size) /
                     static_cast<double>(plan.heaps[0].lower_bound));
  }
  const auto highest = [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  };
  std::printf("%-9s %5u  %7.3f %7.3f  %7.4f %7.4f\n", all_sizes ? "all sizes" : "one size", passes,
              median(times), highest(times), median(ratios), highest(ratios));
}

void measure_verifier(std::uint32_t passes) {
  Graph graph;
  std::vector<Texture> textures(passes);
  declare(graph, choose_reads(Shape::random, passes), textures);
  const auto plan = compile(graph.description());
  const double time = time_ns(3, [&] {
    if (!plan || !verify(graph.description(), {}, *plan)) std::abort();
  });
  std::printf("%5u passes: %.1f ms\n", passes, time * 1e-6);
}

// The times of one row: setup, compile, both, steady and record.
using Row = std::array<double, 5>;

// Runs a program and adds the rows of its first table to `lowest`, with the lowest time of all
// runs.
bool run(const std::string& program, std::map<std::string, Row>& lowest) {
  std::FILE* const output = popen(program.c_str(), "r");
  if (output == nullptr) return false;
  char line[256];
  while (std::fgets(line, sizeof line, output) != nullptr) {
    char shape[16];
    unsigned passes = 0;
    Row row{};
    if (std::sscanf(line, "%15s %u %lf %lf %lf %lf %lf", shape, &passes, &row[0], &row[1], &row[2],
                    &row[3], &row[4]) != 7 ||
        std::strstr(line, "live") == nullptr)
      continue;
    const auto [there, is_new] =
        lowest.try_emplace(std::string(shape).append(" ").append(std::to_string(passes)), row);
    for (std::size_t i = 0; i < row.size(); ++i)
      there->second[i] = std::min(there->second[i], row[i]);
  }
  return pclose(output) == 0;
}

int compare(const std::string& own, const std::string& other) {
  std::map<std::string, Row> own_rows;
  std::map<std::string, Row> other_rows;
  for (int round = 0; round < 3; ++round) {
    if (!run("'" + other + "'", other_rows) || !run("'" + own + "' --rows", own_rows)) {
      std::fprintf(stderr, "%s did not run: give the framegraph_benchmark of another build\n",
                   other.c_str());
      return 1;
    }
  }
  std::printf("lowest of 3 runs, own and other nanoseconds a pass, and their ratio\n%-12s",
              "frame");
  for (const char* column : {"setup", "compile", "both", "steady", "record"})
    std::printf("  %-22s", column);
  for (const auto& [name, row] : own_rows) {
    const auto found = other_rows.find(name);
    if (found == other_rows.end()) continue;
    std::printf("\n%-12s", name.c_str());
    for (std::size_t i = 0; i < row.size(); ++i)
      std::printf("  %6.1f %6.1f %6.2f  ", row[i], found->second[i], row[i] / found->second[i]);
  }
  std::printf("\n");
  return 0;
}

}  // namespace
}  // namespace alcove::framegraph

int main(int count, char** arguments) {
  using namespace alcove::framegraph;
  if (count == 3 && std::strcmp(arguments[1], "--against") == 0)
    return compare(arguments[0], arguments[2]);
  std::printf("nanoseconds of processor time a pass, median; allocations of all steady frames\n");
  std::printf("shape  passes     setup  compile     both    steady   record  allocs\n");
  for (const Shape shape : {Shape::chain, Shape::random, Shape::sizes})
    for (const std::uint32_t passes : {10u, 100u, 1000u, 5000u}) measure(shape, passes);
  if (count == 2 && std::strcmp(arguments[1], "--rows") == 0) return 0;
  std::printf("\nmilliseconds of processor time of a changed frame, peak over lower bound\n");
  std::printf("frame     passes   median highest   median highest\n");
  for (const bool all_sizes : {true, false})
    for (const std::uint32_t passes : {100u, 200u, 1000u, 4000u})
      measure_changes(all_sizes, passes);
  std::printf("\nverify()\n");
  for (const std::uint32_t passes : {100u, 1000u, 5000u}) measure_verifier(passes);
  return 0;
}

// `alcove`, the scene runner.

#include <exception>
#include <iostream>
#include <new>

#include "commands/commands.h"
#include "options/options.h"

namespace {

using alcove::sample::Command;
using alcove::sample::Options;

tl::expected<void, std::string> run(const Options& options) {
  switch (options.command) {
    case Command::kRender:
      return alcove::sample::run_render(options);
    case Command::kCompare:
      return alcove::sample::run_compare(options);
    case Command::kMotion:
      return alcove::sample::run_motion(options);
    case Command::kAblate:
      return alcove::sample::run_ablate(options);
    case Command::kBench:
      return alcove::sample::run_bench(options);
    case Command::kRecommend:
      return alcove::sample::run_recommend(options);
    case Command::kGraph:
      return alcove::sample::run_graph(options);
    case Command::kView:
      return alcove::sample::run_view(options);
    default:
      return alcove::sample::run_doctor(options);
  }
}

int fail(const std::string& sentence) {
  std::cerr << "alcove: " << sentence << "\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto options = alcove::sample::parse_options(argc, argv);
    if (!options) {
      (options.error().status == 0 ? std::cout : std::cerr) << options.error().text << "\n";
      return options.error().status;
    }
    const auto done = run(*options);
    return done ? 0 : fail(done.error());
  } catch (const std::bad_alloc&) {
    return fail("There is not enough memory for this; try a smaller image or scene.");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}

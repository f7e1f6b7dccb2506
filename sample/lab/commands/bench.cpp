#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/choose_camera.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/trade.h"
#include "evaluate/trade_plot.h"
#include "scene/load_scene.h"
#include "support/printable.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

std::string title_of(const Options& options, const std::string& scene) {
  return fmt::format("{}, {}x{}, frame {}", scene.empty() ? "builtin" : printable(scene),
                     options.view.width, options.view.height, options.view.frames);
}

// Checks that every scene can be loaded and viewed. This is done for all scenes before the first
// one is measured, because measuring takes minutes.
Result<void> check_scenes(const std::vector<std::string>& scenes, const ViewOptions& view) {
  for (const std::string& name : scenes) {
    ALCOVE_TRY(const auto scene, load_scene(name));
    ALCOVE_TRY_VOID(choose_camera(view, scene));
  }
  return {};
}

// Prints a trade and adds it to `report`.
void print_trade(const Trade& trade, const std::string& title, const std::string& clock,
                 Json& report) {
  std::cout << title << "\n" << format_table(trade, clock) << std::flush;
  report["trades"].push_back({{"of", title}, {"points", to_json(trade)}});
}

// Measures the grid of steps and slices, prints it and adds it to `report`.
Result<void> print_grid(const Session& session, const StaticSetup& setup, const Options& options,
                        Json& report) {
  ALCOVE_TRY(const auto rmse, measure_grid(session, setup, truth_options(options)));
  const std::string title = title_of(options, options.scene);
  std::cout << title << "\n" << grid_table(rmse) << std::flush;
  report["grids"].push_back(
      {{"of", title}, {"steps", kGridSteps}, {"slices", kGridSlices}, {"rmse_by_steps", rmse}});
  return {};
}

}  // namespace

Result<void> run_bench(const Options& options) {
  ALCOVE_TRY(const auto folder, OutputFolder::create(options.out));
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector<std::string>{""} : options.scenes;
  ALCOVE_TRY_VOID(check_scenes(scenes, options.view));
  Json report;
  report["frames"] = options.view.frames;
  std::string clock;
  std::vector<std::vector<Measurement>> measured;
  for (const std::string& scene : scenes) {
    Options one = options;
    one.scene = scene;
    ALCOVE_TRY(const auto session, open_session(one));
    report["device"] = session.gpu->device().properties().deviceName;
    const StaticSetup setup = static_setup(one, session.camera);
    if (options.grid) {
      ALCOVE_TRY_VOID(print_grid(session, setup, one, report));
      continue;
    }
    ALCOVE_TRY(auto trade, measure_trade(session, setup, truth_options(one), *one.gpu, one.clock));
    report["time"] = clock = trade.clock_title;
    std::cout << trade.note;
    print_trade(find_pareto_front(trade.points), title_of(options, scene), clock, report);
    measured.push_back(std::move(trade.points));
  }
  if (options.grid) return write_text(options.out / "report.json", report.dump(2) + "\n");
  const Trade overall = find_pareto_front(over_scenes(measured));
  const std::string title = scenes.size() == 1 ? title_of(options, scenes.front())
                                               : fmt::format("mean of {} scenes", scenes.size());
  if (scenes.size() > 1) print_trade(overall, title, clock, report);
  ALCOVE_TRY_VOID(write_text(options.out / "trade.svg", draw_plot(overall, title, clock)));
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "trade.svg and report.json are in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample

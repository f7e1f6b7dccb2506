#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/camera_of.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/measured_trade.h"
#include "evaluate/trade_plot.h"
#include "scene/load_scene.h"
#include "support/printable.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;
using Json = nlohmann::ordered_json;

std::string title_of(const Options& options, const std::string& scene) {
  return (scene.empty() ? "builtin" : printable(scene)) + ", " +
         std::to_string(options.view.width) + "x" + std::to_string(options.view.height) +
         ", frame " + std::to_string(options.view.frames);
}

// That every scene can be read and seen: the last is reached after minutes.
Done check_scenes(const std::vector<std::string>& scenes, const ViewOptions& view) {
  for (const std::string& name : scenes) {
    const auto scene = load_scene(name);
    if (!scene) {
      return Failure(scene.error());
    }
    if (const auto camera = camera_of(view, *scene); !camera) {
      return Failure(camera.error());
    }
  }
  return {};
}

// Tells of a trade on stdout and in `report`.
void tell(const Trade& trade, const std::string& title, const std::string& device, Json& report) {
  std::cout << title << ", on " << device << "\n" << table_of(trade) << std::flush;
  report["trades"].push_back({{"of", title}, {"points", to_json(trade)}});
}

}  // namespace

Done run_bench(const Options& options) {
  const auto folder = OutputFolder::create(options.out);
  if (!folder) {
    return tl::unexpected(folder.error());
  }
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector<std::string>{""} : options.scenes;
  if (auto fine = check_scenes(scenes, options.view); !fine) {
    return fine;
  }
  Json report;
  report["frames"] = options.view.frames;
  std::string device;
  std::vector<std::vector<TradePoint>> measured;
  for (const std::string& scene : scenes) {
    Options one = options;
    one.scene = scene;
    const auto session = open_session(one);
    if (!session) {
      return Failure(session.error());
    }
    auto points = measure_trade(*session, static_setup(one, session->camera), truth_options(one));
    if (!points) {
      return Failure(std::move(points.error()));
    }
    device = session->gpu->device().properties().deviceName;
    report["device"] = device;
    tell(trade_of(*points), title_of(options, scene), device, report);
    measured.push_back(std::move(*points));
  }
  const Trade overall = trade_of(over_scenes(measured));
  const std::string title = scenes.size() == 1
                                ? title_of(options, scenes.front())
                                : "mean of " + std::to_string(scenes.size()) + " scenes";
  if (scenes.size() > 1) {
    tell(overall, title, device, report);
  }
  if (auto written = write_text(options.out / "trade.svg", plot_of(overall, title + ", " + device));
      !written) {
    return written;
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "trade.svg and report.json are in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "evaluate/measured_trade.h"
#include "support/mib.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;

std::string shown(const TradePoint& point) {
  std::ostringstream out;
  out << point.name << std::fixed << ": RMSE " << std::setprecision(4) << point.rmse << " in "
      << std::setprecision(2) << point.gpu_ms << " ms, " << std::setprecision(1) << mib(point.bytes)
      << " MiB";
  return out.str();
}

const TradePoint* chosen_of(const Trade& trade, const Options& options) {
  return options.budget_ms ? nearest_within_ms(trade.points, *options.budget_ms)
                           : fastest_within_rmse(trade.points, *options.tolerance);
}

// There is no choice: what comes nearest to one.
std::string nothing_holds(const Trade& trade, const Options& options) {
  std::ostringstream out;
  if (options.budget_ms) {
    out << "nothing takes at most " << *options.budget_ms << " ms here; the fastest is "
        << shown(trade.points.front());
  } else {
    const TradePoint& nearest = *std::ranges::min_element(trade.points, {}, &TradePoint::rmse);
    out << "nothing errs by at most " << *options.tolerance << " here; the nearest is "
        << shown(nearest);
  }
  return out.str();
}

// The neighbours of the chosen point on the front.
void print_neighbours(const Trade& trade, const TradePoint& chosen) {
  const auto own = static_cast<std::size_t>(&chosen - trade.points.data());
  for (std::size_t i = own; i-- > 0;) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  faster:  " << shown(trade.points[i]) << "\n";
      break;
    }
  }
  for (std::size_t i = own + 1; i < trade.points.size(); ++i) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  nearer:  " << shown(trade.points[i]) << "\n";
      break;
    }
  }
}

}  // namespace

Done run_recommend(const Options& options) {
  const auto session = open_session(options);
  if (!session) {
    return Failure(session.error());
  }
  auto points =
      measure_trade(*session, static_setup(options, session->camera), truth_options(options));
  if (!points) {
    return Failure(std::move(points.error()));
  }
  const Trade trade = trade_of(std::move(*points));
  const TradePoint* chosen = chosen_of(trade, options);
  if (chosen == nullptr) {
    return Failure(nothing_holds(trade, options));
  }
  std::cout << shown(*chosen) << "\n";
  print_neighbours(trade, *chosen);
  std::cout << "RMSE of visibility against ray-traced truth, GPU time of the occlusion passes at "
            << options.view.width << "x" << options.view.height << " on "
            << session->gpu->device().properties().deviceName << "\n"
            << shell_line(render_arguments(
                   options, {session->camera, chosen->settings, std::nullopt, options.view.width,
                             options.view.height, options.view.frames}))
            << "\n";
  return {};
}

}  // namespace alcove::sample

#include <fmt/format.h>
#include <algorithm>
#include <iostream>

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
  return fmt::format("{}: RMSE {:.4f} in {:.3f} ms, {:.1f} MiB", point.name, point.rmse,
                     point.time_ms, mib(point.bytes));
}

const TradePoint* chosen_of(const Trade& trade, const Options& options) {
  return options.budget_ms ? least_error_within_ms(trade.points, *options.budget_ms)
                           : fastest_within_rmse(trade.points, *options.tolerance);
}

// The message if no setting is within the budget or tolerance. It names the closest one.
std::string no_choice_message(const Trade& trade, const Options& options) {
  if (options.budget_ms) {
    return fmt::format("no setting takes at most {:g} ms in this view; the fastest is {}",
                       *options.budget_ms, shown(trade.points.front()));
  }
  const TradePoint& nearest = *std::ranges::min_element(trade.points, {}, &TradePoint::rmse);
  return fmt::format(
      "no setting has an error of at most {:g} in this view; the most accurate is {}",
      *options.tolerance, shown(nearest));
}

// Prints the next faster and the next more accurate point of the Pareto front.
void print_neighbours(const Trade& trade, const TradePoint& chosen) {
  const auto own = static_cast<std::size_t>(&chosen - trade.points.data());
  for (std::size_t i = own; i-- > 0;) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  faster:         " << shown(trade.points[i]) << "\n";
      break;
    }
  }
  for (std::size_t i = own + 1; i < trade.points.size(); ++i) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  more accurate:  " << shown(trade.points[i]) << "\n";
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
  auto measured = measure_trade(*session, static_setup(options, session->camera),
                                truth_options(options), options.clock);
  if (!measured) {
    return Failure(std::move(measured.error()));
  }
  const Trade trade = trade_of(std::move(measured->points));
  const TradePoint* chosen = chosen_of(trade, options);
  if (chosen == nullptr) {
    return Failure(no_choice_message(trade, options));
  }
  std::cout << measured->note << shown(*chosen) << "\n";
  print_neighbours(trade, *chosen);
  const Shot shot{session->camera,    chosen->settings,    std::nullopt,
                  options.view.width, options.view.height, options.view.frames};
  std::cout << fmt::format("RMSE of visibility against ray-traced truth; {} at {}x{} on {}\n{}\n",
                           measured->clock_title, options.view.width, options.view.height,
                           session->gpu->device().properties().deviceName,
                           shell_line(render_arguments(options, shot)));
  return {};
}

}  // namespace alcove::sample

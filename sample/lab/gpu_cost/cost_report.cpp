#include "gpu_cost/cost_report.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kXeGtaoHigh = 2;  // index in GpuPart::peers

const GpuPart& part_of(const SettingsCost& cost) {
  return *std::ranges::find(kGpuParts, cost.family, &GpuPart::family);
}

double reference_ms(const GpuPart& part) { return part.peers[kXeGtaoHigh].milliseconds; }

std::string pass_row(const ModelledPass& pass) {
  return fmt::format(
      "    {:20}{:8.3f}  {:14}{:8.0f}{:8.1f}{:7.1f}{:7.1f}{:7.0f}{:7.0f}{:8.0f}{:8.0f}{:8.0f}{:>7} "
      "  {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}\n",
      pass.pass, pass.milliseconds(), pass.limit(), pass.instructions_per_pixel,
      pass.fetches_per_pixel, pass.stores_per_pixel, pass.bytes_per_pixel, pass.vector_registers,
      pass.waves_per_simd, pass.spills > 0 ? pass.spills : pass.scratch_bytes, pass.code_bytes,
      pass.shared_bytes,
      pass.cache_lines_per_load > 0 ? fmt::format("{:.1f}", pass.cache_lines_per_load) : "-",
      pass.alu_ms, pass.texture_ms, pass.shared_ms, pass.bandwidth_ms, pass.latency_ms);
}

std::string wave_rows(const ModelledPass& pass) {
  std::string out = fmt::format(
      "      one wave: {:.0f} instructions, {:.0f} vector ({:.0f} transcendental, {:.0f} select), "
      "{:.0f} scalar, {:.0f} fetches, {:.0f} stores, {:.0f} on shared memory\n",
      pass.wave.instructions, pass.wave.vector_instructions, pass.wave.transcendentals,
      pass.wave.selects, pass.wave.scalar_instructions, pass.wave.loads, pass.wave.stores,
      pass.wave.shared_operations);
  for (const CountedLoop& counted : pass.loops) {
    const passes::cost::CompiledLoop& loop = counted.loop;
    out += fmt::format(
        "      loop {}, depth {}: {} instructions, {} fetches, {} stores, {} on shared memory; "
        "runs {:.1f} times\n",
        loop.index, loop.depth, loop.instructions, loop.loads, loop.stores, loop.shared,
        counted.iterations);
  }
  return out;
}

std::string settings_rows(const SettingsCost& cost, bool loops) {
  std::string out;
  const double reference = reference_ms(part_of(cost));
  for (const ModelledFrame& frame : cost.frames) {
    out +=
        fmt::format("  {}, {} frame: {:.3f} ms, {:.2f} of XeGTAO high\n", cost.label,
                    name_of(frame.state), frame.milliseconds(), frame.milliseconds() / reference);
    for (const ModelledPass& pass : frame.passes) {
      out += pass_row(pass) + (loops ? wave_rows(pass) : "");
    }
  }
  return out;
}

// A line for each choice of settings on `family` that has an output more than another one.
std::string ratio_rows(std::span<const SettingsCost> costs, std::string_view family) {
  std::string rows;
  for (const SettingsCost& cost : costs) {
    if (cost.family != family) {
      continue;
    }
    if (const std::vector<double> ratios = output_ratios(cost, costs); !ratios.empty()) {
      rows += fmt::format("    {:36}{:11.3f}\n", cost.label, fmt::join(ratios, ""));
    }
  }
  if (rows.empty()) {
    return rows;
  }
  std::string heading =
      "  Time of a frame over its time without the output:\n" + std::string(40, ' ');
  for (const ModelledFrame& frame : costs.front().frames) {
    heading += fmt::format("{:>11}", name_of(frame.state));
  }
  return heading + "\n" + rows;
}

Json to_json(const ModelledPass& pass) {
  return {{"pass", pass.pass},
          {"ms", pass.milliseconds()},
          {"limit", pass.limit()},
          {"limits_ms",
           {{"alu", pass.alu_ms},
            {"texture", pass.texture_ms},
            {"shared_memory", pass.shared_ms},
            {"bandwidth", pass.bandwidth_ms},
            {"latency", pass.latency_ms}}},
          {"instructions_per_pixel", pass.instructions_per_pixel},
          {"fetches_per_pixel", pass.fetches_per_pixel},
          {"stores_per_pixel", pass.stores_per_pixel},
          {"bytes_per_pixel", pass.bytes_per_pixel},
          {"cache_lines_per_load", pass.cache_lines_per_load},
          {"vector_registers", pass.vector_registers},
          {"scalar_registers", pass.scalar_registers},
          {"waves_per_simd", pass.waves_per_simd},
          {"spilled_registers", pass.spills},
          {"scratch_bytes", pass.scratch_bytes},
          {"code_bytes", pass.code_bytes},
          {"shared_memory_bytes", pass.shared_bytes},
          {"waves", pass.waves},
          {"wave",
           {{"instructions", pass.wave.instructions},
            {"vector", pass.wave.vector_instructions},
            {"scalar", pass.wave.scalar_instructions},
            {"transcendental", pass.wave.transcendentals},
            {"select", pass.wave.selects},
            {"loads", pass.wave.loads},
            {"stores", pass.wave.stores},
            {"shared_memory", pass.wave.shared_operations}}}};
}

}  // namespace

std::vector<double> output_ratios(const SettingsCost& cost, std::span<const SettingsCost> costs) {
  const auto without = std::ranges::find_if(costs, [&](const SettingsCost& other) {
    return other.family == cost.family && other.label == cost.label_without;
  });
  std::vector<double> ratios;
  if (cost.label_without.empty() || without == costs.end()) {
    return ratios;
  }
  for (const ModelledFrame& frame : cost.frames) {
    const auto same = std::ranges::find(without->frames, frame.state, &ModelledFrame::state);
    ratios.push_back(frame.milliseconds() / same->milliseconds());
  }
  return ratios;
}

std::string table_of(std::span<const SettingsCost> costs, bool loops) {
  std::string out;
  for (const GpuPart& part : kGpuParts) {
    if (std::ranges::find(costs, part.family, &SettingsCost::family) == costs.end()) {
      continue;
    }
    out += fmt::format("{}: {}. Modelled milliseconds;", part.family, part.title);
    for (const PeerTime& peer : part.peers) {
      out += fmt::format("{} {} {:g}", &peer == part.peers.data() ? "" : ",", peer.name,
                         peer.milliseconds);
    }
    out +=
        "; all passes of the paper on a PS4 0.5 (as published)\n"
        "    pass                      ms  limit          instr/px fetches stores  bytes  VGPRs"
        "  waves  spills    code  shared  lines   ALU texture shared bandwidth latency\n";
    for (const SettingsCost& cost : costs) {
      if (cost.family == part.family) {
        out += settings_rows(cost, loops);
      }
    }
    out += ratio_rows(costs, part.family);
  }
  return out;
}

Json to_json(std::span<const SettingsCost> costs) {
  Json parts = Json::array();
  for (const GpuPart& part : kGpuParts) {
    Json settings = Json::array();
    for (const SettingsCost& cost : costs) {
      if (cost.family != part.family) {
        continue;
      }
      Json frames = Json::array();
      const std::vector<double> ratios = output_ratios(cost, costs);
      for (const ModelledFrame& frame : cost.frames) {
        Json passes = Json::array();
        for (const ModelledPass& pass : frame.passes) {
          passes.push_back(to_json(pass));
        }
        frames.push_back({{"frame", name_of(frame.state)},
                          {"ms", frame.milliseconds()},
                          {"of_xegtao_high", frame.milliseconds() / reference_ms(part)},
                          {"passes", std::move(passes)}});
        if (!ratios.empty()) {
          frames.back()["of_time_without_output"] = ratios[frames.size() - 1];
        }
      }
      settings.push_back({{"label", cost.label}, {"frames", std::move(frames)}});
    }
    if (settings.empty()) {
      continue;
    }
    Json peers = Json::object();
    for (const PeerTime& peer : part.peers) {
      peers[std::string(peer.name)] = peer.milliseconds;
    }
    parts.push_back({{"family", part.family},
                     {"part", part.title},
                     {"peers_ms", std::move(peers)},
                     {"settings", std::move(settings)}});
  }
  return parts;
}

}  // namespace alcove::sample

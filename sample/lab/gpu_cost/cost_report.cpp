#include "gpu_cost/cost_report.h"

#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "gpu_cost/xegtao.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

std::string pass_row(const ModelledPass& pass) {
  const ShaderStatistics& shader = pass.statistics;
  return fmt::format(
      "    {:19}{:7.3f}  {:13}{:6.0f}{:6.1f}{:6.1f}{:7.1f}{:7.1f}{:6.0f}{:6.0f}{:7.0f}\n",
      pass.pass, pass.milliseconds(), pass.limit(), pass.instructions_per_pixel,
      pass.fetches_per_pixel, pass.stores_per_pixel, pass.l2_bytes_per_pixel, pass.bytes_per_pixel,
      shader.vector_registers, pass.waves_per_simd,
      shader.spills > 0 ? shader.spills : shader.scratch_bytes);
}

std::string pass_rows(const ModelledFrame& frame) {
  std::string rows;
  for (const ModelledPass& pass : frame.passes) rows += pass_row(pass);
  return rows;
}

// The range of the times under different assumptions, and the time under each.
std::string range_row(const SettingsCost& cost) {
  const auto [least, most] = std::ranges::minmax(cost.assumed_ms);
  std::string out = fmt::format("    moving frame: {:.3f} to {:.3f} ms.", least, most);
  for (std::size_t i = 0; i < kCacheAssumptions.size(); ++i) {
    out += fmt::format("{} {} {:.3f}", i == 0 ? "" : ",", kCacheAssumptions[i].name,
                       cost.assumed_ms[i]);
  }
  return out + "\n";
}

std::string settings_rows(const SettingsCost& cost) {
  std::string out;
  const CostInputs& inputs = cost.settings.inputs;
  const double peer_ms = xegtao_ms(*cost.part, kXeGtaoHigh, inputs.width, inputs.height);
  for (std::size_t i = 0; i < cost.frames.size(); ++i) {
    const ModelledFrame& frame = cost.frames[i];
    const std::string rows = pass_rows(frame);
    std::string states(name_of(frame.state));
    for (; i + 1 < cost.frames.size() && pass_rows(cost.frames[i + 1]) == rows; ++i)
      states += fmt::format(" or {}", name_of(cost.frames[i + 1].state));
    out +=
        fmt::format("  {}, {} frame: {:.3f} ms", cost.settings.label, states, frame.milliseconds());
    if (cost.compiler == kXeGtaoCompiler)
      out += fmt::format(", {:.2f} of {} at this size", frame.milliseconds() / peer_ms,
                         kXeGtaoHigh.name);
    out += "\n" + rows;
  }
  if (!cost.assumed_ms.empty()) out += range_row(cost);
  return out;
}

Json to_json(const ModelledPass& pass) {
  const auto& [alu, texture, shared, l2, memory, latency] = pass.limits_ms;
  const ShaderStatistics& shader = pass.statistics;
  return {{"pass", pass.pass},
          {"ms", pass.milliseconds()},
          {"limit", pass.limit()},
          {"limits_ms",
           {{"alu", alu},
            {"texture", texture},
            {"shared_memory", shared},
            {"l2", l2},
            {"memory", memory},
            {"latency", latency}}},
          {"dispatch_ms", pass.dispatch_ms},
          {"instructions_per_pixel", pass.instructions_per_pixel},
          {"fetches_per_pixel", pass.fetches_per_pixel},
          {"stores_per_pixel", pass.stores_per_pixel},
          {"l2_bytes_per_pixel", pass.l2_bytes_per_pixel},
          {"bytes_per_pixel", pass.bytes_per_pixel},
          {"cache_lines_per_load", pass.cache_lines_per_load},
          {"vector_registers", shader.vector_registers},
          {"scalar_registers", shader.scalar_registers},
          {"waves_per_simd", pass.waves_per_simd},
          {"spilled_registers", shader.spills},
          {"scratch_bytes", shader.scratch_bytes},
          {"code_bytes", shader.code_bytes},
          {"shared_memory_bytes", shader.shared_bytes},
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

Json to_json(const SettingsCost& cost, double peer_ms) {
  Json frames = Json::array();
  for (const ModelledFrame& frame : cost.frames) {
    Json passes = Json::array();
    for (const ModelledPass& pass : frame.passes) passes.push_back(to_json(pass));
    frames.push_back({{"frame", name_of(frame.state)},
                      {"ms", frame.milliseconds()},
                      {"passes", std::move(passes)}});
    if (cost.compiler == kXeGtaoCompiler)
      frames.back()["of_xegtao_high"] = frame.milliseconds() / peer_ms;
  }
  return {{"label", cost.settings.label},
          {"frames", std::move(frames)},
          {"assumed_ms", cost.assumed_ms}};
}

}  // namespace

Result<std::vector<SettingsCost>> model_costs(std::span<const LabelledSettings> settings,
                                              const GpuPart* only, bool range) {
  std::vector<SettingsCost> costs;
  for (const GpuPart& part : kGpuParts) {
    if (only != nullptr && only != &part) continue;
    ALCOVE_TRY(const auto device, create_null_device(part.family));
    for (const LabelledSettings& one : settings) {
      SettingsCost cost{one, &part, device.compiler};
      ALCOVE_TRY(cost.frames, modelled_frames(part, device, one.inputs));
      for (const CacheAssumptions& assumptions : kCacheAssumptions) {
        if (!range) break;
        ALCOVE_TRY(const auto frame,
                   modelled_frame(part, device, one.inputs, FrameState::moving, &assumptions));
        cost.assumed_ms.push_back(frame.milliseconds());
      }
      costs.push_back(std::move(cost));
    }
  }
  return costs;
}

std::string format_table(std::span<const SettingsCost> costs) {
  std::string out;
  for (const GpuPart& part : kGpuParts) {
    const auto first = std::ranges::find(costs, &part, &SettingsCost::part);
    if (first == costs.end()) continue;
    const CostInputs& size = first->settings.inputs;
    out += fmt::format(
        "{}: {}. Modelled milliseconds at {}x{}, compiled by {}.\nOthers, by {}:", part.name,
        part.title, size.width, size.height, first->compiler, kXeGtaoCompiler);
    for (const XeGtao& peer : kXeGtao)
      out += fmt::format(" {} {:.3f},", peer.name, xegtao_ms(part, peer, size.width, size.height));
    out +=
        "\nall passes of the paper on a PS4 0.5 (as published, 1920x1080). Instructions, fetches, "
        "stores,\nand bytes to L2 and to memory are per pixel; --json FILE has more.\n"
        "    pass                    ms  limit         inst fetch store   L2 B  mem B  VGPR waves "
        "spills\n";
    for (const SettingsCost& cost : costs)
      if (cost.part == &part) out += settings_rows(cost);
  }
  return out;
}

Json to_json(std::span<const SettingsCost> costs) {
  Json parts = Json::array();
  for (const GpuPart& part : kGpuParts) {
    Json settings = Json::array();
    Json peers = Json::object();
    std::string compiler;
    for (const SettingsCost& cost : costs) {
      if (cost.part != &part) continue;
      compiler = cost.compiler;
      const CostInputs& size = cost.settings.inputs;
      for (const XeGtao& peer : kXeGtao)
        peers[std::string(peer.name)] = xegtao_ms(part, peer, size.width, size.height);
      settings.push_back(to_json(cost, peers[std::string(kXeGtaoHigh.name)].get<double>()));
    }
    if (!settings.empty()) {
      parts.push_back({{"gpu", part.name},
                       {"part", part.title},
                       {"compiler", compiler},
                       {"peers_ms", std::move(peers)},
                       {"compiler_of_peers", kXeGtaoCompiler},
                       {"settings", std::move(settings)}});
    }
  }
  return parts;
}

}  // namespace alcove::sample

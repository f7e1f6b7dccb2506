#include "gpu_cost/cost_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kXeGtaoHigh = 2;  // its place among the peers

const GpuPart& part_of(const SettingsCost& cost) {
  return *std::ranges::find(kGpuParts, cost.family, &GpuPart::family);
}

double reference_ms(const GpuPart& part) { return part.peers[kXeGtaoHigh].milliseconds; }

void print_pass(std::ostream& out, const ModelledPass& pass) {
  out << "    " << std::left << std::setw(20) << pass.pass << std::right << std::fixed
      << std::setprecision(3) << std::setw(8) << pass.milliseconds() << "  " << std::left
      << std::setw(14) << pass.limit() << std::right << std::setprecision(0) << std::setw(8)
      << pass.instructions_per_pixel << std::setprecision(1) << std::setw(8)
      << pass.fetches_per_pixel << std::setw(7) << pass.stores_per_pixel << std::setw(7)
      << pass.bytes_per_pixel << std::setprecision(0) << std::setw(7) << pass.vector_registers
      << std::setw(7) << pass.waves_per_simd << std::setw(8)
      << (pass.spills > 0 ? pass.spills : pass.scratch_bytes) << std::setw(8) << pass.code_bytes
      << std::setw(8) << pass.shared_bytes << "   " << std::setprecision(3) << pass.alu_ms << " "
      << pass.texture_ms << " " << pass.shared_ms << " " << pass.bandwidth_ms << " "
      << pass.latency_ms << "\n";
}

void print_wave(std::ostream& out, const ModelledPass& pass) {
  out << std::setprecision(0) << "      a wave: " << pass.wave.instructions << " instructions, "
      << pass.wave.vector_instructions << " vector (" << pass.wave.transcendentals
      << " transcendental, " << pass.wave.selects << " select), " << pass.wave.scalar_instructions
      << " scalar, " << pass.wave.loads << " fetches, " << pass.wave.stores << " stores, "
      << pass.wave.shared_operations << " on shared memory\n";
  for (const CountedLoop& counted : pass.loops) {
    const passes::cost::CompiledLoop& loop = counted.loop;
    out << "      loop " << loop.index << ", depth " << loop.depth << ": " << loop.instructions
        << " instructions, " << loop.loads << " fetches, " << loop.stores << " stores, "
        << loop.shared << " on shared memory; runs " << std::setprecision(1) << counted.iterations
        << " times\n";
  }
}

void print_settings(std::ostream& out, const SettingsCost& cost, bool loops) {
  const double reference = reference_ms(part_of(cost));
  for (const ModelledFrame& frame : cost.frames) {
    out << "  " << cost.label << ", " << name_of(frame.state) << " frame: " << std::fixed
        << std::setprecision(3) << frame.milliseconds() << " ms, " << std::setprecision(2)
        << frame.milliseconds() / reference << " of XeGTAO high\n";
    for (const ModelledPass& pass : frame.passes) {
      print_pass(out, pass);
      if (loops) {
        print_wave(out, pass);
      }
    }
  }
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

std::string table_of(std::span<const SettingsCost> costs, bool loops) {
  std::ostringstream out;
  for (const GpuPart& part : kGpuParts) {
    if (std::ranges::find(costs, part.family, &SettingsCost::family) == costs.end()) {
      continue;
    }
    out << part.family << ": " << part.title << ". Modelled milliseconds;";
    for (const PeerTime& peer : part.peers) {
      out << (&peer == part.peers.data() ? " " : ", ") << peer.name << " " << peer.milliseconds;
    }
    out << "; all passes of the paper on a PS4 0.5 (as published)\n"
        << "    pass                      ms  limit          instr/px fetches stores  bytes  VGPRs"
           "  waves  spills    code  shared   ALU texture shared bandwidth latency\n";
    for (const SettingsCost& cost : costs) {
      if (cost.family == part.family) {
        print_settings(out, cost, loops);
      }
    }
  }
  return out.str();
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
      for (const ModelledFrame& frame : cost.frames) {
        Json passes = Json::array();
        for (const ModelledPass& pass : frame.passes) {
          passes.push_back(to_json(pass));
        }
        frames.push_back({{"frame", name_of(frame.state)},
                          {"ms", frame.milliseconds()},
                          {"of_xegtao_high", frame.milliseconds() / reference_ms(part)},
                          {"passes", std::move(passes)}});
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

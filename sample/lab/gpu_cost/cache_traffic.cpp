#include "gpu_cost/cache_traffic.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>
#include <vector>

namespace alcove::sample {
namespace {

// At most this many accesses of waves are simulated: the rows of groups in the middle of a larger
// dispatch stand for all. At 1920x1080 the searches of console, low and medium are simulated
// completely.
constexpr std::size_t kMostAccesses = 110'000;
constexpr std::uint32_t kGroup = 8;  // invocations of a group along x and y; a group is a wave

// A set-associative cache that replaces the line that was used least recently.
class Cache {
 public:
  Cache(double bytes, double line_bytes, std::uint32_t ways)
      : ways_(ways),
        sets_(static_cast<std::uint32_t>(bytes / line_bytes) / ways),
        entries_(std::size_t{sets_} * ways) {}

  struct Result {
    bool hit = false;
    bool writes_back = false;  // a line that was written has been replaced
  };
  Result access(std::uint64_t line, bool store) {
    const std::uint64_t hash = line * 0x9E3779B97F4A7C15ull;
    Entry* set = &entries_[std::size_t{static_cast<std::uint32_t>(hash >> 40u) % sets_} * ways_];
    Entry* oldest = set;
    ++time_;
    for (Entry* entry = set; entry != set + ways_; ++entry) {
      if (entry->line == line) {
        entry->used = time_;
        entry->written = entry->written || store;
        return {true, false};
      }
      oldest = entry->used < oldest->used ? entry : oldest;
    }
    const bool writes_back = oldest->written;
    *oldest = {line, time_, store};
    return {false, writes_back};
  }
  std::ptrdiff_t written_lines() const {
    return std::ranges::count(entries_, true, &Entry::written);
  }

 private:
  struct Entry {
    std::uint64_t line = ~std::uint64_t{0};
    std::uint64_t used = 0;
    bool written = false;
  };
  std::uint32_t ways_;
  std::uint32_t sets_;
  std::vector<Entry> entries_;
  std::uint64_t time_ = 0;
};

// The numbers of the cache lines of an image. A line holds a tile of texels that is square or twice
// as wide as high.
struct ImageLines {
  ImageLines(std::uint64_t number, std::uint32_t texel_bytes, double line_bytes)
      : first(number << 44u) {
    const auto texels = std::bit_width(static_cast<std::uint32_t>(line_bytes) / texel_bytes) - 1;
    height_bits = static_cast<std::uint32_t>(texels) / 2;
    width_bits = static_cast<std::uint32_t>(texels) - height_bits;
  }
  std::uint64_t line(std::uint32_t level, std::int32_t x, std::int32_t y) const {
    return first | std::uint64_t{level} << 40u |
           static_cast<std::uint64_t>(y >> height_bits) << 20u |
           static_cast<std::uint64_t>(x >> width_bits);
  }
  std::uint64_t first;
  std::uint32_t width_bits = 0;
  std::uint32_t height_bits = 0;
};

struct Wave {
  Texel group;
  std::size_t next = 0;  // access
};

class Simulation {
 public:
  Simulation(const GpuPart& part, const DispatchAccesses& dispatch, double held)
      : part_(part),
        dispatch_(dispatch),
        held_(static_cast<std::size_t>(held * part.simds / part.compute_units)),
        units_(static_cast<std::size_t>(part.compute_units)),
        l2_(part.l2_bytes, part.line_bytes, 16) {
    for (Unit& unit : units_) unit.l1 = Cache(part.l1_bytes, part.line_bytes, 4);
    if (part.array_l1_bytes > 0) {
      arrays_.assign(units_.size() / part.array_units,
                     Cache(part.array_l1_bytes, part.line_bytes, 16));
    }
    std::vector<std::string_view> names;
    for (const ImageAccess& access : dispatch.accesses) {
      const auto number = std::ranges::find(names, access.image.name) - names.begin();
      if (number == std::ssize(names)) names.push_back(access.image.name);
      images_.emplace_back(number, access.image.texel_bytes, part.line_bytes);
    }
  }

  CacheTraffic run() {
    const std::size_t row = dispatch_.groups_x * dispatch_.accesses.size();
    const auto rows = static_cast<std::uint32_t>(
        std::clamp<std::size_t>(kMostAccesses / row, 1, dispatch_.groups_y));
    first_row_ = (dispatch_.groups_y - rows) / 2;
    const std::uint32_t waves = dispatch_.groups_x * rows;
    bool busy = true;
    for (std::uint32_t started = 0; started < waves || busy;) {
      started = start_waves(started, waves);
      busy = false;
      for (std::size_t i = 0; i < units_.size(); ++i) {
        advance(i);
        busy = busy || !units_[i].waves.empty();
      }
    }
    const double scale = static_cast<double>(dispatch_.groups_y) / rows;
    CacheTraffic traffic;
    traffic.lines_per_load =
        loads_ == 0 ? 0.0 : static_cast<double>(loaded_lines_) / static_cast<double>(loads_);
    traffic.texture_cycles = scale * std::ranges::max_element(units_, {}, &Unit::cycles)->cycles;
    traffic.l2_bytes = scale * static_cast<double>(l2_lines_) * part_.line_bytes;
    traffic.memory_bytes =
        scale *
        static_cast<double>(memory_lines_ + static_cast<std::uint64_t>(l2_.written_lines())) *
        part_.line_bytes;
    return traffic;
  }

 private:
  struct Unit {
    Cache l1{0x10000, 64, 4};
    std::vector<Wave> waves;
    double cycles = 0;  // of the texture unit
  };

  // Hands the next waves to the compute units in turn, until all are full.
  std::uint32_t start_waves(std::uint32_t started, std::uint32_t waves) {
    for (bool filled = true; filled && started < waves;) {
      filled = false;
      for (Unit& unit : units_) {
        if (unit.waves.size() < held_ && started < waves) {
          unit.waves.push_back(
              {{static_cast<std::int32_t>(started % dispatch_.groups_x),
                static_cast<std::int32_t>(first_row_ + started / dispatch_.groups_x)}});
          ++started;
          filled = true;
        }
      }
    }
    return started;
  }

  // Each wave of a compute unit executes its next access with a probability of one half, so that
  // waves drift apart.
  void advance(std::size_t index) {
    Unit& unit = units_[index];
    for (std::size_t i = 0; i < unit.waves.size();) {
      random_ = random_ * 6364136223846793005u + 1442695040888963407u;
      if ((random_ >> 63u) != 0) {
        ++i;
      } else if (unit.waves[i].next == dispatch_.accesses.size()) {
        unit.waves[i] = unit.waves.back();
        unit.waves.pop_back();
      } else {
        execute(index, unit.waves[i]);
        ++unit.waves[i++].next;
      }
    }
  }

  // Sets lines_ to the distinct cache lines that the lanes of a wave touch.
  void find_lines(const Wave& wave) {
    const ImageAccess& access = dispatch_.accesses[wave.next];
    const auto side = static_cast<std::int32_t>(access.footprint);
    lines_.clear();
    for (std::uint32_t lane = 0; lane < kGroup * kGroup; ++lane) {
      const Texel texel = access.texel({wave.group.x * static_cast<std::int32_t>(kGroup) +
                                            static_cast<std::int32_t>(lane % kGroup),
                                        wave.group.y * static_cast<std::int32_t>(kGroup) +
                                            static_cast<std::int32_t>(lane / kGroup)});
      const auto last_x =
          std::max(static_cast<std::int32_t>(access.image.width >> texel.level), 1) - 1;
      const auto last_y =
          std::max(static_cast<std::int32_t>(access.image.height >> texel.level), 1) - 1;
      for (std::int32_t i = 0; i < side * side; ++i) {
        const std::uint64_t line =
            images_[wave.next].line(texel.level, std::clamp(texel.x + i % side, 0, last_x),
                                    std::clamp(texel.y + i / side, 0, last_y));
        if (lines_.empty() || lines_.back() != line) lines_.push_back(line);
      }
    }
    std::ranges::sort(lines_);
    lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
  }

  void execute(std::size_t index, const Wave& wave) {
    Unit& unit = units_[index];
    find_lines(wave);
    const bool store = dispatch_.accesses[wave.next].image.direction == Direction::write;
    std::size_t misses = 0;
    for (const std::uint64_t line : lines_) {
      if (store) {
        use_l2(line, true);
      } else if (!unit.l1.access(line, false).hit) {
        ++misses;
        if (arrays_.empty() || !arrays_[index / part_.array_units].access(line, false).hit)
          use_l2(line, false);
      }
    }
    if (!store) {
      ++loads_;
      loaded_lines_ += lines_.size();
    }
    // A quarter of a wave's lanes enter the unit in a cycle. It looks up one line a cycle.
    unit.cycles += std::max<double>(kGroup * kGroup / 4.0, static_cast<double>(lines_.size()));
  }

  void use_l2(std::uint64_t line, bool store) {
    const Cache::Result result = l2_.access(line, store);
    ++l2_lines_;
    memory_lines_ += (!result.hit && !store ? 1u : 0u) + (result.writes_back ? 1u : 0u);
  }

  const GpuPart& part_;
  const DispatchAccesses& dispatch_;
  std::size_t held_;             // waves of a compute unit
  std::uint32_t first_row_ = 0;  // of the groups that are simulated
  std::vector<Unit> units_;
  std::vector<Cache> arrays_;  // RDNA2's L1 of each shader array
  Cache l2_;
  std::vector<ImageLines> images_;  // of each access
  std::vector<std::uint64_t> lines_;
  std::uint64_t random_ = 1;
  std::uint64_t loads_ = 0;
  std::uint64_t loaded_lines_ = 0;
  std::uint64_t l2_lines_ = 0;
  std::uint64_t memory_lines_ = 0;
};

}  // namespace

CacheTraffic cache_traffic(const GpuPart& part, const DispatchAccesses& dispatch,
                           double waves_per_simd) {
  return Simulation(part, dispatch, std::max(waves_per_simd, 1.0)).run();
}

double l2_ms(const GpuPart& part, const CacheTraffic& traffic) {
  return traffic.l2_bytes / (part.l2_bytes_per_cycle * part.hertz) * 1e3;
}

double memory_ms(const GpuPart& part, const CacheTraffic& traffic) {
  return traffic.memory_bytes / part.bytes_per_second * 1e3;
}

double cache_ms(const GpuPart& part, const CacheTraffic& traffic) {
  return std::max(
      {traffic.texture_cycles / part.hertz * 1e3, l2_ms(part, traffic), memory_ms(part, traffic)});
}

}  // namespace alcove::sample

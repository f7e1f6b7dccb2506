#include "gpu_cost/cache_traffic.h"

#include <bit>
#include <cstdint>
#include <vector>

namespace alcove::sample {
namespace {

// At most this many accesses of waves are simulated: the rows of groups in the middle of a larger
// dispatch stand for all. At 1920x1080 the searches of console, low and medium are simulated
// completely.
constexpr std::size_t kMostAccesses = 110'000;
constexpr std::int32_t kGroup = 8;  // invocations of a group along x and y; a group is a wave

// A set-associative cache that replaces the line that was used least recently. Its number of sets
// is a power of two.
class Cache {
 public:
  Cache(double bytes, double line_bytes, std::uint32_t ways, bool hashed = true)
      : ways_(ways),
        sets_(static_cast<std::uint32_t>(bytes / line_bytes) / ways),
        hashed_(hashed),
        lines_(std::size_t{sets_} * ways, ~0u),
        uses_(lines_.size()) {}

  struct Result {
    bool hit = false;
    bool writes_back = false;  // a line that was written has been replaced
  };
  Result access(std::uint32_t line, bool store) {
    const auto key =
        static_cast<std::uint32_t>(hashed_ ? line * 0x9E3779B97F4A7C15ull >> 40u : line);
    const std::size_t set = std::size_t{key & (sets_ - 1)} * ways_;
    std::uint32_t* const uses = &uses_[set];
    const std::uint32_t* const lines = &lines_[set];
    std::uint32_t at = 0;
    while (at < ways_ && lines[at] != line) ++at;
    const bool hit = at < ways_;
    if (!hit) at = static_cast<std::uint32_t>(std::min_element(uses, uses + ways_) - uses);
    const std::uint32_t written = uses[at] & 1u;
    lines_[set + at] = line;
    uses[at] = ++time_ << 1u | (store ? 1u : hit ? written : 0u);
    return {hit, !hit && written != 0};
  }
  std::ptrdiff_t written_lines() const {
    return std::ranges::count_if(uses_, [](std::uint32_t use) { return (use & 1u) != 0; });
  }

 private:
  std::uint32_t ways_;
  std::uint32_t sets_;
  bool hashed_;
  std::vector<std::uint32_t> lines_;
  std::vector<std::uint32_t> uses_;  // twice the time of the last use, plus 1 if it was written
  std::uint32_t time_ = 0;
};

// A set of numbers that is cleared and filled in linear time.
class NumberSet {
 public:
  void clear() {
    numbers_.clear();
    ++round_;
  }
  void insert(std::uint32_t number) {
    std::size_t slot = number * 2654435769u >> 22u;
    for (; slots_[slot].round == round_; slot = (slot + 1) % slots_.size())
      if (slots_[slot].number == number) return;
    slots_[slot] = {number, round_};
    numbers_.push_back(number);
  }
  const std::vector<std::uint32_t>& numbers() const { return numbers_; }

 private:
  struct Slot {
    std::uint32_t number = 0;
    std::uint32_t round = 0;
  };
  std::array<Slot, 1024> slots_{};
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> numbers_;
};

// The cache lines of an image. A line holds a tile of texels that is square or twice as wide as
// high.
class ImageLines {
 public:
  ImageLines(std::uint32_t number, const PassImage& image, double line_bytes, bool flat)
      : first_(number << 28u), width_(image.width), height_(image.height) {
    const int texels =
        std::bit_width(static_cast<std::uint32_t>(line_bytes) / image.texel_bytes) - 1;
    height_bits_ = texels / 2 - (flat ? 1 : 0);
    width_bits_ = texels - height_bits_;
  }
  // Adds the lines of the texels from `first` to `last`, which are clamped to the image.
  void add_lines(const Texel& first, const Texel& last, NumberSet& lines) const {
    const auto tile = [level = first.level](std::int32_t at, std::uint32_t size, int bits) {
      return static_cast<std::uint32_t>(
          std::clamp(at, 0, std::max(static_cast<std::int32_t>(size >> level), 1) - 1) >> bits);
    };
    const std::uint32_t pitch = (width_ >> width_bits_) + 1;
    const std::uint32_t left = tile(first.x, width_, width_bits_);
    const std::uint32_t right = tile(last.x, width_, width_bits_);
    const std::uint32_t bottom = tile(last.y, height_, height_bits_);
    for (std::uint32_t y = tile(first.y, height_, height_bits_); y <= bottom; ++y)
      for (std::uint32_t x = left; x <= right; ++x)
        lines.insert(first_ + (first.level << 24u) + y * pitch + x);
  }

 private:
  std::uint32_t first_;
  std::uint32_t width_;
  std::uint32_t height_;
  int width_bits_ = 0;
  int height_bits_ = 0;
};

struct Wave {
  Texel group;
  std::size_t next = 0;  // access
};

class Simulation {
 public:
  Simulation(const GpuPart& part, const DispatchAccesses& dispatch, double held,
             const CacheAssumptions& assumptions)
      : part_(part),
        dispatch_(dispatch),
        line_bytes_(part.line_bytes * assumptions.fetched_part),
        l2_bytes_per_cycle_(part.l2_bytes_per_cycle * assumptions.l2_width),
        accesses_in_a_row_(assumptions.accesses_in_a_row),
        held_(static_cast<std::size_t>(held * part.simds / part.compute_units)),
        units_(static_cast<std::size_t>(part.compute_units),
               {Cache(part.l1_bytes, line_bytes_, 4), {}}),
        l2_(part.l2_bytes, line_bytes_, 16, assumptions.hashed_sets) {
    if (part.array_l1_bytes > 0) {
      arrays_.assign(units_.size() / part.array_units, Cache(part.array_l1_bytes, line_bytes_, 16));
    }
    std::vector<std::string_view> names;
    for (const ImageAccess& access : dispatch.accesses) {
      const auto number =
          static_cast<std::uint32_t>(std::ranges::find(names, access.image.name) - names.begin());
      if (number == names.size()) {
        names.push_back(access.image.name);
        image_bytes_ += 1.0 * access.image.width * access.image.height * access.image.texel_bytes;
      }
      images_.emplace_back(number, access.image, line_bytes_,
                           assumptions.flat_tiles && access.image.texel_bytes == 8);
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
    traffic.l2_bytes = scale * static_cast<double>(l2_lines_) * line_bytes_;
    traffic.memory_bytes =
        scale *
        static_cast<double>(memory_lines_ + static_cast<std::uint64_t>(l2_.written_lines())) *
        line_bytes_;
    const double texture_cycles = std::ranges::max_element(units_, {}, &Unit::cycles)->cycles;
    traffic.texture_ms = scale * texture_cycles / part_.hertz * 1e3;
    traffic.l2_ms = traffic.l2_bytes / (l2_bytes_per_cycle_ * part_.hertz) * 1e3;
    traffic.memory_ms = traffic.memory_bytes / part_.bytes_per_second * 1e3;
    if (part_.last_level_bytes > 0) {
      const double missed = 1.0 - std::min(1.0, part_.last_level_bytes / image_bytes_);
      traffic.memory_ms = std::max(missed * traffic.memory_ms,
                                   traffic.memory_bytes / part_.last_level_bytes_per_second * 1e3);
    }
    return traffic;
  }

 private:
  struct Unit {
    Cache l1;
    std::vector<Wave> waves;
    double cycles = 0;  // of the texture unit
  };

  static Texel texel(std::uint32_t x, std::uint32_t y) {
    return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
  }

  // Hands the next waves to the compute units in turn, until all are full.
  std::uint32_t start_waves(std::uint32_t started, std::uint32_t waves) {
    for (bool filled = true; filled && started < waves;) {
      filled = false;
      for (Unit& unit : units_) {
        if (unit.waves.size() < held_ && started < waves) {
          const std::uint32_t x = started % dispatch_.groups_x;
          const std::uint32_t y = first_row_ + started / dispatch_.groups_x;
          const std::uint32_t columns = dispatch_.strip_columns;
          unit.waves.push_back({columns == 0
                                    ? texel(x, y)
                                    : texel(y % columns, y / columns * dispatch_.groups_x + x)});
          ++started;
          filled = true;
        }
      }
    }
    return started;
  }

  // Each wave of a compute unit executes its next accesses with a probability of one half, so that
  // waves drift apart.
  void advance(std::size_t index) {
    Unit& unit = units_[index];
    for (std::size_t i = 0; i < unit.waves.size();) {
      random_ = random_ * 6364136223846793005u + 1442695040888963407u;
      Wave& wave = unit.waves[i];
      if ((random_ >> 63u) != 0) {
        ++i;
      } else if (wave.next == dispatch_.accesses.size()) {
        wave = unit.waves.back();
        unit.waves.pop_back();
      } else {
        const std::size_t end = std::min(wave.next + accesses_in_a_row_, dispatch_.accesses.size());
        for (; wave.next < end; ++wave.next) execute(index, wave);
        ++i;
      }
    }
  }

  // Sets lines_ to the cache lines that the lanes of a wave touch.
  void find_lines(const Wave& wave) {
    const ImageAccess& access = dispatch_.accesses[wave.next];
    lines_.clear();
    const auto texel = [&](std::int32_t lane) {
      return access.texel(
          {wave.group.x * kGroup + lane % kGroup, wave.group.y * kGroup + lane / kGroup});
    };
    const auto side = static_cast<std::int32_t>(access.footprint) - 1;
    if (access.dense) {
      const Texel last = texel(kGroup * kGroup - 1);
      images_[wave.next].add_lines(texel(0), {last.x + side, last.y + side, last.level}, lines_);
      return;
    }
    for (std::int32_t lane = 0; lane < kGroup * kGroup; ++lane) {
      const Texel first = texel(lane);
      images_[wave.next].add_lines(first, {first.x + side, first.y + side, first.level}, lines_);
    }
  }

  void execute(std::size_t index, const Wave& wave) {
    Unit& unit = units_[index];
    find_lines(wave);
    const bool store = dispatch_.accesses[wave.next].image.direction == Direction::write;
    const auto reaches_l2 = [&](std::uint32_t line) {
      return store ||
             (!unit.l1.access(line, false).hit &&
              (arrays_.empty() || !arrays_[index / part_.array_units].access(line, false).hit));
    };
    for (const std::uint32_t line : lines_.numbers())
      if (reaches_l2(line)) use_l2(line, store);
    const std::size_t lines = lines_.numbers().size();
    if (!store) {
      ++loads_;
      loaded_lines_ += lines;
    }
    // A quarter of a wave's lanes enter the unit in a cycle. It looks up one line a cycle.
    unit.cycles += std::max<double>(kGroup * kGroup / 4.0, static_cast<double>(lines));
  }

  void use_l2(std::uint32_t line, bool store) {
    const Cache::Result result = l2_.access(line, store);
    ++l2_lines_;
    memory_lines_ += (!result.hit && !store ? 1u : 0u) + (result.writes_back ? 1u : 0u);
  }

  const GpuPart& part_;
  const DispatchAccesses& dispatch_;
  double line_bytes_;
  double l2_bytes_per_cycle_;
  std::size_t accesses_in_a_row_;
  std::size_t held_;             // waves of a compute unit
  std::uint32_t first_row_ = 0;  // of the groups that are simulated
  std::vector<Unit> units_;
  std::vector<Cache> arrays_;  // RDNA's L1 of each shader array
  Cache l2_;
  std::vector<ImageLines> images_;  // of each access
  double image_bytes_ = 0;          // of all images
  NumberSet lines_;
  std::uint64_t random_ = 1;
  std::uint64_t loads_ = 0;
  std::uint64_t loaded_lines_ = 0;
  std::uint64_t l2_lines_ = 0;
  std::uint64_t memory_lines_ = 0;
};

}  // namespace

CacheTraffic cache_traffic(const GpuPart& part, const DispatchAccesses& dispatch,
                           double waves_per_simd, const CacheAssumptions& assumptions) {
  return Simulation(part, dispatch, std::max(waves_per_simd * assumptions.waves, 1.0), assumptions)
      .run();
}

}  // namespace alcove::sample

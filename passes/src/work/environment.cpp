#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "alcove/passes/work.h"
#include "environment_parameters.h"
#include "maths/environment_map.h"
#include "maths/spherical_harmonics.h"
#include "work/check_inputs.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Range;
using framegraph::Texture;

namespace {

constexpr std::uint32_t kHarmonicsSize = 64;  // width of the mip that is projected, in texels
constexpr float kMostReads = 16.0f;           // per axis of a texel, if the source is large
constexpr std::uint32_t kMostSamples = 4096;  // per lobe

tl::expected<void, Error> check(const WorkList& list, Texture equirectangular,
                                const EnvironmentSettings& settings) {
  const auto refuse = [](const char* what, std::uint32_t given, const std::string& wanted) {
    return tl::unexpected(Error{"The environment's " + std::string(what) + " is " +
                                std::to_string(given) + "; it must be " + wanted + "."});
  };
  if (!std::has_single_bit(settings.size) || settings.size < 16 || settings.size > 2048)
    return refuse("size", settings.size, "a power of two from 16 to 2048");
  const auto most = static_cast<std::uint32_t>(std::countr_zero(settings.size)) - 1;
  if (settings.levels < 2 || settings.levels > most) {
    return refuse("number of levels", settings.levels,
                  "2 to " + std::to_string(most) + " at this size");
  }
  if (settings.samples < 1 || settings.samples > kMostSamples)
    return refuse("number of samples", settings.samples, "1 to " + std::to_string(kMostSamples));
  return check_inputs(list, "environment", {{"equirectangular light", equirectangular}});
}

// A dispatch that reads `source` and writes `target_range` of `target`.
struct Step {
  const char* name;
  Shader shader;
  Texture source;
  Range source_range;
  Texture target;
  Range target_range;
  std::uint32_t threads;  // per axis
  maths::EnvironmentParameters parameters;
};

// Adds steps until one fails, and keeps its error.
class Steps {
 public:
  explicit Steps(WorkList& list) : list_(list) {}
  void add(const Step& step) {
    if (error_.message.empty()) {
      const NamedTexture images[] = {{"source_image", step.source, step.source_range},
                                     {"target_image", step.target, step.target_range}};
      auto added = list_.dispatch({.label = step.name,
                                   .shader = step.shader,
                                   .images = images,
                                   .parameters = bytes_of(step.parameters),
                                   .size = {step.threads, step.threads, 1}});
      error_ = added ? Error{} : std::move(added.error());
    }
  }
  Texture create(const char* name, VkFormat format, VkExtent2D size, std::uint32_t mips = 1) {
    return list_.add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, format, size, mips);
  }
  const WorkList& list() const { return list_; }
  const Error& error() const { return error_; }

 private:
  WorkList& list_;
  Error error_;
};

maths::vec2 square(std::uint32_t size) { return maths::vec2(static_cast<float>(size)); }

// Adds the passes that convert the image to an octahedral map in 32-bit floats, with all mips.
Texture add_source(Steps& steps, Texture equirectangular, std::uint32_t size) {
  const auto levels = static_cast<std::uint32_t>(std::bit_width(size));
  const Texture source =
      steps.create("environment", VK_FORMAT_R32G32B32A32_SFLOAT, {size, size}, levels);
  const VkExtent2D given = steps.list().size(equirectangular);
  const maths::vec2 given_px(static_cast<float>(given.width), static_cast<float>(given.height));
  // On average, a texel of the map covers 0.67 * (width of the source / width of the map) columns
  // of the source.
  const float samples =
      std::clamp(std::ceil(0.67f * given_px.x / static_cast<float>(size)), 2.0f, kMostReads);
  steps.add({"environment",
             Shader::environment_map,
             equirectangular,
             {},
             source,
             Range::mip(0),
             size,
             {given_px, static_cast<float>(size), samples}});
  for (std::uint32_t level = 1; level < levels; ++level) {
    const std::uint32_t half = size >> level;
    steps.add({"environment half",
               Shader::environment_half,
               source,
               Range::mip(level - 1),
               source,
               Range::mip(level),
               half,
               {square(2 * half), static_cast<float>(half)}});
  }
  return source;
}

// Returns the number of samples per lobe for a mip level. Each level has a quarter of the texels of
// the level before and wider lobes, and therefore gets four times as many samples.
float samples_of_level(std::uint32_t level, std::uint32_t first) {
  const std::uint32_t more = 2 * (level == 0 ? 0 : level - 1);
  return static_cast<float>(std::min(std::uint64_t{first} << more, std::uint64_t{kMostSamples}));
}

Texture add_map(Steps& steps, Texture source, const EnvironmentSettings& settings) {
  const Texture map = steps.create("environment map", VK_FORMAT_R16G16B16A16_SFLOAT,
                                   {settings.size, settings.size}, settings.levels);
  for (std::uint32_t level = 0; level < settings.levels; ++level) {
    const std::uint32_t size = settings.size >> level;
    steps.add({"environment prefilter",
               Shader::environment_prefilter,
               source,
               {},
               map,
               Range::mip(level),
               size,
               {square(settings.size), static_cast<float>(size),
                samples_of_level(level, settings.samples),
                maths::roughness_of_level(level, settings.levels),
                static_cast<float>(std::bit_width(settings.size))}});
  }
  return map;
}

Texture add_harmonics(Steps& steps, Texture source, std::uint32_t size) {
  const Texture harmonics =
      steps.create("harmonics", VK_FORMAT_R32G32B32A32_SFLOAT, {maths::kHarmonics, 1});
  const std::uint32_t projected = std::min(size, kHarmonicsSize);
  const auto level = static_cast<std::uint32_t>(std::countr_zero(size / projected));
  steps.add({"harmonics",
             Shader::environment_harmonics,
             source,
             Range::mip(level),
             harmonics,
             {},
             8,
             {square(projected), static_cast<float>(projected)}});
  return harmonics;
}

}  // namespace

tl::expected<Environment, Error> describe_environment(WorkList& list, Texture equirectangular,
                                                      const EnvironmentSettings& settings) {
  if (auto good = check(list, equirectangular, settings); !good)
    return tl::unexpected(std::move(good.error()));
  Steps steps(list);
  const Texture source = add_source(steps, equirectangular, settings.size);
  Environment result;
  result.map = add_map(steps, source, settings);
  result.harmonics = add_harmonics(steps, source, settings.size);
  if (!steps.error().message.empty()) return tl::unexpected(steps.error());
  return result;
}

}  // namespace alcove::passes

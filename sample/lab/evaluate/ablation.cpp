#include "evaluate/ablation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alcove::sample {
namespace {

using passes::Estimator;
using passes::OcclusionSettings;

class VariantList {
 public:
  explicit VariantList(const OcclusionSettings& base) : base_(base) {}

  template <typename Change>
  void add(const char* part, const std::string& name, const Change& change) {
    OcclusionSettings settings = base_;
    change(settings);
    if (settings != base_) variants_.push_back({part, name, settings});
  }
  std::vector<Variant> take() { return std::move(variants_); }

 private:
  OcclusionSettings base_;
  std::vector<Variant> variants_;
};

// Selects an estimator, without the falloff that only horizons have.
void use(OcclusionSettings& settings, Estimator estimator) {
  settings.advanced.estimator = estimator;
  if (passes::has_thickness(estimator)) settings.advanced.falloff = 0.0f;
}

void add_estimators(VariantList& list) {
  const char* part = "estimator";
  list.add(part, "horizons, infinitely thick",
           [](OcclusionSettings& s) { use(s, Estimator::horizons); });
  list.add(part, "plain bitmask", [](OcclusionSettings& s) {
    use(s, Estimator::bitmask);
    s.hidden_occlusion = 0.0f;
  });
  list.add(part, "bitmask with hidden occlusion",
           [](OcclusionSettings& s) { use(s, Estimator::bitmask); });
  list.add(part, "connected samples", [](OcclusionSettings& s) { use(s, Estimator::connected); });
}

void add_occluders(VariantList& list, const OcclusionSettings& base) {
  if (!passes::has_thickness(base.advanced.estimator)) return;
  const char* part = "occluders";
  list.add(part, "hidden occlusion 0", [](OcclusionSettings& s) { s.hidden_occlusion = 0.0f; });
  list.add(part, "hidden occlusion 1", [](OcclusionSettings& s) { s.hidden_occlusion = 1.0f; });
  list.add(part, "a third as thick", [](OcclusionSettings& s) { s.thickness /= 3.0f; });
  list.add(part, "three times as thick", [](OcclusionSettings& s) { s.thickness *= 3.0f; });
  list.add(part, "thickness from back faces", [](OcclusionSettings& s) {
    s.advanced.thickness_unit = passes::ThicknessUnit::back_faces;
  });
  list.add(part, "two depth layers", [](OcclusionSettings& s) { s.depth_layers = 2; });
}

void add_sampling(VariantList& list) {
  const char* part = "resolution";
  list.add(part, "every pixel traced", [](OcclusionSettings& s) { s.tile_size = 1; });
  list.add(part, "one in 2x2", [](OcclusionSettings& s) { s.tile_size = 2; });
  list.add(part, "one in 4x4", [](OcclusionSettings& s) { s.tile_size = 4; });
  // This variant traces one of 2x2 pixels with four times the slices, so that the image has as many
  // slices as if every pixel were traced.
  list.add(part, "one in 2x2, 4 times the slices", [](OcclusionSettings& s) {
    s.tile_size = 2;
    s.slices = std::min(s.slices * 4, 64u);
  });
  part = "work";
  list.add(part, "half the steps",
           [](OcclusionSettings& s) { s.steps = std::max(s.steps / 2, 2u); });
  list.add(part, "twice the steps",
           [](OcclusionSettings& s) { s.steps = std::min(s.steps * 2, 64u); });
  list.add(part, "twice the slices",
           [](OcclusionSettings& s) { s.slices = std::min(s.slices * 2, 64u); });
  part = "snap_to_texels";
  list.add(part, "samples at texel centres",
           [](OcclusionSettings& s) { s.advanced.snap_to_texels = true; });
  list.add(part, "samples between texels",
           [](OcclusionSettings& s) { s.advanced.snap_to_texels = false; });
  part = "border";
  list.add(part, "surfaces are extrapolated",
           [](OcclusionSettings& s) { s.advanced.extrapolation = true; });
  list.add(part, "surfaces end", [](OcclusionSettings& s) { s.advanced.extrapolation = false; });
  part = "unobserved";
  list.add(part, "excluded", [](OcclusionSettings& s) { s.advanced.unobserved = true; });
  list.add(part, "open", [](OcclusionSettings& s) { s.advanced.unobserved = false; });
}

void add_reconstruction(VariantList& list, const OcclusionSettings& base) {
  const char* part = "filter";
  list.add(part, "none", [](OcclusionSettings& s) { s.advanced.filter_radius = 0; });
  // With a history only the first two frames use a filter radius above 1.
  if (base.history_frames == 0) {
    list.add(part, "radius of 1 tile", [](OcclusionSettings& s) { s.advanced.filter_radius = 1; });
    list.add(part, "radius of 3 tiles", [](OcclusionSettings& s) { s.advanced.filter_radius = 3; });
  }
  part = "history";
  list.add(part, "none", [](OcclusionSettings& s) { s.history_frames = 0; });
  list.add(part, "8 frames", [](OcclusionSettings& s) { s.history_frames = 8; });
  list.add(part, "none, and no filter", [](OcclusionSettings& s) {
    s.history_frames = 0;
    s.advanced.filter_radius = 0;
  });
}

// The distance of a camera from its target, relative to that of the given camera, at which a narrow
// perspective serves as an approximation of an orthographic view.
constexpr float kFarAway = 300.0f;

InvariancePair orthographic_pair(const Camera& camera, std::uint32_t height) {
  const glm::vec3 back = camera.eye_ws - camera.target_ws;
  const float distance = glm::length(back);
  InvariancePair pair{"orthographic, and from far away", camera, camera};
  Camera& flat = pair.first;
  if (!flat.orthographic) {
    flat.orthographic = true;
    flat.ortho_height = 2.0f * distance * std::tan(0.5f * camera.fov_y);
  }
  if (std::isinf(flat.far_plane)) flat.far_plane = 1000.0f * flat.ortho_height;
  Camera& away = pair.second;
  away.orthographic = false;
  away.eye_ws = camera.target_ws + back * kFarAway;
  away.fov_y = 2.0f * std::atan(0.5f * flat.ortho_height / (kFarAway * distance));
  pair.further = (kFarAway - 1.0f) * distance;
  away.near_plane = flat.near_plane + pair.further;
  away.far_plane = flat.far_plane + pair.further;
  // Between the two images, surfaces in front of and behind the target, and near the border, are
  // shifted by some pixels. Only pixels are compared whose depths differ by no more than the size
  // of a pixel.
  pair.tolerance = flat.ortho_height / static_cast<float>(height);
  return pair;
}

}  // namespace

std::vector<Variant> ablation_variants(const OcclusionSettings& base) {
  VariantList list(base);
  add_estimators(list);
  add_occluders(list, base);
  add_sampling(list);
  add_reconstruction(list, base);
  return list.take();
}

std::vector<InvariancePair> invariance_pairs(const Camera& camera, std::uint32_t height) {
  std::vector<InvariancePair> all;
  all.push_back({"reversed depth, and standard depth", camera, camera});
  all.back().first.reversed_z = true;
  all.back().second.reversed_z = false;
  if (!camera.orthographic && !std::isinf(camera.far_plane)) {
    all.push_back({"finite far plane, and infinite far plane", camera, camera});
    all.back().second.far_plane = INFINITY;
  }
  all.push_back({"this size, and twice the size", camera, camera, 2});
  all.push_back(orthographic_pair(camera, height));
  return all;
}

}  // namespace alcove::sample

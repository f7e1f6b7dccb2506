// Tests areas: several views in one image, and guard bands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

constexpr VkExtent2D kSheet{90, 60};
constexpr float kPoison = 0.25f;

// Returns an area without a guard band around it.
AlcoveArea without_band(const AlcoveArea& area) {
  return {area.x + 6, area.y + 2, area.width - 11, area.height - 9};
}

// The place of a view in the sheet of the inputs and in the sheet of the outputs.
struct Placement {
  std::uint32_t x, y;
  std::uint32_t output_x, output_y;
};
constexpr std::array<Placement, 2> kPlacements{{{3, 7, 1, 2}, {45, 20, 41, 5}}};

HostImage part_of(const HostImage& image, const AlcoveArea& area) {
  HostImage part{area.width, area.height, {}, image.channels};
  for (std::size_t y = 0; y < area.height; ++y) {
    const auto begin =
        image.texels.begin() +
        static_cast<std::ptrdiff_t>(((area.y + y) * image.width + area.x) * image.channels);
    part.texels.insert(part.texels.end(), begin,
                       begin + static_cast<std::ptrdiff_t>(area.width * image.channels));
  }
  return part;
}

class CAreas : public CInterface, public testing::WithParamInterface<PresetCase> {
 protected:
  static HostView create_host_view(std::uint32_t width, std::uint32_t height, const Scene& scene) {
    HostView view = draw_view(width, height, scene, 1.5f, GetParam());
    view.id = width;
    view.settings.precision = ALCOVE_PRECISION_FLOAT32;
    return view;
  }

  // Creates an output whose pixels have the value kPoison.
  AlcoveImage create_poisoned(const AlcoveImage& like) {
    if (like.image == VK_NULL_HANDLE) return {};
    const std::size_t channels = like.format == VK_FORMAT_R32_SFLOAT ? 1 : 4;
    const std::vector<float> texels(kSheet.width * kSheet.height * channels, kPoison);
    return engine().make_filled(like.format, kSheet.width, kSheet.height,
                                std::as_bytes(std::span(texels)), like.usage);
  }

  void run_sheet(bool band);
};

// Draws both views into one image, and each into images of its own.
void CAreas::run_sheet(bool band) {
  std::array<HostView, 2> from{create_host_view(37, 45, ball_on_floor()),
                               create_host_view(42, 33, groove(0.8))};
  for (std::uint32_t index = 0; index < kSeriesFrames && !HasFailure(); ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    std::array<AlcoveView, 2> own, shared;
    for (std::size_t i = 0; i < 2; ++i) {
      advance(from[i], index);
      own[i] = create_view(from[i]);
      if (band)
        own[i].info.read_area = {0, 0, own[i].images[ALCOVE_IMAGE_DEPTH].width,
                                 own[i].images[ALCOVE_IMAGE_DEPTH].height};
      if (band) own[i].info.written_area = without_band(own[i].info.read_area);
    }
    const std::vector<HostOutputs> expected = run_views(context(), own, index);
    for (std::size_t i = 0; i < 2; ++i) {
      const Placement& place = kPlacements.at(i);
      shared[i] = own[i];
      shared[i].info.id += 1000;
      shared[i].info.read_area = {place.x, place.y, own[i].images[ALCOVE_IMAGE_DEPTH].width,
                                  own[i].images[ALCOVE_IMAGE_DEPTH].height};
      if (band) shared[i].info.written_area = without_band(shared[i].info.read_area);
      shared[i].info.output_x = place.output_x;
      shared[i].info.output_y = place.output_y;
    }
    for (const InputMember& each : kInputs) {
      if ((from[0].*each.texels).texels.empty()) continue;
      HostImage sheet = placed_in(kSheet, from[0].*each.texels, kPlacements[0].x, kPlacements[0].y);
      place(sheet, from[1].*each.texels, kPlacements[1].x, kPlacements[1].y);
      shared[0].images[each.role] = shared[1].images[each.role] = input(sheet);
    }
    for (const OutputMember& each : kOutputs)
      shared[0].images[each.role] = shared[1].images[each.role] =
          create_poisoned(own[0].images[each.role]);
    const HostOutputs outputs = run_views(context(), shared, index)[0];
    HostOutputs rest = outputs;
    for (std::size_t i = 0; i < 2; ++i) {
      SCOPED_TRACE("view " + std::to_string(i));
      EXPECT_LT(std::ranges::min(expected[i].visibility.texels), 0.95f);
      const AlcoveArea inner = band ? own[i].info.written_area : shared[i].info.read_area;
      const AlcoveArea size{0, 0, inner.width, inner.height};
      const AlcoveArea area{shared[i].info.output_x, shared[i].info.output_y, size.width,
                            size.height};
      for (const OutputMember& each : kOutputs) {
        if ((expected[i].*each.texels).texels.empty()) continue;
        HostImage part = part_of(expected[i].*each.texels, size);
        EXPECT_EQ(part_of(outputs.*each.texels, area).texels, part.texels);
        std::ranges::fill(part.texels, kPoison);
        place(rest.*each.texels, part, area.x, area.y);
      }
    }
    for (const OutputMember& each : kOutputs)
      EXPECT_TRUE(std::ranges::all_of((rest.*each.texels).texels,
                                      [](float texel) { return texel == kPoison; }));
  }
}

TEST_P(CAreas, TwoViewsInOneImageEqualViewsInImagesOfTheirOwn) { run_sheet(false); }

TEST_P(CAreas, TwoViewsWithGuardBandsInOneImageEqualViewsInImagesOfTheirOwn) { run_sheet(true); }

// Without motion the guard band changes nothing but the part that is written.
TEST_P(CAreas, GuardBandGivesTheInnerPartOfALargerPicture) {
  HostView from = create_host_view(37, 45, ball_on_floor());
  for (std::uint32_t index = 0; index < 4; ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    from.static_frames = index;
    std::array<AlcoveView, 2> views{create_view(from), create_view(from)};
    views[1].info.id = 1;
    views[1].info.read_area = {0, 0, 37, 45};
    views[1].info.written_area = without_band(views[1].info.read_area);
    const std::vector<HostOutputs> results = run_views(context(), views, index);
    const HostOutputs &expected = results[0], &outputs = results[1];
    const AlcoveArea& inner = views[1].info.written_area;
    const AlcoveArea corner{0, 0, inner.width, inner.height};
    EXPECT_EQ(part_of(outputs.visibility, corner).texels,
              part_of(expected.visibility, inner).texels);
    if (!outputs.specular.texels.empty()) {
      EXPECT_EQ(part_of(outputs.specular, corner).texels, part_of(expected.specular, inner).texels);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, CAreas,
    testing::Values(
        PresetCase{"Console", ALCOVE_QUALITY_CONSOLE, request_all_outputs},
        PresetCase{"Medium", ALCOVE_QUALITY_MEDIUM, request_all_outputs},
        PresetCase{"High", ALCOVE_QUALITY_HIGH, request_all_outputs},
        PresetCase{"VisibilityAlone", ALCOVE_QUALITY_MEDIUM},
        PresetCase{"WithoutNormals", ALCOVE_QUALITY_LOW, [](HostView& view) { view.normals = {}; }},
        PresetCase{"SpecularByTableWithoutNormals", ALCOVE_QUALITY_MEDIUM,
                   [](HostView& view) {
                     view.settings.specular = ALCOVE_SPECULAR_TABLE;
                     view.settings.bent_normal = true;
                     view.normals = {};
                   }},
        PresetCase{"SpecularByTableAlone", ALCOVE_QUALITY_MEDIUM,
                   [](HostView& view) { view.settings.specular = ALCOVE_SPECULAR_TABLE; }},
        PresetCase{"TwoDepthLayers", ALCOVE_QUALITY_LOW,
                   [](HostView& view) { view.settings.depth_layers = 2; }},
        PresetCase{"WithoutHistory", ALCOVE_QUALITY_LOW,
                   [](HostView& view) { view.settings.history_frames = 0; }}),
    [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace alcove::passes

// Tests areas: several views in one image, and guard bands.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

constexpr VkExtent2D kSheet{90, 60};
constexpr float kPoison = 0.25f;

// The area of a view in the sheet, the guard band around what is written, and the position of that
// in the output sheet.
struct Placement {
  AlcoveArea read;
  AlcoveArea written;
  std::uint32_t output_x, output_y;
};

AlcoveArea without_band(const AlcoveArea& area, bool band) {
  return band ? AlcoveArea{area.x + 6, area.y + 2, area.width - 11, area.height - 9} : area;
}

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

struct Case {
  const char* name;
  Quality quality;
  void (*change)(GivenView& given) = [](GivenView&) {};
};
void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

void all_outputs(GivenView& given) {
  given.settings.bent_normal = true;
  given.settings.specular = Specular::slices;
  given.multi_bounce = !given.half_size_outputs;
}

class CAreas : public CInterface, public testing::WithParamInterface<Case> {
 protected:
  std::vector<GivenView> views() const {
    std::vector<GivenView> given{given_view(test_views()[2], 37, 45, ball_on_floor()),
                                 given_view(test_views()[2], 42, 33, groove(0.8))};
    for (GivenView& view : given) {
      const OcclusionSettings defaults = view.settings;
      view.id = view.depth_ndc.width;
      view.settings = quality_settings(GetParam().quality, 1.5f);
      view.settings.precision = defaults.precision;
      view.settings.roughness_channel = defaults.roughness_channel;
      GetParam().change(view);
    }
    return given;
  }

  static void advance(GivenView& view, std::uint32_t index) {
    view.previous_view = view.view;
    if (index == 1 || index == 2) view.view.view_from_world[12] += 0.03f;
    view.static_frames = index < 3 ? 0 : index == 3 ? 1 : 16;
  }

  // The images of both views in one sheet.
  AlcoveImage sheet(const HostImage& a, const HostImage& b,
                    const std::array<Placement, 2>& places) {
    if (a.texels.empty()) return {};
    HostImage image = placed_in(kSheet, a, places[0].read.x, places[0].read.y);
    place(image, b, places[1].read.x, places[1].read.y);
    return input(image);
  }

  // An output whose pixels have the value kPoison.
  AlcoveImage poisoned(const AlcoveImage& like) {
    if (like.image == VK_NULL_HANDLE) return {};
    AlcoveImage image = engine().make_image(like.format, kSheet.width, kSheet.height,
                                            like.usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const bool one = like.format == VK_FORMAT_R32_SFLOAT;
    HostImage contents{kSheet.width, kSheet.height, {}, one ? 1u : 4u};
    contents.texels.assign(std::size_t{kSheet.width} * kSheet.height * contents.channels, kPoison);
    fill_image(image, contents, image.final_state);
    return image;
  }

  void expect_same(const HostImage& sheet_texels, const HostImage& expected, const Placement& place,
                   HostImage& left) {
    if (expected.texels.empty()) return;
    const AlcoveArea area{place.output_x, place.output_y, expected.width, expected.height};
    EXPECT_EQ(part_of(sheet_texels, area).texels, expected.texels);
    HostImage poison = expected;
    std::ranges::fill(poison.texels, kPoison);
    passes::place(left, poison, area.x, area.y);
  }

  void expect_poison(const HostImage& left) {
    EXPECT_TRUE(std::ranges::all_of(left.texels, [](float t) { return t == kPoison; }));
  }

  void run_sheet(bool band);
};

std::array<Placement, 2> placements(const std::vector<GivenView>& given, bool band) {
  const AlcoveArea a{3, 7, given[0].depth_ndc.width, given[0].depth_ndc.height};
  const AlcoveArea b{45, 20, given[1].depth_ndc.width, given[1].depth_ndc.height};
  return {{{a, without_band(a, band), 1, 2}, {b, without_band(b, band), 41, 5}}};
}

// Draws both views into one image, and each into images of its own.
void CAreas::run_sheet(bool band) {
  std::vector<GivenView> given = views();
  const std::array<Placement, 2> places = placements(given, band);
  const Context context = create_context();
  for (std::uint32_t index = 0; index < 5; ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    std::array<AlcoveSettings, 2> settings;
    std::vector<AlcoveView> own, shared;
    for (std::size_t i = 0; i < 2; ++i) {
      advance(given[i], index);
      AlcoveView view = view_of(given[i], settings[i]);
      if (band) {
        view.read_area = {0, 0, view.depth.width, view.depth.height};
        view.written_area = without_band(view.read_area, band);
      }
      own.push_back(view);
    }
    run_frame(*context, own, index);
    const auto both = [&](const HostImage GivenView::*image) {
      return sheet(given[0].*image, given[1].*image, places);
    };
    AlcoveView common{.depth = both(&GivenView::depth_ndc),
                      .normals = both(&GivenView::normals),
                      .motion = both(&GivenView::motion),
                      .roughness = both(&GivenView::roughness),
                      .back_depth = both(&GivenView::back_depth_ndc),
                      .second_depth = both(&GivenView::second_depth_ndc),
                      .albedo = both(&GivenView::albedo),
                      .visibility = poisoned(own[0].visibility),
                      .bent_normal = poisoned(own[0].bent_normal),
                      .specular = poisoned(own[0].specular),
                      .multi_bounce = poisoned(own[0].multi_bounce)};
    std::vector<Results> expected;
    for (std::size_t i = 0; i < 2; ++i) {
      expected.push_back(results_of(own[i]));
      AlcoveView view = own[i];
      view.id += 1000;
      view.depth = common.depth;
      view.normals = common.normals;
      view.motion = common.motion;
      view.roughness = common.roughness;
      view.back_depth = common.back_depth;
      view.second_depth = common.second_depth;
      view.albedo = common.albedo;
      view.visibility = common.visibility;
      view.bent_normal = common.bent_normal;
      view.specular = common.specular;
      view.multi_bounce = common.multi_bounce;
      view.read_area = places[i].read;
      view.written_area = band ? places[i].written : AlcoveArea{};
      view.output_x = places[i].output_x;
      view.output_y = places[i].output_y;
      shared.push_back(view);
    }
    run_frame(*context, shared, index);
    engine().wait();
    const Results found = results_of(shared[0]);
    Results left = found;
    for (std::size_t i = 0; i < 2; ++i) {
      SCOPED_TRACE("view " + std::to_string(i));
      EXPECT_LT(std::ranges::min(expected[i].visibility.texels), 0.95f);
      const std::uint32_t texel = given[i].half_size_outputs ? 2 : 1;
      const auto cropped = [&](const HostImage& image) {
        const AlcoveArea& w = places[i].written;
        return image.texels.empty() || !band ? image
                                             : part_of(image, {0, 0, (w.width + texel - 1) / texel,
                                                               (w.height + texel - 1) / texel});
      };
      expect_same(found.visibility, cropped(expected[i].visibility), places[i], left.visibility);
      expect_same(found.bent_normal, cropped(expected[i].bent_normal), places[i], left.bent_normal);
      expect_same(found.specular, cropped(expected[i].specular), places[i], left.specular);
      expect_same(found.multi_bounce, cropped(expected[i].multi_bounce), places[i],
                  left.multi_bounce);
    }
    expect_poison(left.visibility);
    expect_poison(left.bent_normal);
    expect_poison(left.specular);
    expect_poison(left.multi_bounce);
    if (HasFailure()) break;
  }
}

TEST_P(CAreas, TwoViewsInOneImageEqualViewsInImagesOfTheirOwn) { run_sheet(false); }

TEST_P(CAreas, TwoViewsWithGuardBandsInOneImageEqualViewsInImagesOfTheirOwn) { run_sheet(true); }

// Without motion the guard band changes nothing but the part that is written.
TEST_P(CAreas, GuardBandGivesTheInnerPartOfALargerPicture) {
  const Context context = create_context();
  GivenView given = views()[0];
  given.half_size_outputs = false;
  GivenView whole = given;
  whole.id = 1;
  const AlcoveArea read{0, 0, given.depth_ndc.width, given.depth_ndc.height};
  const AlcoveArea written = without_band(read, true);
  for (std::uint32_t index = 0; index < 4; ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    given.static_frames = whole.static_frames = index;
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    view.read_area = read;
    view.written_area = written;
    run_frame(*context, {&view, 1}, index);
    engine().wait();
    const Results found = results_of(view);
    const Results expected = run_by_c(*context, {&whole, 1}, index)[0];
    const AlcoveArea corner{0, 0, written.width, written.height};
    EXPECT_EQ(part_of(found.visibility, corner).texels,
              part_of(expected.visibility, written).texels);
    if (!found.specular.texels.empty()) {
      EXPECT_EQ(part_of(found.specular, corner).texels, part_of(expected.specular, written).texels);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, CAreas,
    testing::Values(Case{"Console", Quality::console, all_outputs},
                    Case{"Medium", Quality::medium, all_outputs},
                    Case{"High", Quality::high, all_outputs},
                    Case{"VisibilityAlone", Quality::medium},
                    Case{"WithoutNormals", Quality::low,
                         [](GivenView& given) { given.normals = {}; }},
                    Case{"SpecularByTableWithoutNormals", Quality::medium,
                         [](GivenView& given) {
                           given.settings.specular = Specular::table;
                           given.settings.bent_normal = true;
                           given.normals = {};
                         }},
                    Case{"SpecularByConeAlone", Quality::medium,
                         [](GivenView& given) { given.settings.specular = Specular::cone; }},
                    Case{"OutputsOfHalfSize", Quality::console,
                         [](GivenView& given) {
                           given.half_size_outputs = true;
                           all_outputs(given);
                         }},
                    Case{"TwoDepthLayers", Quality::low,
                         [](GivenView& given) { given.settings.depth_layers = 2; }},
                    Case{"WithoutHistory", Quality::low,
                         [](GivenView& given) { given.settings.history_frames = 0; }}),
    [](const auto& of) { return std::string(of.param.name); });

class CAreaErrors : public CInterface {};

TEST_F(CAreaErrors, AreasThatDoNotFitAreNamed) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 21, 14, ball_on_floor());
  AlcoveSettings settings;
  const AlcoveView good = view_of(given, settings);
  struct BadAreas {
    AlcoveArea read, written;
    std::uint32_t x, y;
    const char* message;
  };
  constexpr std::uint32_t kMost = ~0u;
  for (const BadAreas& bad :
       {BadAreas{{0, 0, 22, 14}, {}, 0, 0, "read has 22x14 pixels at (0, 0); it must lie within"},
        {{1, 0, 21, 14}, {}, 0, 0, "read has 21x14 pixels at (1, 0); it must lie within"},
        {{kMost, 0, 2, 14}, {}, 0, 0, "it must lie within depth's 21x14"},
        {{0, 0, kMost, kMost}, {}, 0, 0, "it must lie within depth's 21x14"},
        {{2, 2, 0, 5}, {}, 0, 0, "read has 0x5 pixels at (2, 2); each side must be at least 1"},
        {{2, 2, 0, 0}, {}, 0, 0, "read has 0x0 pixels at (2, 2); each side must be at least 1"},
        {{}, {2, 2, 3, 0}, 0, 0, "written has 3x0 pixels at (2, 2); each side must be at least 1"},
        {{2, 2, 10, 9}, {1, 2, 4, 4}, 0, 0, "it must lie within the area that is read"},
        {{2, 2, 10, 9}, {3, 3, 10, 4}, 0, 0, "it must lie within the area that is read"},
        {{2, 2, 10, 9}, {3, 3, kMost, kMost}, 0, 0, "it must lie within the area that is read"},
        {{2, 2, 10, 9}, {}, 12, 0, "it needs room for 10x9 pixels at (12, 0)"},
        {{2, 2, 10, 9}, {}, 0, kMost, "it needs room for 10x9 pixels at (0, 4294967295)"}}) {
    AlcoveView view = good;
    view.read_area = bad.read;
    view.written_area = bad.written;
    view.output_x = bad.x;
    view.output_y = bad.y;
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
    });
    EXPECT_THAT(alcoveGetMessage(context.get()), HasSubstr(bad.message));
  }
}

}  // namespace
}  // namespace alcove::passes

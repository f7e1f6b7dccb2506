// Tests that alcoveDiagnose reports mistakes in the pixels of depth and normals. Each mistake is
// made on purpose and must be reported by its own sentence alone. Correct inputs of every kind of
// view must not be reported.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "c_interface_fixture.h"
#include "diagnose/inspect.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr std::uint32_t kWidth = 96, kHeight = 64;

// Returns a view_from_world with a rotation that maps no axis of world space to an axis of view
// space, so that a mix-up of the two spaces changes every normal.
Matrix turned() {
  return {0.36f, 0.48f, -0.8f, 0.0f, -0.8f, 0.6f,  0.0f, 0.0f,
          0.48f, 0.64f, 0.6f,  0.0f, 0.3f,  -1.0f, 2.0f, 1.0f};
}

// Returns a floor, a wall and a ball in front of the sky. Neither floor nor wall is parallel to an
// axis of view space.
Scene corner() {
  Surface floor = plane({0.0, -1.5, 0.0}, glm::normalize(glm::dvec3(0.2, 0.9, 0.3)));
  floor.keep = [](const glm::dvec3& p) { return p.z > -9.0; };
  Surface wall = plane({-2.0, 0.0, -3.0}, glm::normalize(glm::dvec3(0.8, -0.2, 0.5)));
  wall.keep = [](const glm::dvec3& p) { return p.z > -9.0 && p.y < 2.5; };
  return {floor, wall, sphere({0.6, -0.5, -4.0}, 1.0)};
}

class CInspect : public CInterface {
 protected:
  static GivenView right_view() {
    GivenView given =
        given_view(perspective_view("", 1.2, 1.8, 0.1, 50.0, false), kWidth, kHeight, corner());
    given.view.view_from_world = turned();
    given.motion = given.roughness = given.albedo = {};
    given.back_depth_ndc = given.second_depth_ndc = {};
    given.settings.steps = 2;
    given.settings.advanced.filter_radius = 0;
    return given;
  }

  // Records six equal frames of a view, to which `change` was applied, and returns the text of
  // alcoveDiagnose.
  std::string said_of(
      const GivenView& given, const std::function<void(AlcoveView&)>& change = [](AlcoveView&) {}) {
    const Context context = create_context();
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    change(view);
    for (std::uint32_t i = 0; i < 6; ++i) {
      record(*context, view, i, false);
    }
    engine().wait();
    return text_of(*context);
  }
  void record(AlcoveContext& context, AlcoveView& view, std::uint32_t index, bool thrown_away) {
    view.previous_camera = view.camera;
    const AlcoveFrame frame{.struct_size = sizeof frame,
                            .index = index,
                            .slot = index % Engine::kSlots,
                            .view_count = 1,
                            .views = &view,
                            .diagnose_pixels = VK_TRUE};
    engine().submit(frame.slot, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(&context, commands, &frame), ALCOVE_SUCCESS)
          << alcoveGetMessage(&context);
      if (thrown_away) {
        throw_away(commands);
      }
    });
  }
  static std::string text_of(AlcoveContext& context) {
    std::string text(alcoveDiagnose(&context, nullptr, 0) + 1, '\0');
    alcoveDiagnose(&context, text.data(), text.size());
    text.pop_back();
    return text;
  }
};

HostImage in_world(const HostImage& normals, const Matrix& view_from_world) {
  HostImage result = normals;
  for (std::size_t i = 0; i < result.texels.size(); i += 4) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.texels[i + axis] = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) {
        result.texels[i + axis] += view_from_world[4 * axis + k] * normals.texels[i + k];
      }
    }
  }
  return result;
}

TEST_F(CInspect, CorrectDepthAndNormalsAreNotReportedAsMistakes) {
  for (const TestView& view : test_views()) {
    for (const NamedScene& scene : gtao_scenes()) {
      SCOPED_TRACE(view.name + ", " + scene.name);
      GivenView given = given_view(view, kWidth, kHeight, scene.scene);
      given.view.view_from_world = turned();
      given.settings.steps = 2;
      given.motion = given.back_depth_ndc = given.second_depth_ndc = {};
      EXPECT_EQ(said_of(given), "");
      given.normals = in_world(given.normals, given.view.view_from_world);
      given.normals_in_view_space = false;
      EXPECT_EQ(said_of(given), "");
    }
  }
  const GivenView given = right_view();
  EXPECT_EQ(said_of(given), "");
  GivenView without = given;
  without.normals = {};
  EXPECT_EQ(said_of(without), "");
}

TEST_F(CInspect, EachMistakeInDepthOrNormalsIsReportedByItsOwnMessageOnly) {
  struct Planted {
    const char* name;
    std::function<void(GivenView&)> plant;
    std::function<void(AlcoveView&)> change;
    Mistake mistake;
  };
  const auto nothing = [](GivenView&) {};
  const auto same = [](AlcoveView&) {};
  const auto of_depth = [](const std::function<float(float)>& f) {
    return [f](GivenView& g) {
      std::ranges::transform(g.depth_ndc.texels, g.depth_ndc.texels.begin(), f);
    };
  };
  const auto of_normals = [](const std::function<float(float, std::size_t)>& f) {
    return [f](GivenView& g) {
      for (std::size_t i = 0; i < g.normals.texels.size(); ++i) {
        g.normals.texels[i] = f(g.normals.texels[i], i % 4);
      }
    };
  };
  const Planted mistakes[] = {
      {"reversed depth", of_depth([](float d) { return 1.0f - d; }), same, Mistake::depth_reversed},
      {"reversed depth without a sky",
       [&](GivenView& g) {
         g = given_view(perspective_view("", 1.2, 1.8, 0.1, 50.0, false), kWidth, kHeight,
                        groove(0.8));
         for (float& d : g.depth_ndc.texels) {
           d = 1.0f - d;
         }
       },
       same, Mistake::depth_reversed},
      {"OpenGL's projection",
       [](GivenView& g) {
         g.view.clip_from_view[10] = -50.1f / 49.9f;
         g.view.clip_from_view[14] = -10.0f / 49.9f;
       },
       same, Mistake::depth_from_minus_one},
      {"a wide angle of view",
       [](GivenView& g) {
         g.view.clip_from_view[0] *= 1.5f;
         g.view.clip_from_view[5] *= 1.5f;
       },
       same, Mistake::field_of_view},
      {"a narrow angle of view",
       [](GivenView& g) {
         g.view.clip_from_view[0] *= 0.7f;
         g.view.clip_from_view[5] *= 0.7f;
       },
       same, Mistake::field_of_view},
      {"view space for world space", [](GivenView& g) { g.normals_in_view_space = false; }, same,
       Mistake::normal_space},
      {"world space for view space",
       [](GivenView& g) { g.normals = in_world(g.normals, g.view.view_from_world); }, same,
       Mistake::normal_space},
      {"packed normals read as they are",
       of_normals([](float n, std::size_t channel) { return channel < 3 ? 0.5f + 0.5f * n : n; }),
       same, Mistake::normal_packing},
      {"signed normals unpacked", nothing,
       [](AlcoveView& v) { v.normal_encoding = ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ; },
       Mistake::normal_packing},
      {"normals of a camera along +Z",
       of_normals([](float n, std::size_t channel) { return channel == 2 ? -n : n; }), same,
       Mistake::normal_forward_z},
      {"y of the projection alone",
       [](GivenView& g) { g.view.clip_from_view[5] = -g.view.clip_from_view[5]; }, same,
       Mistake::flipped_y},
      {"a radius in kilometres", [](GivenView& g) { g.settings.radius = 0.0005f; }, same,
       Mistake::radius_too_small},
      {"a radius in millimetres", [](GivenView& g) { g.settings.radius = 500.0f; }, same,
       Mistake::radius_too_large},
      {"an image of half the size", nothing,
       [this](AlcoveView& v) {
         const HostImage half{kWidth / 2, kHeight / 2,
                              std::vector<float>(kWidth * kHeight / 4, 0.97f), 1};
         const AlcoveImage image = input(half);
         v.depth.image = image.image;
       },
       Mistake::image_too_small},
  };
  for (const Planted& planted : mistakes) {
    SCOPED_TRACE(planted.name);
    GivenView given = right_view();
    planted.plant(given);
    EXPECT_EQ(said_of(given, planted.change),
              "View 0: " + std::string(sentence(planted.mistake)) + "\n");
  }
}

TEST_F(CInspect, FrameSlotReusedBeforeItsFrameHasFinishedIsReported) {
  const Context context = create_context();
  AlcoveSettings settings;
  AlcoveView view = view_of(right_view(), settings);
  for (std::uint32_t i = 0; i < 8; ++i) {
    record(*context, view, i, true);
  }
  engine().wait();
  EXPECT_THAT(text_of(*context), HasSubstr("AlcoveFrame::slot was recorded again before"));
}

TEST_F(CInspect, DiscardedFramesAreNotReportedAsMistakes) {
  const Context context = create_context();
  AlcoveSettings settings;
  AlcoveView view = view_of(right_view(), settings);
  for (std::uint32_t i = 0; i < 8; ++i) {
    record(*context, view, i, true);
    EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS);
  }
  engine().wait();
  EXPECT_EQ(text_of(*context), "");
}

}  // namespace
}  // namespace alcove::passes

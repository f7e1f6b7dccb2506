#include "evaluate/mistakes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/image_io.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The row of depth in terms of itself and the row of w, in each of the four columns.
void change_depth_row(AlcoveCamera& camera, float of_depth, float of_w) {
  for (std::size_t column = 0; column < 4; ++column) {
    float& depth = camera.clip_from_view[4 * column + 2];
    depth = of_depth * depth + of_w * camera.clip_from_view[4 * column + 3];
  }
}

// Applies a change to this frame's and to the last frame's camera.
template <typename Change>
void of_cameras(EngineFrame& frame, const Change& change) {
  change(frame.view.camera);
  change(frame.view.previous_camera);
}

void scale_tangents(AlcoveCamera& camera, float x, float y) {
  for (std::size_t column = 0; column < 4; ++column) {
    camera.clip_from_view[4 * column] *= x;
    camera.clip_from_view[4 * column + 1] *= y;
  }
}

// Another near or far plane of a perspective that is neither reversed nor infinite.
void set_planes(AlcoveCamera& camera, float near_plane, float far_plane) {
  camera.clip_from_view[10] = far_plane / (near_plane - far_plane);
  camera.clip_from_view[14] = near_plane * far_plane / (near_plane - far_plane);
}

double rmse_of(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = double{a.pixels[i]} - double{b.pixels[i]};
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

constexpr float kNear = 0.1f;
constexpr float kFar = 100.0f;

}  // namespace

const std::vector<PlantedMistake>& planted_mistakes() {
  static const std::vector<PlantedMistake> mistakes{
      {"reversed projection, depth not reversed", "reversed_depth", "depth runs the other way",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { change_depth_row(c, -1.0f, 1.0f); });
       }},
      {"OpenGL's projection, depth from -1 to 1", "opengl_depth", "looks like OpenGL's",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { change_depth_row(c, 2.0f, -1.0f); });
       }},
      {"projection of a narrower angle of view", "angle_of_view", "another angle of view",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { scale_tangents(c, 1.5f, 1.5f); });
       }},
      {"near plane ten times too far away", "near_plane", "other near and far planes",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { set_planes(c, 10.0f * kNear, kFar); });
       }},
      {"far plane ten times too near", "far_plane", "other near and far planes",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { set_planes(c, kNear, 0.1f * kFar); });
       }},
      {"normals of world space declared to be of view space", "normal_space", "in the other space",
       [](EngineFrame& f) { f.view.normals_in_view_space = VK_TRUE; }},
      {"signed normals declared to be packed", "normal_packing", "unpacked the other way",
       [](EngineFrame& f) { f.view.normal_encoding = ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ; }},
      {"y of the projection with the wrong sign", "flipped_y", "the other way round",
       [](EngineFrame& f) {
         of_cameras(f, [](AlcoveCamera& c) { scale_tangents(c, 1.0f, -1.0f); });
       }},
      {"previous_camera is always this frame's", "previous_is_this",
       "previous_camera is this frame's camera",
       [](EngineFrame& f) { f.view.previous_camera = f.view.camera; }},
      {"previous_camera is always the first frame's", "previous_is_first",
       "previous_camera is never",
       [](EngineFrame& f) {
         f.view.previous_camera = f.first_camera;
         f.view.previous_camera.view_from_world[12] -= 1.0f;
       }},
      {"jitter in camera and not in previous_camera", "jitter_in_one", "jitter included",
       [](EngineFrame& f) { f.view.previous_camera = f.previous_without_jitter; }},
      {"jitter of depth in neither camera", "jitter_in_none", "",
       [](EngineFrame& f) {
         f.view.camera = f.camera_without_jitter;
         f.view.previous_camera = f.previous_without_jitter;
       }},
      {"AlcoveFrame::index stands still", "index", "AlcoveFrame::index has been",
       [](EngineFrame& f) { f.frame.index = 7; }},
      {"static_frames is not 0 in motion", "static_frames", "static_frames is not 0",
       [](EngineFrame& f) { f.view.static_frames = 16 + f.frame.index; }},
      {"reset_history in every frame", "reset_history", "reset_history is set in every frame",
       [](EngineFrame& f) { f.view.reset_history = VK_TRUE; }},
      {"radius in kilometres", "small_radius", "less than half a pixel",
       [](EngineFrame& f) { f.settings.radius *= 0.001f; }},
      {"radius in millimetres", "large_radius", "more than three times the height",
       [](EngineFrame& f) { f.settings.radius *= 1000.0f; }},
      {"depth image of half the size that is said", "half_size", "is smaller than",
       [](EngineFrame& f) { f.view.depth = f.half_depth; }},
      {"slot recorded again before its frame has finished", "slot",
       "AlcoveFrame::slot was recorded again", nullptr, true},
  };
  return mistakes;
}

tl::expected<MistakeReport, std::string> draw_mistakes(EngineRun& run, const Camera& camera,
                                                       float radius,
                                                       const std::filesystem::path& pictures) {
  Camera plain = camera;
  plain.near_plane = kNear;
  plain.far_plane = kFar;
  plain.reversed_z = false;
  EngineCourse course{.orbit = 0.003f, .jitter = true};
  const auto write = [&](const std::string& name, const Image<float>& picture) {
    return pictures.empty() ? tl::expected<void, std::string>()
                            : write_png(pictures / (name + ".png"), picture);
  };
  const auto right = run.draw(plain, radius, course);
  if (!right) {
    return Failure(right.error());
  }
  if (auto written = write("right", right->visibility); !written) {
    return Failure(std::move(written.error()));
  }
  MistakeReport report{.said_of_right_frames = right->said};
  for (const PlantedMistake& mistake : planted_mistakes()) {
    course.change = mistake.plant;
    course.submit_late = mistake.submit_late;
    auto drawn = run.draw(plain, radius, course);
    if (!drawn) {
      return Failure(std::string(mistake.name) + ": " + drawn.error());
    }
    if (auto written = write(mistake.file, drawn->visibility); !written) {
      return Failure(std::move(written.error()));
    }
    const bool one_line = std::ranges::count(drawn->said, '\n') == 1;
    report.results.push_back({&mistake, rmse_of(drawn->visibility, right->visibility), drawn->said,
                              *mistake.sentence != '\0' && one_line &&
                                  drawn->said.find(mistake.sentence) != std::string::npos});
  }
  return report;
}

}  // namespace alcove::sample

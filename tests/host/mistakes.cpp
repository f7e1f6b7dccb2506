#include "mistakes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using F = EngineFrame;

constexpr float kNear = 0.1f;
constexpr float kFar = 100.0f;

// Applies a change to this frame's and to the last frame's camera.
template <typename Change>
void change_cameras(F& frame, const Change& change) {
  change(frame.view.info.camera);
  change(frame.view.info.previous_camera);
}

// Makes depth `of_depth` times itself plus `of_w` times w, in each of the four columns.
void change_depth_row(F& frame, float of_depth, float of_w) {
  change_cameras(frame, [&](AlcoveCamera& camera) {
    for (std::size_t column = 0; column < 4; ++column) {
      float& depth = camera.clip_from_view[4 * column + 2];
      depth = of_depth * depth + of_w * camera.clip_from_view[4 * column + 3];
    }
  });
}

void scale_tangents(F& frame, float x, float y) {
  change_cameras(frame, [&](AlcoveCamera& camera) {
    for (std::size_t column = 0; column < 4; ++column) {
      camera.clip_from_view[4 * column] *= x;
      camera.clip_from_view[4 * column + 1] *= y;
    }
  });
}

// Another near or far plane of a perspective that is neither reversed nor infinite.
void set_planes(F& frame, float near_plane, float far_plane) {
  change_cameras(frame, [&](AlcoveCamera& camera) {
    camera.clip_from_view[10] = far_plane / (near_plane - far_plane);
    camera.clip_from_view[14] = near_plane * far_plane / (near_plane - far_plane);
  });
}

void scale_jitter(F& frame, float x, float y) {
  const auto scale = [&](AlcoveCamera& camera, const AlcoveCamera& without) {
    for (std::size_t i = 0; i < 2; ++i) {
      const float base = without.clip_from_view[8 + i];
      camera.clip_from_view[8 + i] =
          base + (i == 0 ? x : y) * (camera.clip_from_view[8 + i] - base);
    }
  };
  scale(frame.view.info.camera, frame.other.camera_without_jitter);
  scale(frame.view.info.previous_camera, frame.other_before.camera_without_jitter);
}

template <typename Change>
void change_view_matrices(F& frame, const Change& change) {
  change_cameras(frame, [&](AlcoveCamera& camera) { change(camera.view_from_world); });
}

void transpose(float* matrix, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t k = 0; k < i; ++k) std::swap(matrix[4 * i + k], matrix[4 * k + i]);
}

void invert(float* m) {
  const float x = m[12], y = m[13], z = m[14];
  for (std::size_t i = 0; i < 3; ++i)
    m[12 + i] = -(m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z);
  transpose(m, 3);
}

void multiply_by_view(AlcoveCamera& camera) {
  const AlcoveCamera original = camera;
  for (std::size_t i = 0; i < 16; ++i) {
    camera.clip_from_view[i] = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
      camera.clip_from_view[i] +=
          original.clip_from_view[4 * k + i % 4] * original.view_from_world[4 * (i / 4) + k];
    }
  }
}

// Says that all images have another size than they have.
void set_size(F& frame, std::uint32_t width, std::uint32_t height) {
  for (AlcoveImage* image :
       {&frame.view.images[ALCOVE_IMAGE_DEPTH], &frame.view.images[ALCOVE_IMAGE_NORMALS],
        &frame.view.images[ALCOVE_IMAGE_VISIBILITY]}) {
    image->width = width;
    image->height = height;
  }
}

// Dynamic resolution: the left part of the images is in use, whose width changes from frame to
// frame, and the cameras are those of this part.
void change_size(F& frame) {
  const std::uint32_t whole = frame.view.images[ALCOVE_IMAGE_DEPTH].width;
  const auto crop = [&](AlcoveCamera& camera, std::uint32_t index) {
    const std::uint32_t width = whole - 8 * (index % 3);
    const float scale = static_cast<float>(whole) / static_cast<float>(width);
    for (std::size_t column = 0; column < 4; ++column) {
      float& x = camera.clip_from_view[4 * column];
      x = scale * x + (scale - 1.0f) * camera.clip_from_view[4 * column + 3];
    }
    return width;
  };
  const std::uint32_t index = frame.frame.index;
  if (index >= frame.back) {
    frame.view.info.previous_width = crop(frame.view.info.previous_camera, index - frame.back);
    frame.view.info.previous_height = frame.view.images[ALCOVE_IMAGE_DEPTH].height;
  }
  frame.view.info.largest_width = whole;
  frame.view.info.largest_height = frame.view.images[ALCOVE_IMAGE_DEPTH].height;
  set_size(frame, crop(frame.view.info.camera, index),
           frame.view.images[ALCOVE_IMAGE_DEPTH].height);
}

// The lower three quarters of the images are in use, and the engine says that the upper ones are.
void crop_to_bottom(F& frame) {
  change_cameras(frame, [](AlcoveCamera& camera) {
    for (std::size_t column = 0; column < 4; ++column) {
      float& y = camera.clip_from_view[4 * column + 1];
      y = (4.0f * y - camera.clip_from_view[4 * column + 3]) / 3.0f;
    }
  });
  const AlcoveImage& depth = frame.view.images[ALCOVE_IMAGE_DEPTH];
  set_size(frame, depth.width, depth.height * 3 / 4);
}

void set_normals(F& frame, Other image, AlcoveNormalEncoding encoding, bool in_view_space) {
  frame.view.images[ALCOVE_IMAGE_NORMALS] = frame.other[image];
  frame.view.info.normal_encoding = encoding;
  frame.view.info.normals_in_view_space = in_view_space ? VK_TRUE : VK_FALSE;
}

// Gives motion vectors. With a scale of 1 they are correct.
void set_motion(F& frame, const AlcoveImage& image, float x, float y) {
  frame.view.images[ALCOVE_IMAGE_MOTION] = image;
  frame.view.info.motion_scale[0] = x;
  frame.view.info.motion_scale[1] = y;
}
void scale_motion(F& frame, float x, float y) {
  set_motion(frame, frame.correct.images[ALCOVE_IMAGE_MOTION], x, y);
}

// Gives the two eyes one id.
void give_one_id(F& frame) {
  frame.view.info.id &= ~1u;
  frame.view.info.previous_camera = frame.correct_before.info.camera;
}

void set_depth(F& frame, Other image) {
  frame.view.images[ALCOVE_IMAGE_DEPTH] = frame.other[image];
}

// Returns a change of frames with these arguments.
template <typename... Arguments>
ChangeFrame with(void (*change)(F&, Arguments...), std::type_identity_t<Arguments>... arguments) {
  return [=](F& frame) { change(frame, arguments...); };
}

}  // namespace

const std::vector<PlantedMistake>& planted_mistakes() {
  static const std::vector<PlantedMistake> mistakes{
      // Projection and depth.
      {"reversed projection, other depth", "depth runs the other way",
       with(change_depth_row, -1.0f, 1.0f)},
      {"reversed depth, other projection", "depth runs the other way",
       with(change_depth_row, -1.0f, 1.0f), PlantedMistake::reversed},
      {"OpenGL's projection", "looks like OpenGL's", with(change_depth_row, 2.0f, -1.0f)},
      {"the same, near plane not round", "depth from -1 to 1", with(change_depth_row, 2.0f, -1.0f),
       PlantedMistake::odd_planes},
      {"DEPTH_FROM_MINUS_ONE by mistake", "without that bit", with(change_depth_row, 0.5f, 0.5f)},
      {"narrower angle of view", "another angle of view", with(scale_tangents, 1.5f, 1.5f)},
      {"wider angle of view", "another angle of view", with(scale_tangents, 0.7f, 0.7f)},
      {"five degrees too wide", "another angle of view", with(scale_tangents, 0.906f, 0.906f)},
      {"aspect 13 % wrong", "another angle of view", with(scale_tangents, 1.13f, 1.0f)},
      {"near plane ten times too far", "other near and far planes",
       with(set_planes, 10.0f * kNear, kFar)},
      {"the same, infinite", "the near plane of clip_from_view",
       with(change_depth_row, 10.0f, 0.0f), PlantedMistake::reversed},
      {"far plane too near", "other near and far planes", with(set_planes, kNear, 0.1f * kFar)},
      {"y of the projection negated", "the other way round", with(scale_tangents, 1.0f, -1.0f)},
      {"x of the projection negated", "the other way round", with(scale_tangents, -1.0f, 1.0f)},
      {"view-projection given as projection", "view-projection",
       [](F& f) { change_cameras(f, multiply_by_view); }},
      {"transposed projection", "transposed",
       [](F& f) { change_cameras(f, [](AlcoveCamera& c) { transpose(c.clip_from_view, 4); }); }},
      {"DIRECT3D for a camera along -Z", "without it",
       [](F& f) {
         change_cameras(f, [](AlcoveCamera& c) {
           alcoveConvertCamera(c.clip_from_view, c.view_from_world,
                               ALCOVE_CAMERA_CONVENTION_DIRECT3D, &c);
         });
       }},
      {"linear depth", "not a linear depth", with(set_depth, Other::linear_depth)},
      {"linear depth from 0 to 1", "a linear depth", with(set_depth, Other::linear_to_far_depth)},
      {"16-bit depth in 32 bits", "the steps of another format",
       with(set_depth, Other::coarse_depth)},
      {"depth with a gamma", "a gamma was applied to depth", with(set_depth, Other::gamma_depth)},
      {"filtered depth", "between those of the surfaces", with(set_depth, Other::filtered_depth)},
      {"logarithmic depth", "a logarithmic", with(set_depth, Other::log_depth)},
      {"half-float depth", "half floats", with(set_depth, Other::float16_depth)},
      {"hi-Z maximum", "not look like surfaces", with(set_depth, Other::maximum_depth)},
      {"checkerboard", "not look like surfaces", with(set_depth, Other::chequered_depth)},
      {"another resource", "not look like surfaces", with(set_depth, Other::noise)},
      {"a letterbox", "another angle of view",
       [](F& f) {
         scale_tangents(f, 1.0f, 4.0f / 3.0f);
         f.view.images[ALCOVE_IMAGE_DEPTH] = f.other[Other::letterbox_depth];
       }},
      // The view matrix.
      {"world_from_view instead of view_from_world", "only if it is inverted",
       [](F& f) { change_view_matrices(f, invert); }},
      {"the same, on a straight path", "only if it is inverted",
       [](F& f) { change_view_matrices(f, invert); }, PlantedMistake::straight},
      {"transposed view matrix", "column-major",
       [](F& f) { change_view_matrices(f, [](float* m) { transpose(m, 4); }); }},
      {"view matrix with a scale", "without scale",
       [](F& f) { change_view_matrices(f, [](float* m) { m[0] *= 2.0f; }); }},
      {"view matrix without translation", "has no translation",
       [](F& f) { change_view_matrices(f, [](float* m) { m[12] = m[13] = m[14] = 0.0f; }); }},
      {"view matrix in centimetres", "its unit is wrong",
       [](F& f) {
         change_view_matrices(f, [](float* m) {
           for (std::size_t i = 12; i < 15; ++i) m[i] *= 100.0f;
         });
       }},
      {"an origin of the world that moves", "another way than view_from_world",
       [](F& f) {
         const auto move = [](AlcoveCamera& camera, std::uint32_t index) {
           const float x = 0.3f * std::sin(1.7f * static_cast<float>(index));
           const float y = 0.2f * std::cos(2.3f * static_cast<float>(index));
           for (std::size_t i = 0; i < 3; ++i)
             camera.view_from_world[12 + i] +=
                 x * camera.view_from_world[i] + y * camera.view_from_world[8 + i];
         };
         move(f.view.info.camera, f.frame.index);
         if (f.frame.index > 0) move(f.view.info.previous_camera, f.frame.index - 1);
       }},
      {"camera one frame late", "are not of the same frame",
       [](F& f) {
         f.view.info.camera = f.correct_before.info.camera;
         f.view.info.previous_camera = f.correct_before_that.info.camera;
       }},
      {"depth and normals one frame late", "are not of the same frame",
       [](F& f) {
         f.view.images[ALCOVE_IMAGE_DEPTH] = f.correct_before.images[ALCOVE_IMAGE_DEPTH];
         f.view.images[ALCOVE_IMAGE_NORMALS] = f.correct_before.images[ALCOVE_IMAGE_NORMALS];
       }},
      // Jitter.
      {"jitter in neither camera", "clip_from_view lacks", with(scale_jitter, 0.0f, 0.0f)},
      {"jitter with the other sign", "jitter of camera.clip_from_view differs",
       with(scale_jitter, -1.0f, -1.0f)},
      {"jitter with the other sign of y", "jitter of camera.clip_from_view differs",
       with(scale_jitter, 1.0f, -1.0f)},
      {"the same, standing", "jitter of camera.clip_from_view differs",
       with(scale_jitter, 1.0f, -1.0f), PlantedMistake::standing},
      {"half the jitter, standing", "jitter of camera.clip_from_view differs",
       with(scale_jitter, 0.5f, 0.5f), PlantedMistake::standing},
      {"half the jitter", "jitter of camera.clip_from_view differs",
       with(scale_jitter, 0.5f, 0.5f)},
      {"jitter twice too large", "jitter of camera.clip_from_view differs",
       with(scale_jitter, 2.0f, 2.0f)},
      {"jitter in pixels", "jitter of camera.clip_from_view differs",
       [](F& f) {
         scale_jitter(f, 0.5f * static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].width),
                      0.5f * static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].height));
       }},
      {"jitter in camera and not in previous_camera", "jitter included",
       [](F& f) { f.view.info.previous_camera = f.other_before.camera_without_jitter; }},
      // The frame before.
      {"previous_camera is always this frame's", "previous_camera is this frame's camera",
       [](F& f) { f.view.info.previous_camera = f.view.info.camera; }},
      {"previous_camera is always the first frame's", "previous_camera is not the camera",
       [](F& f) { f.view.info.previous_camera = f.correct_first.info.camera; }},
      {"previous_camera is two frames old", "previous_camera is not the camera",
       [](F& f) { f.view.info.previous_camera = f.correct_before_that.info.camera; }},
      {"previous_camera is inverted", "previous_camera is not the camera",
       [](F& f) { invert(f.view.info.previous_camera.view_from_world); }},
      {"AlcoveFrame::index stands still", "AlcoveFrame::index is that of the last record",
       [](F& f) { f.frame.index = 7; }},
      {"AlcoveFrame::index is that of the slot", "AlcoveFrame::index goes back",
       [](F& f) { f.frame.index %= 2; }},
      {"AlcoveFrame::index counts to 4", "AlcoveFrame::index goes back",
       [](F& f) { f.frame.index %= 4; }},
      {"AlcoveFrame::index counts down", "AlcoveFrame::index goes back",
       [](F& f) { f.frame.index = 1000 - f.frame.index; }},
      {"static_frames is not 0 in motion", "static_frames is not 0",
       [](F& f) { f.view.info.static_frames = 16 + f.frame.index; }},
      {"reset_history in every frame", "reset_history is set again and again",
       [](F& f) { f.view.info.reset_history = VK_TRUE; }},
      {"reset_history in every fourth frame", "reset_history is set again and again",
       [](F& f) { f.view.info.reset_history = f.frame.index % 4 == 0 ? VK_TRUE : VK_FALSE; }},
      {"a view recorded twice in a frame", "AlcoveFrame::index is that of the last record",
       [](F& f) {
         f.records = 2;
         f.frame.diagnose_pixels = VK_FALSE;  // the samples would be written twice
       }},
      {"two eyes with one id", "an AlcoveView::id of its own", give_one_id, PlantedMistake::stereo},
      {"two eyes with one id, on a straight path", "an AlcoveView::id of its own", give_one_id,
       PlantedMistake::straight_stereo},
      {"half_resolution in every second frame", "half_resolution",
       [](F& f) { f.settings.half_resolution = f.frame.index % 2; }},
      {"slot recorded again before its frame has finished", "AlcoveFrame::slot was recorded again",
       nullptr},
      {"a new id in every frame", "More views have a history",
       [](F& f) { f.view.info.id = 1000 + 100 * f.view.info.id + f.frame.index; }},
      // Sizes.
      {"depth image of half the size that is said", "is smaller than",
       [](F& f) { f.view.images[ALCOVE_IMAGE_DEPTH] = f.other.half_depth; }},
      {"a size from before a resize", "only if the whole image is in use",
       [](F& f) {
         set_size(f, f.view.images[ALCOVE_IMAGE_DEPTH].width * 3 / 4,
                  f.view.images[ALCOVE_IMAGE_DEPTH].height * 3 / 4);
       }},
      {"dynamic resolution drawn at the bottom left", "at the bottom of the image", crop_to_bottom},
      {"a size that changes, without largest_width", "each change begins a new history",
       [](F& f) {
         change_size(f);
         f.view.info.largest_width = f.view.info.largest_height = 0;
         f.view.info.previous_width = f.view.info.previous_height = 0;
       }},
      {"a size that changes, without previous_width", "previous_width and previous_height",
       [](F& f) {
         change_size(f);
         f.view.info.previous_width = f.view.info.previous_height = 0;
       }},
      {"radius in kilometres", "less than a pixel", [](F& f) { f.settings.radius *= 0.001f; }},
      {"radius in another unit by 100", "less than a pixel",
       [](F& f) { f.settings.radius *= 0.01f; }},
      {"radius in millimetres", "larger than twice the height",
       [](F& f) { f.settings.radius *= 1000.0f; }},
      {"radius in pixels", "larger than twice the height", [](F& f) { f.settings.radius = 40.0f; }},
      {"radius ten times too large", "larger than", [](F& f) { f.settings.radius *= 10.0f; }},
      // Normals.
      {"normals of world space declared to be of view space", "in the other space",
       [](F& f) { f.view.info.normals_in_view_space = VK_TRUE; }},
      {"normals of view space declared to be of world space", "in the other space",
       with(set_normals, Other::view_normals, ALCOVE_NORMAL_ENCODING_SIGNED_XYZ, false)},
      {"signed normals declared to be packed", "decoded in another way",
       [](F& f) { f.view.info.normal_encoding = ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ; }},
      {"octahedral normals read as xyz", "decoded in another way",
       with(set_normals, Other::octahedral_normals, ALCOVE_NORMAL_ENCODING_SIGNED_XYZ, false)},
      {"octahedral normals declared to be packed", "decoded in another way",
       with(set_normals, Other::octahedral_normals, ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL,
            false)},
      {"xyz read as octahedral normals", "decoded in another way",
       [](F& f) { f.view.info.normal_encoding = ALCOVE_NORMAL_ENCODING_OCTAHEDRAL; }},
      {"normals_forward_z for a camera along -Z", "the other sign of z",
       [](F& f) {
         set_normals(f, Other::view_normals, ALCOVE_NORMAL_ENCODING_SIGNED_XYZ, true);
         f.view.info.normals_forward_z = VK_TRUE;
       }},
      {"albedo given as normals", "under no reading",
       with(set_normals, Other::albedo, ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ, false)},
      {"normals of view space by the transposed matrix", "transposed",
       with(set_normals, Other::transposed_normals, ALCOVE_NORMAL_ENCODING_SIGNED_XYZ, true)},
      // Motion vectors.
      {"motion vectors that point back", "the other sign of x or y",
       with(scale_motion, -1.0f, -1.0f)},
      {"motion vectors with y up", "the other sign of x or y", with(scale_motion, 1.0f, -1.0f)},
      {"motion vectors in pixels, declared to be in uv", "in another unit",
       [](F& f) {
         scale_motion(f, static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].width),
                      static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].height));
       }},
      {"motion vectors in uv, declared to be in pixels", "in another unit",
       [](F& f) {
         scale_motion(f, 1.0f / static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].width),
                      1.0f / static_cast<float>(f.view.images[ALCOVE_IMAGE_DEPTH].height));
       }},
      {"motion vectors in normalised device coordinates", "in another unit",
       with(scale_motion, 2.0f, 2.0f)},
      {"jitter added to motion vectors that have it", "with a constant offset",
       [](F& f) {
         scale_motion(f, 1.0f, 1.0f);
         for (std::size_t i = 0; i < 2; ++i)
           f.view.info.motion_offset[i] =
               0.5f * (f.view.info.previous_camera.clip_from_view[8 + i] -
                       f.view.info.camera.clip_from_view[8 + i]);
       }},
      {"motion vectors without the camera's motion", "motion vectors are 0",
       with(scale_motion, 1e-6f, 1e-6f)},
      {"motion vectors with a constant offset", "with a constant offset",
       [](F& f) {
         scale_motion(f, 1.0f, 1.0f);
         f.view.info.motion_offset[0] = 0.01f;
       }},
      {"normals given as motion vectors", "under no reading",
       [](F& f) { set_motion(f, f.other[Other::view_normals], 1.0f, 1.0f); }},
  };
  return mistakes;
}

std::vector<CorrectCourse> correct_courses(const EngineCourse& base) {
  EngineCourse jittered = base;
  jittered.jitter = true;
  EngineCourse orbiting = jittered;
  orbiting.orbit = 0.01f;
  std::vector<CorrectCourse> courses{
      {"still", base}, {"jittered", jittered}, {"orbiting", orbiting}};
  const auto add = [&](const char* name, bool EngineCourse::*member) {
    courses.push_back({name, orbiting});
    courses.back().course.*member = true;
  };
  add("geometric normals", &EngineCourse::geometric);
  add("resized", &EngineCourse::resize);
  add("cut", &EngineCourse::cut);
  add("straight", &EngineCourse::straight);
  add("zooming", &EngineCourse::zoom);
  add("swaying", &EngineCourse::sway);
  add("stereo", &EngineCourse::stereo);
  add("camera-relative", &EngineCourse::relative);
  courses.push_back({"trembling", jittered});
  courses.back().course.tremble = 0.01f;
  return courses;
}

Result<std::string> diagnose_correct_frames(EngineRun& run) {
  const ChangeFrame ways[] = {{},
                              [](F& f) { scale_motion(f, 1.0f, 1.0f); },
                              [](F& f) {  // as a host of VulkanSceneGraph does
                                f.view.images[ALCOVE_IMAGE_NORMALS] = {};
                                if (f.frame.index == 0) f.view.info.previous_camera = {};
                              },
                              [](F& f) {
                                change_size(f);
                                f.view.info.static_frames = 0;
                              }};
  std::string report;
  for (const ChangeFrame& way : ways) {
    ALCOVE_TRY(const std::string lines, run.draw(way));
    report += lines;
  }
  return report;
}

Result<EngineRun*> MistakeRun::run_of(PlantedMistake::Frames frames) {
  std::unique_ptr<EngineRun>& run = runs_.at(frames);
  if (!run) {
    Camera from = camera_;
    from.reversed_z = frames == PlantedMistake::reversed;
    from.near_plane = frames == PlantedMistake::odd_planes ? 0.1370519f : kNear;
    from.far_plane = from.reversed_z ? std::numeric_limits<float>::infinity() : kFar;
    EngineCourse course = course_;
    course.jitter = true;
    course.other_inputs = frames == PlantedMistake::orbit;
    course.straight =
        frames == PlantedMistake::straight || frames == PlantedMistake::straight_stereo;
    course.stereo = frames == PlantedMistake::stereo || frames == PlantedMistake::straight_stereo;
    course.orbit = course.straight || frames == PlantedMistake::standing ? 0.0f : 0.02f;
    ALCOVE_TRY(run, EngineRun::create(engine_, from, course));
  }
  return run.get();
}

Result<std::string> MistakeRun::draw(const PlantedMistake& mistake, std::uint32_t begin) {
  return run_of(mistake.frames).and_then([&](EngineRun* run) {
    return run->draw(mistake.plant, begin, !mistake.plant);
  });
}

bool names(const std::string& report, const PlantedMistake& mistake) {
  return std::ranges::count(report, '\n') == 1 &&
         report.find(mistake.sentence) != std::string::npos;
}

}  // namespace alcove::sample

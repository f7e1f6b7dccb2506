// The mistakes of engines, and what to say of them.
#pragma once

namespace alcove::passes {

// The comparison that finds a mistake. It finds one mistake of its group at most.
enum MistakeGroup : unsigned {
  kByCalls = 1,      // none: each mistake is noted by itself
  kByDepth = 2,      // depth of one frame
  kBySurfaces = 4,   // depth of one frame, if surfaces are seen
  kByNormals = 8,    // depth and normals
  kByGeometry = 16,  // depth and normals, or depth of successive frames
  kByCameras = 32,   // depth of successive frames
  kByMotion = 64,    // motion vectors
  kByRadius = 128,   // depth, if nothing else is wrong
};

struct Mistake {
  MistakeGroup group;
  const char* sentence;  // what is wrong and what to do; a # stands for Sighting::measure
  // It is reported if `least` of the last `frames` frames that could show it, 32 at most, did.
  int least;
  int frames;
};

// A mistake is known by its address.
namespace mistakes {

template <MistakeGroup kGroup>
constexpr Mistake of(const char* sentence, int least = 5, int frames = 8) {
  return {kGroup, sentence, least, frames};
}

inline constexpr Mistake index_repeats = of<kByCalls>(
    "AlcoveFrame::index is that of the last record of the view; count it up, or set static_noise "
    "if no temporal filter follows, and record a view once a frame.",
    3);  // in every second record of a view recorded twice
inline constexpr Mistake index_goes_back = of<kByCalls>(
    "AlcoveFrame::index goes back again and again; count it up, so that the noise averages out.", 2,
    32);  // once it may, for example when a game restarts
inline constexpr Mistake previous_is_this = of<kByCalls>(
    "previous_camera is this frame's camera although the camera moves; give the one before.");
inline constexpr Mistake previous_is_another = of<kByCalls>(
    "previous_camera is not the camera of the view's last record; store it after each frame.");
inline constexpr Mistake projection_is_another = of<kByCalls>(
    "previous_camera has the last frame's view_from_world but another clip_from_view; give the "
    "matrix that depth was drawn with, jitter included.");
inline constexpr Mistake previous_size_is_wrong = of<kByCalls>(
    "previous_width and previous_height are not the size of the last record; store it after each.");
inline constexpr Mistake static_in_motion = of<kByCalls>(
    "static_frames is not 0 although the image changes; it counts frames that are the same.");
inline constexpr Mistake history_reset = of<kByCalls>(
    "reset_history is set again and again, so that no history accumulates; set it at cuts only.", 3,
    16);  // a film may have a cut or two
inline constexpr Mistake resolution_changes = of<kByCalls>(
    "half_resolution changes again and again, and each change begins a new history; keep it.", 3,
    16);
inline constexpr Mistake eyes_alternate = of<kByCalls>(
    "the camera goes to and fro from frame to frame, as if two eyes alternated; give each eye an "
    "AlcoveView::id of its own, and its own previous_camera.",
    8);  // a camera may shake
inline constexpr Mistake slot_reused = of<kByCalls>(
    "AlcoveFrame::slot was recorded again before the device had finished its last frame; wait for "
    "the fence of the slot, and call alcoveDiscardFrame for a frame that is not submitted.",
    2);  // a right frame never shows it
inline constexpr Mistake size_changes = of<kByCalls>(
    "the size changes within an image of one size, and each change begins a new history; give "
    "largest_width and largest_height, and previous_width and previous_height.");
inline constexpr Mistake image_too_small =
    of<kByDepth>("an image is smaller than AlcoveImage::width and height say.");
inline constexpr Mistake depth_outside = of<kByDepth>(
    "the image of depth holds values below 0 or above 1; give the projection's, not a linear "
    "depth.");
inline constexpr Mistake depth_converted_from_minus_one = of<kByDepth>(
    "camera.clip_from_view looks as if it had depth from 0 to 1 and was converted with "
    "ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE; convert it without that bit.");
inline constexpr Mistake depth_reversed = of<kByDepth>(
    "depth runs the other way than camera.clip_from_view says: the sky, or all that is seen, lies "
    "at its near plane; give the matrix that depth was drawn with.");
inline constexpr Mistake depth_from_minus_one = of<kByDepth>(
    "camera.clip_from_view looks like OpenGL's, with depth from -1 to 1: its near plane is a round "
    "number only then; convert it with ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE.");
inline constexpr Mistake depth_filtered = of<kBySurfaces>(
    "at edges the image of depth holds values between those of the surfaces, as a linear filter "
    "makes them; scale depth with the nearest value.");
inline constexpr Mistake depth_format = of<kBySurfaces>(
    "the values of the image of depth have the steps of another format than AlcoveImage::format "
    "says, such as 16 bits or half floats; give the depth buffer itself, with its own format.");
inline constexpr Mistake depth_curved = of<kBySurfaces>(
    "planes are curved in the image of depth, as in a logarithmic or a linear depth, which no "
    "matrix gives; give a copy with the depth of the projection.");
inline constexpr Mistake not_surfaces = of<kBySurfaces>(
    "depth does not look like surfaces: pixels repeat or are unrelated, as in another resource, a "
    "hi-Z level or a checkerboard; give depth as it was drawn, at the size at which it was drawn.");
inline constexpr Mistake radius_too_small = of<kByRadius>(
    "the radius is less than a pixel almost everywhere; give it in the units of the scene.");
inline constexpr Mistake radius_too_large = of<kByRadius>(
    "the radius is larger than twice the height of the image, or than half of all that is seen; "
    "give it in the units of the scene, or the matrix that depth was drawn with.");
inline constexpr Mistake normal_space =
    of<kByNormals>("normals fit the depth in the other space; change normals_in_view_space.");
inline constexpr Mistake normal_encoding = of<kByNormals>(
    "normals fit the depth when they are decoded in another way; change normal_encoding.");
inline constexpr Mistake normal_forward_z =
    of<kByNormals>("normals fit the depth with the other sign of z; change normals_forward_z.");
inline constexpr Mistake normals_transposed = of<kByNormals>(
    "normals fit the depth if the transposed matrix rotated them; rotate them by view_from_world.");
inline constexpr Mistake normals_disagree = of<kByNormals>(
    "normals fit the depth under no reading: the image holds something else, or normals with other "
    "axes; or depth is not what camera.clip_from_view gives; or camera.view_from_world is not the "
    "camera's (typical angle in degrees: #).");
inline constexpr Mistake view_inverted = of<kByGeometry>(
    "the pixels fit camera.view_from_world only if it is inverted; it goes from world to view.");
inline constexpr Mistake flipped = of<kByGeometry>(
    "the pixels fit x or y of camera.clip_from_view the other way round; see "
    "ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP.");
inline constexpr Mistake image_too_large = of<kByGeometry>(
    "the pixels fit the camera only if the whole image is in use, which is larger than "
    "AlcoveImage::width and height say; give the size of this frame.");
inline constexpr Mistake image_at_bottom = of<kByGeometry>(
    "the pixels fit the camera only if the part in use is at the bottom of the image; say where it "
    "is with AlcoveViewInfo::read_area.");
inline constexpr Mistake field_of_view = of<kByGeometry>(
    "the pixels fit another angle of view or aspect, or other near and far planes, than those of "
    "camera.clip_from_view; give the matrix that depth was drawn with.");
inline constexpr Mistake jitter_wrong = of<kByGeometry>(
    "the jitter of camera.clip_from_view differs from that of depth: it has another sign or unit, "
    "or is another frame's; give the matrix that depth was drawn with (pixels per frame: #).");
inline constexpr Mistake camera_of_another_frame = of<kByCameras>(
    "the pixels fit the camera of the frame before or after: camera and depth are not of the same "
    "frame; give the camera that this frame's depth was drawn with.");
inline constexpr Mistake jitter_missing = of<kByCameras>(
    "depth is shifted by jitter that camera.clip_from_view lacks; give depth's own matrix (pixels "
    "from frame to frame: #).");
inline constexpr Mistake jitter_unused = of<kByCameras>(
    "camera.clip_from_view has a jitter that depth was not drawn with; give the matrix that depth "
    "was drawn with (pixels from frame to frame: #).");
inline constexpr Mistake translation_scale = of<kByCameras>(
    "depth of successive frames fits if the camera moves further, or less far, than "
    "camera.view_from_world says: its unit is wrong, or the near plane of clip_from_view, or its "
    "range, depth from -1 to 1, or a gamma was applied to depth (times as far: #).");
inline constexpr Mistake translation_wrong = of<kByCameras>(
    "depth of successive frames fits if the camera moves another way than view_from_world says; "
    "give previous_camera and camera relative to one origin.");
inline constexpr Mistake no_translation = of<kByCameras>(
    "camera.view_from_world has no translation, but the camera moves; give the whole matrix, or "
    "one that is relative to one origin for this frame and the last.");
inline constexpr Mistake cameras_disagree = of<kByCameras>(
    "depth is not what the cameras of this frame and the last expect, so that history is rejected; "
    "give depth's own matrices, and motion vectors if objects move (percent of pixels: #).");
inline constexpr Mistake motion_zero = of<kByMotion>(
    "motion vectors are 0 although the camera moves; they must contain the motion by the camera.");
inline constexpr Mistake motion_sign = of<kByMotion>(
    "motion vectors fit the camera's motion with the other sign of x or y; change motion_scale.");
inline constexpr Mistake motion_unit = of<kByMotion>(
    "motion vectors fit the motion of the camera in another unit; change motion_scale.");
inline constexpr Mistake motion_offset = of<kByMotion>(
    "motion vectors fit the camera's with a constant offset, as of jitter; change motion_offset.");
inline constexpr Mistake motion_disagrees = of<kByMotion>(
    "motion vectors fit the motion of the camera under no reading although depth does: the image "
    "holds something else; give the motion of each pixel since the last frame.");

}  // namespace mistakes

}  // namespace alcove::passes

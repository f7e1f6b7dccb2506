#include <alcove/alcove.h>
// Declarations that the examples of README.md and passes/INTEGRATION.md take from the engine.
#include <alcove/alcove.h>
#include <alcove/alcove_work.h>

extern VkInstance instance;
extern VkPhysicalDevice physical_device;
extern VkDevice device;
extern uint32_t queue_family, frame_number, width, height;
extern VkImage depth_image, visibility_image;
extern VkFormat depth_format;
extern VkPhysicalDeviceFeatures2 features;
extern AlcoveContext* context;
extern AlcoveSettings settings;
extern AlcoveCamera camera, previous_camera;
extern AlcoveImage depth, normals, visibility;
extern VkCommandBuffer commands;
extern float radius;
extern const char* text;
extern size_t length;
extern char message[ALCOVE_MAX_MESSAGE];
extern double milliseconds[32];
extern uint32_t time_count;
extern const AlcoveWork* work;
void write_log(void* user, AlcoveSeverity severity, const char* sentence);
void fail(const char* sentence);
void submit_and_wait(void);
void example_1(void) {

/* Once: a context on the engine's device, and settings. */
AlcoveContextInfo info = {sizeof(AlcoveContextInfo)};
info.instance = instance;
info.physical_device = physical_device;
info.device = device;
info.queue_family = queue_family;
info.get_instance_proc_addr = vkGetInstanceProcAddr;
info.frames_in_flight = 2;
AlcoveContext* context;
char message[ALCOVE_MAX_MESSAGE];
if (alcoveCreateContext(&info, &context, message) != ALCOVE_SUCCESS) fail(message);
AlcoveSettings settings = {sizeof(AlcoveSettings)};
alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, radius, &settings);

/* The engine's images, with their state before and after: depth is read, and visibility (R8) is written. */
AlcoveImage depth = {depth_image, VK_NULL_HANDLE, depth_format, width, height};
depth.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
depth.initial_state.stages = VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
depth.initial_state.access = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
depth.initial_state.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
depth.final_state.stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
depth.final_state.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
depth.final_state.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
AlcoveImage visibility = {visibility_image, VK_NULL_HANDLE, VK_FORMAT_R8_UNORM, width, height};
visibility.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
visibility.initial_state = depth.final_state;    /* lighting of the previous frame has read it */
visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
visibility.final_state = depth.final_state;      /* lighting reads it */

/* Each frame, between drawing depth and lighting. */
AlcoveView view = {sizeof(AlcoveView)};
view.info.settings = &settings;
view.info.camera = camera;                       /* the matrices that depth was drawn with */
view.info.previous_camera = previous_camera;
view.images[ALCOVE_IMAGE_DEPTH] = depth;
view.images[ALCOVE_IMAGE_VISIBILITY] = visibility; /* an output without an image costs nothing */
AlcoveFrame frame = {sizeof(AlcoveFrame)};
frame.index = frame_number;
frame.slot = frame_number % 2;
frame.views = &view;
frame.view_count = 1;
if (alcoveRecordFrame(context, commands, &frame) != ALCOVE_SUCCESS) fail(alcoveGetMessage(context));
}

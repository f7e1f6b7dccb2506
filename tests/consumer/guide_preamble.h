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
extern AlcoveView view;
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

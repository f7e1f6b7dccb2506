/* Compiles alcove_work.h as C99, without any header of Vulkan. */
#include "alcove/alcove_work.h"

#ifdef VULKAN_CORE_H_
#error "alcove_work.h includes a header of Vulkan."
#endif

/* The functions have C linkage. */
AlcoveResult (*const describe_work)(const AlcoveWorkInfo*, AlcoveWork*, char*) = alcoveDescribeWork;
AlcoveResult (*const list_pipelines)(const AlcoveWorkInfo*, uint32_t*, AlcoveWorkPipeline*,
                                     char*) = alcoveListPipelines;
size_t (*const print_work)(const AlcoveWork*, char*, size_t) = alcovePrintWork;
AlcoveResult (*const get_shader)(const char*, AlcoveShader*) = alcoveGetShader;

/* Alcove on OpenGL 4.5, without Vulkan: from a context to an occlusion picture, in C99.
 *
 *   alcove_minimal_opengl SHADERS FILE.pgm
 *
 * SHADERS is the folder of the translated shaders (share/alcove/shaders, built with
 * ALCOVE_TRANSLATE_SHADERS). A ball on a floor is written into a depth image on the CPU, in place
 * of an engine's rendering. alcoveDescribeWork then lists the work of 32 frames of a static camera,
 * which this program executes. The last visibility is written to the file.
 */
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <alcove/alcove_work.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kWidth = 480, kHeight = 270, kFrames = 32, kMaxPrograms = 64 };
static const float kNear = 0.1f;    /* The projection is reversed and infinite: depth = near / z. */
static const float kFocal = 1.732f; /* 1 / tan(fov_y / 2), 60 degrees */

static void check(int ok, const char* what) {
  if (!ok) {
    fprintf(stderr, "alcove_minimal_opengl: %s\n", what);
    exit(1);
  }
}

static void create_context(void) {
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
      (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
  check(get_display != NULL, "EGL has no platform displays");
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
  check(eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_API),
        "EGL cannot be initialised without a surface");
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  const EGLContext context = eglCreateContext(display, NULL, EGL_NO_CONTEXT, version);
  check(
      context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context),
      "there is no OpenGL 4.5");
}

/* OpenGL's formats for the Vulkan numbers of formats: those that Alcove creates and the engine's.
 */
static GLenum format_of(uint32_t vulkan) {
  static const struct {
    uint32_t vulkan;
    GLenum opengl;
  } formats[] = {{9, GL_R8},         {37, GL_RGBA8},        {38, GL_RGBA8_SNORM}, {64, GL_RGB10_A2},
                 {74, GL_R16UI},     {76, GL_R16F},         {77, GL_RG16},        {83, GL_RG16F},
                 {97, GL_RGBA16F},   {92, GL_RGBA16_SNORM}, {100, GL_R32F},       {101, GL_RG32UI},
                 {107, GL_RGBA32UI}, {109, GL_RGBA32F}};
  for (size_t i = 0; i < sizeof formats / sizeof *formats; ++i)
    if (formats[i].vulkan == vulkan) return formats[i].opengl;
  check(0, "a format has no counterpart");
  return GL_NONE;
}

static char* read_shader(const char* folder, const char* name) {
  char path[1024];
  snprintf(path, sizeof path, "%s/%s.glsl", folder, name);
  FILE* file = fopen(path, "rb");
  check(file != NULL, path);
  char* text = calloc(1 << 20, 1);
  check(text != NULL && fread(text, 1, (1 << 20) - 1, file) > 0, path);
  fclose(file);
  return text;
}

/* A program for a shader and its constants. In the translated text, `#define
 * SPIRV_CROSS_CONSTANT_ID_3 false` is the default of a constant, whose type follows from its form.
 * A program without constants that differ is compiled once. */
static GLuint program_of(const char* folder, const AlcoveWorkDispatch* dispatch) {
  static struct {
    const char* shader;
    uint32_t constant_count;
    AlcoveWorkConstant constants[ALCOVE_MAX_WORK_CONSTANTS];
    GLuint program;
  } known[kMaxPrograms];
  static int count;
  const size_t bytes = dispatch->constant_count * sizeof *dispatch->constants;
  for (int i = 0; i < count; ++i)
    if (known[i].shader == dispatch->shader &&
        memcmp(known[i].constants, dispatch->constants, bytes) == 0)
      return known[i].program;
  char* text = read_shader(folder, dispatch->shader);
  char defines[4096] = "#version 450\n";
  for (uint32_t i = 0; i < dispatch->constant_count; ++i) {
    char name[64];
    snprintf(name, sizeof name, "#define SPIRV_CROSS_CONSTANT_ID_%u ", dispatch->constants[i].id);
    const char* found = strstr(text, name);
    if (found == NULL) continue; /* the shader does not use it */
    const char* value = found + strlen(name);
    const char* type = *value == 't' || *value == 'f'               ? "bool"
                       : strcspn(value, "u") < strcspn(value, "\n") ? "uint"
                                                                    : "int";
    snprintf(defines + strlen(defines), sizeof defines - strlen(defines), "%s%s(%u)\n", name, type,
             dispatch->constants[i].value);
  }
  const char* texts[] = {defines, strchr(text, '\n')}; /* without the line of the version */
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 2, texts, NULL);
  glCompileShader(shader);
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader);
  glLinkProgram(program);
  GLint linked = 0;
  char message[2048] = "";
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  glGetShaderInfoLog(shader, sizeof message, NULL, message);
  check(linked, message);
  glDeleteShader(shader);
  free(text);
  check(count < kMaxPrograms, "there are too many programs");
  known[count].shader = dispatch->shader;
  known[count].constant_count = dispatch->constant_count;
  memcpy(known[count].constants, dispatch->constants, bytes);
  known[count].program = program;
  return known[count++].program;
}

/* Depth of the view ray through a pixel: a ball of radius 0.5 on a floor, 3 units away. */
static float depth_at(int x, int y) {
  const float slope_x = (2 * (x + 0.5f) / kWidth - 1) * kWidth / kHeight / kFocal;
  const float slope_y = (1 - 2 * (y + 0.5f) / kHeight) / kFocal;
  const float floor_z = slope_y < -1e-4f ? -0.8f / slope_y : 1e9f;
  /* (z slope_x)^2 + (z slope_y + 0.3)^2 + (z - 3)^2 = 0.25 */
  const float a = slope_x * slope_x + slope_y * slope_y + 1;
  const float b = 0.3f * slope_y - 3;
  const float root = b * b - a * (0.09f + 9 - 0.25f);
  const float ball_z = root > 0 ? (-b - sqrtf(root)) / a : 1e9f;
  const float z = ball_z < floor_z ? ball_z : floor_z;
  return z < 50 ? kNear / z : 0; /* 0 is the sky */
}

static GLuint create_texture(uint32_t format, uint32_t width, uint32_t height) {
  GLuint texture;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, format_of(format), (GLsizei)width, (GLsizei)height);
  return texture;
}

/* The textures of a list, parallel to its resources. Depth and visibility are the engine's. A
 * history's texture of the last frame moves to its previous slot. Transients are kept from frame to
 * frame, because the list stays the same: an engine with a pool takes them from there. */
static void prepare_textures(const AlcoveWork* work, GLuint depth, GLuint visibility,
                             GLuint* textures) {
  for (uint32_t i = 0; i < work->history_count; ++i) {
    GLuint* previous = &textures[work->histories[i].previous];
    GLuint* current = &textures[work->histories[i].current];
    const GLuint swapped = *previous;
    *previous = *current;
    *current = swapped;
  }
  for (uint32_t i = 0; i < work->resource_count; ++i) {
    const AlcoveWorkResource* resource = &work->resources[i];
    if (resource->kind == ALCOVE_RESOURCE_KIND_INPUT) {
      textures[i] = depth;
    } else if (resource->kind == ALCOVE_RESOURCE_KIND_OUTPUT) {
      textures[i] = visibility;
    } else if (textures[i] == 0) {
      check(resource->kind != ALCOVE_RESOURCE_KIND_TABLE, "medium visibility has no table");
      textures[i] = create_texture(resource->format, resource->width, resource->height);
    }
  }
}

static void execute(const char* folder, const AlcoveWork* work, const GLuint* textures,
                    GLuint parameters, GLuint sampler) {
  for (uint32_t i = 0; i < work->dispatch_count; ++i) {
    const AlcoveWorkDispatch* dispatch = &work->dispatches[i];
    const GLuint program = program_of(folder, dispatch);
    glUseProgram(program);
    for (uint32_t b = 0; b < dispatch->binding_count; ++b) {
      const AlcoveWorkBinding* binding = &dispatch->bindings[b];
      if (binding->type == ALCOVE_BINDING_TYPE_PARAMETERS) {
        glNamedBufferSubData(parameters, 0, dispatch->parameter_bytes, dispatch->parameters);
        glBindBufferRange(GL_UNIFORM_BUFFER, binding->number, parameters, 0,
                          dispatch->parameter_bytes);
      } else if (binding->type == ALCOVE_BINDING_TYPE_STORAGE_IMAGE) {
        glBindImageTexture(binding->number, textures[binding->resource], 0, GL_FALSE, 0,
                           GL_WRITE_ONLY, format_of(work->resources[binding->resource].format));
      } else if (binding->type == ALCOVE_BINDING_TYPE_FETCHED_IMAGE) {
        glBindTextureUnit(binding->number, textures[binding->resource]);
        glBindSampler(binding->number, sampler);
      }
    }
    glDispatchCompute(dispatch->groups[0], dispatch->groups[1], dispatch->groups[2]);
    glMemoryBarrier(GL_ALL_BARRIER_BITS); /* the next dispatch reads what this one wrote */
  }
  check(glGetError() == GL_NO_ERROR, "an OpenGL call failed");
}

int main(int argc, char** argv) {
  check(argc == 3, "usage: alcove_minimal_opengl SHADERS FILE.pgm");
  create_context();

  static float depths[kWidth * kHeight];
  for (int i = 0; i < kWidth * kHeight; ++i) depths[i] = depth_at(i % kWidth, i / kWidth);
  AlcoveSettings settings = {.struct_size = sizeof settings};
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings);
  AlcoveWorkInfo info = {
      .struct_size = sizeof info,
      .view.settings = &settings,
      .images = {[ALCOVE_IMAGE_DEPTH] = {100, kWidth, kHeight},      /* R32_SFLOAT */
                 [ALCOVE_IMAGE_VISIBILITY] = {9, kWidth, kHeight}}}; /* R8_UNORM */
  float* clip = info.view.camera.clip_from_view;                     /* column-major */
  clip[0] = kFocal * kHeight / kWidth;
  clip[5] = -kFocal; /* Alcove's first row is the upper one, as in the depth image above */
  clip[11] = -1;
  clip[14] = kNear;
  for (int i = 0; i < 4; ++i) info.view.camera.view_from_world[5 * i] = 1; /* eye: origin */

  const GLuint depth = create_texture(100, kWidth, kHeight);
  glTextureSubImage2D(depth, 0, 0, 0, kWidth, kHeight, GL_RED, GL_FLOAT, depths);
  const GLuint visibility = create_texture(9, kWidth, kHeight);
  GLuint parameters;
  glCreateBuffers(1, &parameters);
  glNamedBufferStorage(parameters, ALCOVE_MAX_WORK_PARAMETER_BYTES, NULL, GL_DYNAMIC_STORAGE_BIT);
  GLuint sampler;
  glCreateSamplers(1, &sampler);
  glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);

  static AlcoveWork work;
  static GLuint textures[ALCOVE_MAX_WORK_RESOURCES];
  char message[ALCOVE_MAX_MESSAGE];
  for (uint32_t i = 0; i < kFrames; ++i) {
    info.index = i;
    info.view.static_frames = i;
    info.previous = i > 0 ? &work : NULL;
    check(alcoveDescribeWork(&info, &work, message) == ALCOVE_SUCCESS, message);
    prepare_textures(&work, depth, visibility, textures);
    execute(argv[1], &work, textures, parameters, sampler);
  }

  static unsigned char pixels[kWidth * kHeight];
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(visibility, 0, GL_RED, GL_UNSIGNED_BYTE, sizeof pixels, pixels);
  FILE* file = fopen(argv[2], "wb");
  check(file != NULL, "the file cannot be written");
  fprintf(file, "P5\n%d %d\n255\n", kWidth, kHeight);
  const size_t written = fwrite(pixels, 1, sizeof pixels, file);
  check(fclose(file) == 0 && written == sizeof pixels, "the file cannot be written");
  return 0;
}

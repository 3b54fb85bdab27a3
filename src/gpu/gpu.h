// A thin layer over Vulkan 1.3; the only header of it that others see. No Vulkan type stands here.
//
// Objects are small handles into the device's tables; a zeroed handle is none, and destroying it
// does nothing. Every object has a name "owner.thing"; the part before the dot owns its bytes in
// gpu_memory. Destruction is deferred until the GPU no longer uses the object.
//
// Barriers and image layouts: the layer reflects each shader and knows for each binding whether it
// is read or written; before each dispatch and each rendering it waits for exactly what was written
// before (or read, before a write). Nobody writes a barrier by hand. Hazards between draws of one
// rendering are not tracked.
//
// Units: sizes in bytes, extents in texels, times in milliseconds. Thread-safety: one thread per
// device.
#pragma once

#include "core/host.h"

#include <stdint.h>

struct gpu;
struct gpu_cmd;

typedef struct {
    uint32_t id;
} gpu_image;
typedef struct {
    uint32_t id;
} gpu_buffer;
typedef struct {
    uint32_t id;
} gpu_sampler;
typedef struct {
    uint32_t id;
} gpu_pipeline;

// ---- Device
// -------------------------------------------------------------------------------------------------

struct gpu_device_info {
    char name[256], driver[256];
    enum { GPU_CPU, GPU_INTEGRATED, GPU_DISCRETE, GPU_OTHER } type;
    bool usable;       // has all that the core path needs
    char missing[256]; // what it lacks, where it is not usable
};

// Fills at most `capacity` entries and sets *count to the number of devices. false: no Vulkan at
// all.
bool gpu_list_devices(struct host *host, struct gpu_device_info *out, int capacity, int *count);

// A caller's own device (Vulkan handles as void *). It must have been created with the features
// that gpu_required_features lists. The caller keeps it alive and idles it before gpu_destroy.
struct gpu_adopt {
    void *instance, *physical_device, *device, *queue;
    uint32_t queue_family;
    void (*lock_queue)(void *user), (*unlock_queue)(void *user); // around submissions; may be NULL
    void *user;
};

struct gpu_desc {
    const char *device; // a number from gpu_list_devices, a part of a name, or NULL for the best
    bool validation; // validation and synchronization validation; fails when the layer is missing
    const char *shader_dir; // X.spv from here, where there is one, stands for the embedded X; NULL:
                            // embedded ones only
    const struct gpu_adopt *adopt; // NULL: our own device
};

struct gpu *gpu_create(struct host *host, const struct gpu_desc *desc);
void gpu_destroy(struct gpu *gpu); // waits; reports objects that were never destroyed
const struct gpu_device_info *gpu_info(const struct gpu *gpu);
const char *gpu_required_features(void); // for documentation and errors: one name a line
// Validation errors and warnings so far (0 when validation is off). Tests fail on any.
int gpu_validation_messages(const struct gpu *gpu);
int gpu_live_objects(const struct gpu *gpu);

struct gpu_limits {
    uint32_t max_image_2d, max_image_3d, max_layers, max_push_bytes, max_groups[3];
    uint64_t max_storage_bytes, memory_bytes;
    bool timestamps, anisotropy, geometry_shader, ray_query;
};
const struct gpu_limits *gpu_limits(const struct gpu *gpu);

// ---- Resources
// ----------------------------------------------------------------------------------------------

enum gpu_format {
    GPU_FORMAT_NONE,
    GPU_R8,
    GPU_RG8,
    GPU_RGBA8,
    GPU_RGBA8_SRGB,
    GPU_RG16_SNORM,
    GPU_RGBA8_SNORM,
    GPU_R16F,
    GPU_RG16F,
    GPU_RGBA16F,
    GPU_R32F,
    GPU_RG32F,
    GPU_RGBA32F,
    GPU_R32U,
    GPU_RGBA32U,
    GPU_B10G11R11F,
    GPU_D32F,
    GPU_FORMAT_COUNT
};
int gpu_format_bytes(enum gpu_format format); // per texel

enum gpu_dimension { GPU_2D, GPU_2D_ARRAY, GPU_3D, GPU_CUBE, GPU_CUBE_ARRAY };

enum gpu_image_usage {
    GPU_SAMPLED = 1,    // texture
    GPU_STORAGE = 2,    // image load and store
    GPU_ATTACHMENT = 4, // colour or depth target, by format
};

struct gpu_image_desc {
    const char *name; // "owner.thing"
    enum gpu_dimension dimension;
    enum gpu_format format;
    uint32_t width, height;
    uint32_t
        depth; // 3D: depth; 2D arrays: layers; cubes: 6; cube arrays: 6 × cubes; 2D: 1 (0 is 1)
    uint32_t mips;  // 0 is 1
    uint32_t usage; // gpu_image_usage; copies and clears are always allowed
};

// A new image is zeroed on the GPU before its first use. false: the size is 0 or beyond the limits,
// or no memory.
bool gpu_image_create(struct gpu *gpu, const struct gpu_image_desc *desc, gpu_image *out);
void gpu_image_destroy(struct gpu *gpu, gpu_image *image); // sets *image to none
const struct gpu_image_desc *gpu_image_info(const struct gpu *gpu, gpu_image image);
// Wraps a caller's VkImage (not owned). `layout` is its VkImageLayout now; see gpu_image_handle for
// later.
bool gpu_image_wrap(struct gpu *gpu, const struct gpu_image_desc *desc, void *vk_image,
                    uint32_t layout, gpu_image *out);
// The VkImage, and its VkImageLayout at the end of the newest frame, in which it must be again when
// the next one begins. From then on each frame waits for all that was submitted before, as others
// may have used the image; they wait for the frame themselves. NULL: no such image.
void *gpu_image_handle(const struct gpu *gpu, gpu_image image, uint32_t *layout);

enum gpu_buffer_usage {
    GPU_BUFFER_STORAGE = 1,
    GPU_BUFFER_UNIFORM = 2,
    GPU_BUFFER_INDEX = 4,
    GPU_BUFFER_INDIRECT = 8,
};

struct gpu_buffer_desc {
    const char *name; // "owner.thing"
    size_t bytes;     // > 0
    uint32_t usage;   // copies are always allowed
};
// Zeroed before its first use.
bool gpu_buffer_create(struct gpu *gpu, const struct gpu_buffer_desc *desc, gpu_buffer *out);
void gpu_buffer_destroy(struct gpu *gpu, gpu_buffer *buffer);
size_t gpu_buffer_bytes(const struct gpu *gpu, gpu_buffer buffer);

enum gpu_filter { GPU_NEAREST, GPU_LINEAR };
enum gpu_wrap { GPU_REPEAT, GPU_MIRROR, GPU_CLAMP, GPU_BORDER_ZERO, GPU_BORDER_ONE };
struct gpu_sampler_desc {
    const char *name;
    enum gpu_filter filter, mip_filter;
    enum gpu_wrap wrap_u, wrap_v, wrap_w;
    bool compare_greater; // a comparison sampler for reversed-Z shadow maps: passes where reference
                          // ≥ texel
    float max_anisotropy; // ≤ 1: off
};
// Equal descriptions share one sampler; gpu_destroy frees them.
bool gpu_sampler_get(struct gpu *gpu, const struct gpu_sampler_desc *desc, gpu_sampler *out);

// Blocking transfers for set-up and for reading results; never in per-frame code.
bool gpu_image_upload(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                      const void *texels,
                      size_t bytes); // one mip of one layer, or of a whole 3D image
bool gpu_image_generate_mips(struct gpu *gpu,
                             gpu_image image); // box filter, from mip 0; format must blit
bool gpu_buffer_upload(struct gpu *gpu, gpu_buffer buffer, size_t offset, const void *data,
                       size_t bytes);
bool gpu_image_download(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                        void *texels, size_t bytes);
// As 32-bit floats, whatever the format (half, unorm, snorm and srgb are converted), `channels` per
// texel.
bool gpu_image_download_float(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                              float *texels, int channels, size_t float_count);
bool gpu_buffer_download(struct gpu *gpu, gpu_buffer buffer, size_t offset, void *data,
                         size_t bytes);

// A readback without waiting. The command copies part of a buffer as it is at this point of the
// frame; when the GPU has finished the frame, gpu_readback_poll returns true and the bytes. A
// second copy before that replaces the first.
struct gpu_readback {
    gpu_buffer buffer; // mapped
    uint64_t serial;   // of the frame; 0: none
};
bool gpu_readback_create(struct gpu *gpu, const char *name, size_t bytes, struct gpu_readback *out);
void gpu_readback_destroy(struct gpu *gpu, struct gpu_readback *readback);
void gpu_readback_copy(struct gpu_cmd *cmd, struct gpu_readback *to, size_t to_offset,
                       gpu_buffer from, size_t from_offset, size_t bytes);
// Each copy is returned once.
bool gpu_readback_poll(struct gpu *gpu, struct gpu_readback *readback, void *out, size_t bytes);

// ---- Pipelines
// ----------------------------------------------------------------------------------------------

struct gpu_shader {   // embedded by cmake/Shaders.cmake
    const char *name; // "lpv_propagate.comp"
    const uint32_t *words;
    size_t word_count;
};

struct gpu_constant { // a specialization constant, 32 bits
    uint32_t id, value;
};

// Boolean constants 0 to count - 1 from the bits of a variant.
static inline void gpu_constants_of_bits(uint32_t bits, struct gpu_constant *out, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) out[i] = (struct gpu_constant){ i, bits >> i & 1u };
}

// Layouts come from reflection: set 0 only, bindings by name, push constants of any size ≤ 128
// bytes.
bool gpu_compute_pipeline_create(struct gpu *gpu, const char *name, const struct gpu_shader *shader,
                                 const struct gpu_constant *constants, int constant_count,
                                 gpu_pipeline *out);

enum gpu_compare { GPU_ALWAYS, GPU_GREATER, GPU_GREATER_EQUAL, GPU_EQUAL };
enum gpu_blend { GPU_BLEND_NONE, GPU_BLEND_ADD };

struct gpu_graphics_desc {
    const char *name;
    const struct gpu_shader *vertex, *fragment; // fragment may be NULL (depth only)
    const struct gpu_constant *constants;       // seen by both stages
    int constant_count;
    enum gpu_format color_formats[8]; // GPU_FORMAT_NONE ends the list
    enum gpu_format depth_format;     // GPU_FORMAT_NONE: no depth
    enum gpu_compare depth_compare;   // reversed Z: GPU_GREATER
    bool depth_write, depth_clamp;
    float depth_bias, depth_bias_slope; // in the sense of Vulkan; reversed Z wants negative values
    enum gpu_blend blend;
    // Triangle lists, no vertex input (vertex pulling), cull mode set per draw. Clip space is
    // Vulkan's (y down, so that row 0 is at y = -1); what is counter-clockwise in the image, row 0
    // on top, is a front.
};
bool gpu_graphics_pipeline_create(struct gpu *gpu, const struct gpu_graphics_desc *desc,
                                  gpu_pipeline *out);
void gpu_pipeline_destroy(struct gpu *gpu, gpu_pipeline *pipeline);
// Rebuilds pipelines whose .spv in shader_dir changed; a bad shader is logged and the old one kept.
// Returns how many.
int gpu_reload_shaders(struct gpu *gpu);

// ---- Commands
// -----------------------------------------------------------------------------------------------

// One frame at a time: begin, record, end (submits, does not wait). Two frames are in flight at
// most. NULL: device lost.
struct gpu_cmd *gpu_frame_begin(struct gpu *gpu);
bool gpu_frame_end(struct gpu *gpu, struct gpu_cmd *cmd);
// Records into a caller's VkCommandBuffer instead (in the recording state, outside of a rendering).
// gpu_frame_end then ends our part and submits nothing: the caller submits it before any other call
// that submits, and says with gpu_frame_adopted_done when the GPU has finished it. Four may be
// unfinished.
struct gpu_cmd *gpu_frame_begin_adopted(struct gpu *gpu, void *vk_command_buffer);
void gpu_frame_adopted_done(struct gpu *gpu, struct gpu_cmd *cmd);
bool gpu_wait(struct gpu *gpu); // until all submitted work is done; false: device lost

// Something bound to a shader's name. Give exactly one of image (with a sampler where the shader
// samples) and buffer.
struct gpu_binding {
    const char *name; // of the variable in GLSL; of the block for buffers
    gpu_image image;
    gpu_buffer buffer;
    gpu_sampler sampler; // none: nearest, clamped (for texelFetch)
    uint32_t mip;        // storage images: which mip. Sampled: the first mip seen
    bool one_mip;        // sampled: only that mip
    uint32_t layer;      // with one_layer: which layer of an array (seen as 2D)
    bool one_layer;
    size_t offset, bytes; // buffers; bytes 0: to the end
};
#define GPU_BIND(...)                                                                              \
    (const struct gpu_binding[]){ __VA_ARGS__ },                                                   \
        (int)(sizeof((const struct gpu_binding[]){ __VA_ARGS__ }) / sizeof(struct gpu_binding))

// All of the shader's bindings must be there (asserted), others are ignored. group counts of 0
// dispatch nothing.
void gpu_dispatch(struct gpu_cmd *cmd, gpu_pipeline pipeline, const struct gpu_binding *bindings,
                  int binding_count, const void *push, size_t push_bytes, uint32_t groups_x,
                  uint32_t groups_y, uint32_t groups_z);
void gpu_dispatch_indirect(struct gpu_cmd *cmd, gpu_pipeline pipeline,
                           const struct gpu_binding *bindings, int binding_count, const void *push,
                           size_t push_bytes, gpu_buffer arguments, size_t offset);
// ceil(size / local)
static inline uint32_t gpu_groups(uint32_t size, uint32_t local)
{
    return (size + local - 1) / local;
}

struct gpu_target {
    gpu_image image;
    uint32_t mip, layer; // one layer (for 3D images: a slice)
    bool load;           // keep what is there; else clear
    float clear[4];      // depth: clear[0]
};
struct gpu_render_desc {
    struct gpu_target color[8];
    int color_count;
    struct gpu_target depth; // image none: no depth
    uint32_t width, height;
    // Everything the draws will read besides the targets; made readable before the rendering
    // begins.
    const struct gpu_binding *reads;
    int read_count;
};
void gpu_render_begin(struct gpu_cmd *cmd, const struct gpu_render_desc *desc);
void gpu_render_viewport(struct gpu_cmd *cmd, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height); // and scissor
enum gpu_cull { GPU_CULL_NONE, GPU_CULL_BACK, GPU_CULL_FRONT };
struct gpu_draw_desc {
    gpu_pipeline pipeline;
    const struct gpu_binding *bindings;
    int binding_count;
    const void *push;
    size_t push_bytes;
    gpu_buffer indices;  // 32-bit; none: not indexed
    size_t index_offset; // bytes
    uint32_t count;      // indices, or vertices
    uint32_t instances;  // 0 is 1
    int32_t vertex_offset;
    enum gpu_cull cull;
    bool flip_front; // mirrored transform
};
void gpu_draw(struct gpu_cmd *cmd, const struct gpu_draw_desc *desc);
void gpu_render_end(struct gpu_cmd *cmd);

void gpu_clear_image(struct gpu_cmd *cmd, gpu_image image,
                     const float value[4]); // all mips and layers
void gpu_fill_buffer(struct gpu_cmd *cmd, gpu_buffer buffer, size_t offset, size_t bytes,
                     uint32_t word);
void gpu_copy_image(struct gpu_cmd *cmd, gpu_image to,
                    gpu_image from); // same format and size, all mips and layers
void gpu_copy_buffer(struct gpu_cmd *cmd, gpu_buffer to, size_t to_offset, gpu_buffer from,
                     size_t from_offset, size_t bytes);

// Small data for this frame, in a ring: a binding for a uniform or storage block of that name.
// Never fails: when the ring is full it grows, and the old one lives until the GPU is done.
struct gpu_binding gpu_transient(struct gpu_cmd *cmd, const char *name, const void *data,
                                 size_t bytes);

// ---- Scopes, timing, memory
// ---------------------------------------------------------------------------------

// From here to the matching pop, objects and scopes named without a dot belong to `owner`: "cones"
// is "vct.cones". The innermost owner counts. `owner` outlives the pop.
void gpu_owner_push(struct gpu *gpu, const char *owner);
void gpu_owner_pop(struct gpu *gpu);

// A debug label and a pair of timestamps. Scopes nest; a name seen twice in a frame is summed.
void gpu_scope_begin(struct gpu_cmd *cmd, const char *name);
void gpu_scope_end(struct gpu_cmd *cmd);

struct gpu_timing {
    char name[48];
    double ms;
};
// Times of the newest finished frame, in the order first begun, innermost scopes; "frame" is the
// whole. Returns the count. gpu_wait first to get the frame just ended.
int gpu_frame_timings(const struct gpu *gpu, struct gpu_timing *out, int capacity);

struct gpu_memory {
    char owner[32];
    uint64_t bytes;
};
// Bytes now, by owner, largest first. Returns the count.
int gpu_memory_by_owner(const struct gpu *gpu, struct gpu_memory *out, int capacity);

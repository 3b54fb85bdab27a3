// A thin layer over Vulkan 1.3, and its only public header. It contains no Vulkan types.
//
// Objects are small handles into tables of the device; a zeroed handle is empty, and destroying it
// does nothing. Every object has a name "owner.thing"; gpu_memory counts its bytes for the owner.
// Destruction is deferred until the GPU no longer uses the object.
//
// Barriers and image layouts are automatic: shader reflection tells which bindings are read or
// written, and each dispatch and rendering waits for exactly the earlier accesses that it depends
// on. Hazards between draws of one rendering are not tracked.
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

// ---- Device -------------------------------------------------------------------------------------

struct gpu_device_info {
    char name[256], driver[256];
    enum { GPU_CPU, GPU_INTEGRATED, GPU_DISCRETE, GPU_OTHER } type;
    bool usable;       // meets all requirements
    char missing[256]; // missing requirements if not usable
};

// Fills at most `capacity` entries and sets *count to the number of devices. false: no Vulkan
// instance.
bool gpu_list_devices(struct host *host, struct gpu_device_info *out, int capacity, int *count);

// Device memory that the caller allocates; see ag_memory_callbacks.
struct gpu_memory_request {
    uint64_t bytes, alignment;
    uint32_t memory_type; // index
    bool mapped;
};
struct gpu_memory_block {
    void *memory; // VkDeviceMemory
    uint64_t offset;
    void *mapped; // at the offset
    void *handle; // the caller's own
};
struct gpu_memory_callbacks {
    bool (*allocate)(void *user, const struct gpu_memory_request *request,
                     struct gpu_memory_block *out);
    void (*free)(void *user, const struct gpu_memory_request *request,
                 const struct gpu_memory_block *block);
    void *user;
};

// A caller's own device (Vulkan handles as void *). It must have been created with the features
// that gpu_required_features lists. The caller keeps it alive and idles it before gpu_destroy.
struct gpu_adopt {
    void *instance, *physical_device, *device, *queue;
    void *upload_queue;    // may be `queue`; NULL: uploads use that
    uint32_t queue_family; // of both
    // Around submissions to either queue; or NULL.
    void (*lock_queue)(void *user), (*unlock_queue)(void *user);
    void *user;
    const void *enabled_features; // VkPhysicalDeviceFeatures2 of vkCreateDevice; NULL: not checked
    struct gpu_memory_callbacks memory;   // zero: the layer allocates
    const void *vk_allocation_callbacks;  // VkAllocationCallbacks, copied; NULL: the driver's
    void (*get_instance_proc_addr)(void); // PFN_vkGetInstanceProcAddr; NULL: the linked one
};
// Sets the required features in these four structs (VkPhysicalDeviceFeatures2 and those of Vulkan
// 1.1 to 1.3), which it zeroes and chains. Returns the number of device extensions, at most 2; 0:
// get_instance_proc_addr (as in gpu_adopt) lacks a function. instance NULL: the linked loader.
uint32_t gpu_fill_requirements(void *instance, void *physical_device,
                               void (*get_instance_proc_addr)(void), void *features2,
                               void *vulkan11, void *vulkan12, void *vulkan13,
                               const char *extensions[2]);

struct gpu_desc {
    const char *device; // index from gpu_list_devices, part of a name, or NULL for the best
    bool validation; // validation and synchronization validation; fails when the layer is missing
    const char *shader_dir; // X.spv in this folder overrides the embedded shader X; NULL: no folder
    const struct gpu_adopt *adopt; // NULL: the layer creates the device
    // From gpu_pipeline_cache_read, of any device; untrusted. What does not fit is ignored.
    const void *pipeline_cache;
    size_t pipeline_cache_bytes;
};

struct gpu *gpu_create(struct host *host, const struct gpu_desc *desc);
void gpu_destroy(struct gpu *gpu); // waits; logs objects that were not destroyed
const struct gpu_device_info *gpu_info(const struct gpu *gpu);
const char *gpu_required_features(void); // one name per line
// Validation errors and warnings so far (0 when validation is off). Tests fail on any.
int gpu_validation_messages(const struct gpu *gpu);
int gpu_live_objects(const struct gpu *gpu);

struct gpu_limits {
    uint32_t max_image_2d, max_image_3d, max_layers, max_push_bytes, max_groups[3];
    uint64_t max_storage_bytes, memory_bytes;
    bool timestamps, geometry_shader, ray_query;
};
const struct gpu_limits *gpu_limits(const struct gpu *gpu);

// ---- Resources ----------------------------------------------------------------------------------

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
    GPU_RG32U,
    GPU_RGBA32U,
    GPU_B10G11R11F,
    GPU_D32F,
    GPU_FORMAT_COUNT,
    // Formats of a caller's images alone (gpu_image_import).
    GPU_RG16 = GPU_FORMAT_COUNT,
    GPU_RGBA16,
    GPU_RGBA16_SNORM,
    GPU_A2B10G10R10,
    GPU_BGRA8,
    GPU_BGRA8_SRGB,
    GPU_D16,
    GPU_D24,
    GPU_D24_S8,
    GPU_D32F_S8,
    GPU_IMPORT_FORMAT_COUNT
};
int gpu_format_bytes(enum gpu_format format); // per texel
int gpu_format_channels(enum gpu_format format);
const char *gpu_format_name(enum gpu_format format);
enum gpu_format gpu_format_of_vk(uint32_t vk_format); // GPU_FORMAT_NONE: none of them

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
    // 3D: depth; 2D arrays: layers; cubes: 6; cube arrays: 6 × cubes; 2D: 1. 0 is the default.
    uint32_t depth;
    uint32_t mips;  // 0 is 1
    uint32_t usage; // gpu_image_usage; copies and clears are always allowed
    // Memory aliasing: images of one client with the same text here share memory if a new one needs
    // no more than one that exists, and at least two fifths of it. The content of one lasts until
    // another is used, and no operation uses two. NULL, or client 0: memory of its own.
    const char *alias;
};

// A new image is zeroed on the GPU before its first use. false: the size is 0 or beyond the limits,
// or no memory.
bool gpu_image_create(struct gpu *gpu, const struct gpu_image_desc *desc, gpu_image *out);
void gpu_image_destroy(struct gpu *gpu, gpu_image *image); // zeroes *image
const struct gpu_image_desc *gpu_image_info(const struct gpu *gpu, gpu_image image);
// Wraps a caller's VkImage (not owned). `layout` is its current VkImageLayout; see
// gpu_image_handle.
bool gpu_image_wrap(struct gpu *gpu, const struct gpu_image_desc *desc, void *vk_image,
                    uint32_t layout, gpu_image *out);
// The VkImage, and its VkImageLayout at the end of each frame; it must have this layout again when
// the next frame begins. From now on each frame waits for all earlier submissions, since the caller
// may use the image between frames; the caller waits for the frame. NULL: no such image.
void *gpu_image_handle(const struct gpu *gpu, gpu_image image, uint32_t *layout);
struct gpu_image_handles {
    void *image, *view;             // VkImage, VkImageView of all of it
    uint32_t format, usage, layout; // VkFormat, VkImageUsageFlags, VkImageLayout
};
// The same for a caller that binds the image before the first frame, too: it is brought into that
// layout now, a new one zeroed. false: no such image, or the device is lost.
bool gpu_image_share(struct gpu *gpu, gpu_image image, struct gpu_image_handles *out);
// The reverse: wraps a caller's image that is to be sampled, once format, usage and layout are what
// desc says and gpu_image_share would return. `view` is not needed. false: the message has desc's
// name.
bool gpu_image_import(struct gpu *gpu, const struct gpu_image_desc *desc,
                      const struct gpu_image_handles *handles, gpu_image *out);

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
enum gpu_wrap { GPU_REPEAT, GPU_MIRROR, GPU_CLAMP };
struct gpu_sampler_desc {
    const char *name;
    enum gpu_filter filter, mip_filter;
    enum gpu_wrap wrap_u, wrap_v, wrap_w;
    bool compare_greater; // comparison sampler for reversed-Z shadow maps: 1 if reference ≥ texel
};
// Equal descriptions share one sampler; gpu_destroy frees them.
bool gpu_sampler_get(struct gpu *gpu, const struct gpu_sampler_desc *desc, gpu_sampler *out);

// Blocking transfers for initialisation and for reading results; not for per-frame code. They wait
// for frames in flight; with gpu_adopt.upload_queue, uploads into objects that no frame and no
// download has used do not.
// One mip of one layer, or of a whole 3D image.
bool gpu_image_upload(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                      const void *texels, size_t bytes);
// Box filter from mip 0; the format must support blits.
bool gpu_image_generate_mips(struct gpu *gpu, gpu_image image);
bool gpu_buffer_upload(struct gpu *gpu, gpu_buffer buffer, size_t offset, const void *data,
                       size_t bytes);
bool gpu_image_download(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                        void *texels, size_t bytes);
// Converts any format (half, unorm, snorm, srgb) to 32-bit floats, `channels` per texel.
bool gpu_image_download_float(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer,
                              float *texels, int channels, size_t float_count);
bool gpu_buffer_download(struct gpu *gpu, gpu_buffer buffer, size_t offset, void *data,
                         size_t bytes);

// Asynchronous readback. gpu_readback_copy records a copy of part of a buffer; gpu_readback_poll
// returns true and the bytes once the GPU has completed that frame. A second copy before then
// replaces the first.
struct gpu_readback {
    gpu_buffer buffer; // mapped
    uint64_t serial;   // of the frame; 0: none
};
bool gpu_readback_create(struct gpu *gpu, const char *name, size_t bytes, struct gpu_readback *out);
void gpu_readback_destroy(struct gpu *gpu, struct gpu_readback *readback);
void gpu_readback_copy(struct gpu_cmd *cmd, struct gpu_readback *to, size_t to_offset,
                       gpu_buffer from, size_t from_offset, size_t bytes);
// One texel of a colour image of one mip and layer.
void gpu_readback_copy_texel(struct gpu_cmd *cmd, struct gpu_readback *to, size_t to_offset,
                             gpu_image from, uint32_t x, uint32_t y);
// Each copy is returned once.
bool gpu_readback_poll(struct gpu *gpu, struct gpu_readback *readback, void *out, size_t bytes);

// ---- Pipelines ----------------------------------------------------------------------------------

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

enum gpu_compare { GPU_ALWAYS, GPU_GREATER };
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
    float depth_bias_slope; // as in Vulkan; negative for reversed Z
    enum gpu_blend blend;
    // Triangle lists without vertex input (vertex pulling); the cull mode is set per draw. Vulkan
    // clip space (y down, row 0 at y = -1); front faces are counter-clockwise in the image.
};
bool gpu_graphics_pipeline_create(struct gpu *gpu, const struct gpu_graphics_desc *desc,
                                  gpu_pipeline *out);
// Equal pipelines are compiled once; a destroyed one is kept for the next creation of an equal one.
void gpu_pipeline_destroy(struct gpu *gpu, gpu_pipeline *pipeline);
// Rebuilds pipelines whose .spv in shader_dir changed and returns their number. On an invalid
// shader the old pipeline stays, with a warning.
int gpu_reload_shaders(struct gpu *gpu);
// Compiles pipelines on another thread: it takes the creation of pipelines and gpu_owner_… alone.
// All hosts have the same allocator. Created and destroyed on the thread of `gpu`. Handles of it
// are not needed and not destroyed. NULL: no memory.
struct gpu *gpu_compiler_create(const struct gpu *gpu, struct host *host);
void gpu_compiler_set_host(struct gpu *compiler, struct host *host); // of its thread
uint32_t gpu_compiler_count(const struct gpu *compiler);             // pipelines that it has
// On the thread of `gpu`, which keeps the pipelines for later creations of equal ones. Accepts
// NULL.
void gpu_compiler_destroy(struct gpu *compiler, struct gpu *gpu);
// Pipelines that the driver compiled so far, for gpu_desc.pipeline_cache. Sets *bytes to the size
// and writes all. out NULL: the size alone. false: more than `capacity`, or out of memory.
bool gpu_pipeline_cache_read(struct gpu *gpu, void *out, size_t capacity, size_t *bytes);

// ---- Tables of objects --------------------------------------------------------------------------

enum gpu_kind { GPU_BUFFER, GPU_READBACK, GPU_IMAGE, GPU_SAMPLER, GPU_PIPELINE };

// An object of a state: its handle is the member at this offset. Conditions are in what it has: a
// buffer of 0 bytes, an image of width 0 and a pipeline without a shader are not created. A sampler
// is linear and clamped.
struct gpu_object {
    enum gpu_kind kind;
    const char *name;
    size_t member;
    bool of_view;    // its size is that of a view, with which it is created again
    size_t bytes;    // of a buffer (GPU_BUFFER_STORAGE) or a readback
    uint32_t usage;  // of a buffer, in addition
    uint32_t consts; // of a pipeline: bits of gpu_objects.constants
    const struct gpu_shader *vertex, *shader; // vertex: a graphics pipeline without targets
    struct gpu_image_desc image;              // but for its name
};

enum { GPU_MAX_OBJECTS = 288, GPU_MAX_CONSTANTS = 16 };
struct gpu_objects {
    int count;
    struct gpu_object at[GPU_MAX_OBJECTS];
    struct gpu_constant constants[GPU_MAX_CONSTANTS]; // that pipelines choose from
    int left_out;                                     // rows beyond GPU_MAX_OBJECTS
};

void gpu_objects_clear(struct gpu_objects *table); // constants stay
// Adds rows whose members are those of a struct at this offset of the state.
void gpu_objects_add(struct gpu_objects *table, size_t base, const struct gpu_object *rows,
                     size_t count);
#define GPU_ADD(table, base, ...)                                                                  \
    gpu_objects_add(table, base, (const struct gpu_object[]){ __VA_ARGS__ },                       \
                    sizeof((const struct gpu_object[]){ __VA_ARGS__ }) /                           \
                        sizeof(struct gpu_object))
// Those from the row `first` on; false, too, where rows were left out. gpu_objects_destroy then
// frees what was created; it accepts any half-built state.
bool gpu_objects_create(struct gpu *gpu, const struct gpu_objects *table, int first, void *state);
void gpu_objects_destroy(struct gpu *gpu, const struct gpu_objects *table, void *state);
// The pipelines of the table alone, for a compiler.
bool gpu_objects_compile(struct gpu *compiler, const struct gpu_objects *table);
// Bytes of buffers and texels, without what a driver pads.
uint64_t gpu_objects_bytes(const struct gpu_objects *table);

// ---- Commands -----------------------------------------------------------------------------------

enum {
    GPU_FRAMES_IN_FLIGHT = 2, // submitted by the layer
    GPU_ADOPTED_FRAMES = 8,   // recorded into a caller's command buffers
    GPU_PENDING_FRAMES = GPU_FRAMES_IN_FLIGHT + GPU_ADOPTED_FRAMES,
};
// Frames are recorded one at a time: begin, record, end (submits, does not wait). At most
// GPU_FRAMES_IN_FLIGHT frames are in flight: gpu_frame_begin waits for the oldest. NULL: device
// lost.
struct gpu_cmd *gpu_frame_begin(struct gpu *gpu);
bool gpu_frame_end(struct gpu *gpu, struct gpu_cmd *cmd);
// Records into a caller's VkCommandBuffer (in the recording state, outside of a rendering).
// gpu_frame_end then does not submit: the caller submits its buffers in the order of recording, and
// calls gpu_frame_adopted_done once the GPU has completed one. At most GPU_ADOPTED_FRAMES are
// pending.
struct gpu_cmd *gpu_frame_begin_adopted(struct gpu *gpu, void *vk_command_buffer);
void gpu_frame_adopted_done(struct gpu *gpu, struct gpu_cmd *cmd);
bool gpu_wait(struct gpu *gpu); // until all submissions are complete; false: device lost

// An image (with a sampler, if the shader samples it) or a buffer, bound to a name in the shader.
struct gpu_binding {
    const char *name; // of the variable in GLSL; of the block for buffers
    gpu_image image;
    gpu_buffer buffer;
    gpu_sampler sampler; // empty: nearest, clamped (for texelFetch)
    uint32_t mip;        // storage images: the mip; sampled images: the first mip of the view
    bool one_mip;        // sampled images: only that mip
    uint32_t layer;      // with one_layer: the layer of an array, viewed as 2D
    bool one_layer;
    size_t offset, bytes; // buffers; bytes 0: to the end
};
#define GPU_BIND(...)                                                                              \
    (const struct gpu_binding[]){ __VA_ARGS__ },                                                   \
        (int)(sizeof((const struct gpu_binding[]){ __VA_ARGS__ }) / sizeof(struct gpu_binding))

// All bindings of the shader are required (asserted), others are ignored. A group count of 0
// dispatches nothing.
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
    bool load;           // keep the content; else clear
    float clear[4];      // depth: clear[0]
};
struct gpu_render_desc {
    struct gpu_target color[8];
    int color_count;
    struct gpu_target depth; // empty image: no depth
    uint32_t width, height;
    // Resources that the draws read; barriers for them are recorded before the rendering begins.
    const struct gpu_binding *reads;
    int read_count;
};
void gpu_render_begin(struct gpu_cmd *cmd, const struct gpu_render_desc *desc);
enum gpu_cull { GPU_CULL_NONE, GPU_CULL_BACK, GPU_CULL_FRONT };
struct gpu_draw_desc {
    gpu_pipeline pipeline;
    const struct gpu_binding *bindings;
    int binding_count;
    const void *push;
    size_t push_bytes;
    gpu_buffer indices;  // 32-bit; empty: not indexed
    size_t index_offset; // bytes
    uint32_t count;      // indices, or vertices
    enum gpu_cull cull;
    bool flip_front; // for mirrored transforms
};
void gpu_draw(struct gpu_cmd *cmd, const struct gpu_draw_desc *desc);
void gpu_render_end(struct gpu_cmd *cmd);

// All mips and layers.
void gpu_clear_image(struct gpu_cmd *cmd, gpu_image image, const float value[4]);
void gpu_fill_buffer(struct gpu_cmd *cmd, gpu_buffer buffer, size_t offset, size_t bytes,
                     uint32_t word);
// Same format and size; all mips and layers.
void gpu_copy_image(struct gpu_cmd *cmd, gpu_image to, gpu_image from);
// One texel of a colour image of one mip and layer to a buffer.
void gpu_copy_texel(struct gpu_cmd *cmd, gpu_buffer to, size_t to_offset, gpu_image from,
                    uint32_t x, uint32_t y);
void gpu_copy_buffer(struct gpu_cmd *cmd, gpu_buffer to, size_t to_offset, gpu_buffer from,
                     size_t from_offset, size_t bytes);

// Copies small data for this frame into a ring buffer; returns a binding for the uniform or storage
// block of that name. A full ring is replaced by a larger one.
struct gpu_binding gpu_transient(struct gpu_cmd *cmd, const char *name, const void *data,
                                 size_t bytes);

// ---- Scopes, timing, memory ---------------------------------------------------------------------

// From here to the matching pop, objects and scopes named without a dot belong to `owner`: "cones"
// is "vct.cones". The innermost owner counts. `owner` outlives the pop.
void gpu_owner_push(struct gpu *gpu, const char *owner);
void gpu_owner_pop(struct gpu *gpu);

// A debug label and a pair of timestamps. Scopes nest; times of equal names in a frame are added.
void gpu_scope_begin(struct gpu_cmd *cmd, const char *name);
void gpu_scope_end(struct gpu_cmd *cmd);

struct gpu_timing {
    char name[48];
    double ms;
};
// Times of the innermost scopes of the newest completed frame, in the order of their first begin;
// "frame" is the total. Returns the count. Call gpu_wait first for the frame just ended.
int gpu_frame_timings(const struct gpu *gpu, struct gpu_timing *out, int capacity);

struct gpu_memory {
    char owner[32];
    uint64_t bytes;
};
// Current bytes by owner, largest first. Returns the count.
int gpu_memory_by_owner(const struct gpu *gpu, struct gpu_memory *out, int capacity);

// A client shares the device with others, as several renderers do: times and memory are also kept
// for each. Client 0 is the device itself, to which transient and staging buffers ("gpu") belong.
uint32_t gpu_client_add(struct gpu *gpu); // 0: no memory
void gpu_client_remove(struct gpu *gpu, uint32_t client);
// New objects and recordings belong to `client` until the next call.
void gpu_client_set(struct gpu *gpu, uint32_t client);
// As gpu_frame_timings, of the client's newest frame that the GPU has completed. Does not wait.
int gpu_client_timings(struct gpu *gpu, uint32_t client, struct gpu_timing *out, int capacity);
int gpu_client_memory(const struct gpu *gpu, uint32_t client, struct gpu_memory *out, int capacity);

// Events since the creation of the device.
struct gpu_counters {
    uint64_t images, buffers;        // created
    uint64_t pipelines;              // created
    uint64_t compiled;               // of these, not taken from the pool of destroyed ones
    uint64_t frames, transfers;      // submitted; frames in a caller's command buffer too
    uint64_t upload_queue_transfers; // of the transfers
    uint64_t passes;                 // scopes begun
};
const struct gpu_counters *gpu_counters(const struct gpu *gpu);

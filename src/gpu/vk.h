// Private to src/gpu: the device, its objects, and functions that the .c files share.
#pragma once

#include "gpu/gpu.h"
#include "gpu/vulkan_functions.h"

#include <vulkan/vulkan.h>

enum {
    CMD_TRANSFER = GPU_FRAMES_IN_FLIGHT, // frames are before it
    CMD_UPLOAD,                          // transfers on the upload queue
    CMD_ADOPTED,                         // the first of the adopted frames
    CMD_COUNT = CMD_ADOPTED + GPU_ADOPTED_FRAMES,
    MAX_BINDINGS = 32, // the least maxPushDescriptors that VK_KHR_push_descriptor allows
    MAX_COLORS = 8,
    MAX_STAGES = 2,
    MAX_SCOPES = 128,
    NAME_SIZE = 64,
    MAX_OWNERS = 4, // nested
    BATCH_IMAGES = 16,
};

// ---- Failure (vk.c) -----------------------------------------------------------------------------

// Calls a function of gpu->vk. True on VK_SUCCESS; else logs its name and the result, and notes a
// lost device.
#define VK_CALL(gpu, function, ...) vk_check((gpu), (gpu)->vk.function(__VA_ARGS__), "vk" #function)
bool vk_check(struct gpu *gpu, VkResult result, const char *function);
// A function that cannot be loaded, by its name. Returns false.
bool vk_missing(struct host *host, const char *function);
#define GPU_DRIVER_HINT                                                                            \
    "install a driver: the package mesa-vulkan-drivers (vulkan-swrast on Arch) has one for the "   \
    "CPU"
const char *vk_result_name(VkResult result);
// API misuse: logged, and asserted in debug builds. Returns false.
bool gpu_misuse(struct gpu *gpu, const char *format, ...) __attribute__((format(printf, 2, 3)));
void vk_name(struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name);
// Vulkan handles are pointers or 64-bit integers, depending on the platform.
#define VK_NAME(gpu, type, handle, name) vk_name((gpu), (type), (uint64_t)(handle), (name))

// ---- Handles (table.c) --------------------------------------------------------------------------

// Objects by id: index + 1 in the low 20 bits, a generation above, which detects stale ids.
struct table {
    void **objects;
    uint32_t *generations;
    uint32_t count, capacity, live;
};
uint32_t table_add(struct host *host, struct table *table, void *object); // 0: no memory
void *table_get(const struct table *table, uint32_t id); // NULL: none, or destroyed
void *table_remove(struct table *table, uint32_t id);
void table_finish(struct host *host, struct table *table);

// ---- Memory (memory.c) --------------------------------------------------------------------------

enum memory_kind {
    MEMORY_DEVICE,   // device-local
    MEMORY_UPLOAD,   // mapped, coherent
    MEMORY_DOWNLOAD, // mapped, coherent, cached if available
    MEMORY_RING,     // mapped, coherent, device-local if available
};

// A piece of device memory: a whole VkDeviceMemory, or what the caller's callback returned.
struct device_memory {
    struct gpu_memory_request request;
    struct gpu_memory_block block; // memory NULL: none
};
// device_memory.c. false without a message: this memory type is exhausted, or cannot be mapped.
bool device_memory_allocate(struct gpu *gpu, const struct gpu_memory_request *request,
                            const char *name, struct device_memory *out);
void device_memory_free(struct gpu *gpu, const struct device_memory *memory);

struct memory_block;
struct allocation {
    struct memory_block *block; // NULL: none
    VkDeviceMemory memory;
    VkDeviceSize offset, bytes;
    void *mapped; // at offset; NULL for MEMORY_DEVICE
    uint32_t owner;
    uint32_t type; // of memory, index
    bool recycled; // the memory was in use before
};

struct memory_owner {
    char name[32];
    uint32_t client;
    uint64_t bytes; // 0: the entry may be reused
};

struct memory {
    VkPhysicalDeviceMemoryProperties properties;
    VkDeviceSize max_allocation;
    struct memory_block *blocks;
    uint32_t block_count;
    struct memory_owner *owners;
    uint32_t owner_count;
};

// linear: for buffers; images have separate blocks (bufferImageGranularity). The owner is the part
// of `name` before the dot.
bool memory_allocate(struct gpu *gpu, const VkMemoryRequirements *needs, enum memory_kind kind,
                     bool linear, const char *name, struct allocation *out);
void memory_free(struct gpu *gpu, struct allocation *allocation);
void memory_finish(struct gpu *gpu);

// ---- Hazards (hazard.c) -------------------------------------------------------------------------

// Last accesses to a buffer or to one subresource of an image.
struct hazard {
    VkPipelineStageFlags2 write_stages; // of the last write or layout transition
    VkAccessFlags2 write_access;
    VkPipelineStageFlags2 visible;     // stages to which that write is visible
    VkPipelineStageFlags2 read_stages; // of reads since that write
    VkImageLayout layout;
    bool op_wrote; // whether `op` wrote
    uint64_t op;   // last operation with an access
};

struct access {
    VkPipelineStageFlags2 stages;
    bool write;
    VkImageLayout layout; // images only
};

// Pending barriers of the next command: one memory barrier, and one per layout transition.
struct batch {
    VkMemoryBarrier2 memory;
    VkImageMemoryBarrier2 images[BATCH_IMAGES];
    uint32_t image_count;
};

// ---- Memory aliasing (alias.c) ------------------------------------------------------------------

// Memory of images that are used one after the other.
struct alias {
    char name[NAME_SIZE];
    uint32_t client;
    uint32_t users, alive; // images: not freed, not destroyed
    struct allocation memory;
    struct image *current; // used last; NULL: none, or destroyed
    struct hazard last;    // accesses of destroyed images
};
// Memory for a new image without one, shared with the images of that name if it fits.
bool alias_allocate(struct gpu *gpu, struct image *image, const char *name,
                    const VkMemoryRequirements *needs);
void alias_retire(struct image *image); // it is destroyed: new images do not join it
void alias_release(struct gpu *gpu, struct image *image);
// Before each access to an image that has an alias.
void alias_use(struct gpu_cmd *cmd, struct image *image);

struct range { // of subresources
    uint32_t mip, mip_count, layer, layer_count;
};

// ---- Resources ----------------------------------------------------------------------------------

struct image_view {
    VkImageViewType type;
    struct range range;
    VkImageView handle;
};

struct image {
    struct gpu_image_desc desc; // with defaults filled in; desc.name is `name`
    char name[NAME_SIZE];
    VkImage handle;
    VkImageAspectFlags aspect; // that shaders sample
    uint32_t layers;           // 1 for 3D images
    bool wrapped;              // the caller's VkImage
    bool shared;       // the caller may use it between frames: wrapped, or its handle was queried
    bool zero_pending; // not yet cleared
    bool used;         // by a recording for the main queue
    bool whole;        // hazards[0] is the state of all subresources
    struct hazard *hazards; // [layer × mips + mip]
    struct image_view *views;
    uint32_t view_count;
    struct alias *alias;      // has the memory; NULL: none
    bool retired;             // destroyed, but not yet freed
    struct allocation memory; // empty with an alias
};

struct buffer {
    char name[NAME_SIZE];
    VkBuffer handle;
    size_t bytes;    // as requested
    size_t capacity; // rounded up to whole words, for fills
    bool zero_pending;
    bool used;     // by a recording for the main queue
    bool constant; // read-only for the GPU: no hazards
    struct hazard hazard;
    struct allocation memory;
};

struct sampler {
    struct gpu_sampler_desc desc; // without the name
    VkSampler handle;
};

struct image *image_get(const struct gpu *gpu, gpu_image image);
VkImageUsageFlags image_usage(const struct gpu_image_desc *desc);
VkImageView image_view(struct gpu *gpu, struct image *image, VkImageViewType type,
                       const struct range *range);
static inline struct range image_whole(const struct image *image)
{
    return (struct range){ 0, image->desc.mips, 0, image->layers };
}
// Width, height and depth of a mip.
VkExtent3D image_extent(const struct image *image, uint32_t mip);
bool image_check_part(struct gpu *gpu, const struct image *image, uint32_t mip, uint32_t layer);
size_t image_part_bytes(const struct image *image, uint32_t mip);
void image_free(struct gpu *gpu, void *image);

struct buffer *buffer_get(const struct gpu *gpu, gpu_buffer buffer);
// Without a handle, and not zeroed.
struct buffer *buffer_new(struct gpu *gpu, const char *name, size_t bytes, uint32_t usage,
                          enum memory_kind kind);
void buffer_free(struct gpu *gpu, void *buffer);

// Empty handle: nearest, clamped. NULL: stale handle.
VkSampler sampler_handle(struct gpu *gpu, gpu_sampler sampler);
void samplers_finish(struct gpu *gpu);

struct format {
    VkFormat vk;
    uint8_t bytes, channels;
    const char *name;
};
VkImageAspectFlags format_aspects(enum gpu_format format); // all that an image has
const struct format *format_of(enum gpu_format format);
void format_to_float(enum gpu_format format, const void *texel, float out[4]);
VkClearColorValue format_clear(enum gpu_format format, const float value[4]);

// ---- Shaders and pipelines ----------------------------------------------------------------------

struct shader_binding {
    char name[NAME_SIZE];
    uint32_t binding;
    VkDescriptorType type;
    VkImageViewType view; // images
    VkShaderStageFlags shader_stages;
    VkPipelineStageFlags2 stages;
    bool writes;
};

struct reflection {
    struct shader_binding bindings[MAX_BINDINGS];
    int binding_count;
    uint32_t push_bytes;
    VkShaderStageFlags push_stages;
    uint32_t constant_ids[64];
    int constant_count;
};
// Adds the interface of one stage. `what` names the shader in messages.
bool reflect_stage(struct gpu *gpu, const uint32_t *words, size_t word_count, const char *what,
                   VkShaderStageFlagBits stage, struct reflection *out);

struct shader_stage {
    VkShaderStageFlagBits stage;
    struct gpu_shader embedded; // words of static storage
    char name[NAME_SIZE];
    int64_t stamp; // of the file in shader_dir when last read; 0: no file
};

struct pipeline {
    char name[NAME_SIZE];
    uint32_t users; // handles of equal pipelines
    bool graphics;
    struct shader_stage stages[MAX_STAGES];
    int stage_count;
    struct gpu_constant *constants;
    int constant_count;
    struct gpu_graphics_desc desc; // graphics only; pointers are cleared
    int color_count;

    struct reflection reflection;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline handle;
};
struct pipeline *pipeline_get(const struct gpu *gpu, gpu_pipeline pipeline);
void pipeline_free(struct gpu *gpu, void *pipeline);
void pipeline_release(struct gpu *gpu, void *pipeline); // frees with the last user
VkResult pipeline_create_graphics(struct gpu *gpu, struct pipeline *pipeline,
                                  const VkPipelineShaderStageCreateInfo *stages);

// pipeline_pool.c. Destroyed pipelines, which recordings may still use.
enum { POOLED_PIPELINES = 512 };
struct pipeline_pool {
    struct pipeline *pipelines[POOLED_PIPELINES]; // in the order of their destruction
    int count;
};
// A pipeline with the name, shaders, constants and fixed state of `like`; NULL: there is none, or
// its shaders are files.
struct pipeline *pipeline_pool_take(struct pipeline_pool *pool, const struct pipeline *like);
bool pipeline_is_equal(const struct pipeline *a, const struct pipeline *b);
// The same among those that were not destroyed.
struct pipeline *pipeline_find_equal(const struct table *pipelines, const struct pipeline *like);
// Returns the pipeline to free: the oldest, `pipeline` if its shaders are files, or NULL.
struct pipeline *pipeline_pool_give(struct pipeline_pool *pool, struct pipeline *pipeline);
struct pipeline *pipeline_pool_remove_oldest(struct pipeline_pool *pool); // NULL: empty

// Pipelines of other threads, which nothing uses yet.
enum { COMPILED_PIPELINES = 512 };
struct compiled_pipelines {
    struct pipeline **at; // in the order of their compilation
    int count;
};
// pipeline_pool.c. The first as pipeline_pool_take.
struct pipeline *compiled_take(struct compiled_pipelines *list, const struct pipeline *like);
struct pipeline *compiled_remove(struct compiled_pipelines *list, int index);
void compiled_finish(struct gpu *gpu); // compiler.c

// ---- Commands -----------------------------------------------------------------------------------

struct rendering {
    bool open;    // between gpu_render_begin and gpu_render_end
    bool active;  // between vkCmdBeginRendering and vkCmdEndRendering
    bool begun;   // was active before: the next begin loads
    bool invalid; // after a misuse: draws nothing
    struct gpu_target colors[MAX_COLORS], depth;
    int color_count;
    uint32_t width, height;
    uint64_t op;
};

enum { MAX_REPLACED_RINGS = 40 }; // each ring is twice as large as the previous one

struct ring { // transient data
    gpu_buffer buffer;
    size_t used;
    gpu_buffer replaced[MAX_REPLACED_RINGS]; // still used by bindings of this recording
    int replaced_count;
};

struct scope {
    char name[48];
    uint32_t first_query, last_query; // UINT32_MAX: not timed
    bool outer;                       // contains other scopes
};

struct scopes {
    VkQueryPool queries;
    struct scope list[MAX_SCOPES];
    uint32_t count; // timed or not
    uint32_t query_count;
    uint32_t stack[16], depth;
};

enum cmd_state { CMD_FREE, CMD_RECORDING, CMD_PENDING };

struct queue {
    VkQueue handle;       // NULL: there is none
    VkSemaphore timeline; // counts its submissions
    uint64_t submitted;   // semaphore value of the newest submission
};

struct gpu_cmd {
    struct gpu *gpu;
    struct queue *queue; // that executes the commands
    enum cmd_state state;
    bool adopted;
    bool broken;       // a command could not be recorded: gpu_frame_end fails
    uint32_t client;   // see gpu_client_set
    uint64_t serial;   // of frames and transfers, in recording order
    uint64_t timeline; // semaphore value that the submission signals
    VkCommandPool pool;
    VkCommandBuffer buffer;
    uint64_t op; // see hazard.op
    struct batch batch;
    struct rendering rendering;
    struct ring ring;
    struct scopes scopes;
    VkPipeline bound[2]; // compute, graphics
};

void ring_stop(struct gpu_cmd *cmd);   // destroys (deferred) the replaced rings
void ring_finish(struct gpu_cmd *cmd); // the GPU must be idle
// Begins a new operation for hazard tracking.
void hazard_next_op(struct gpu_cmd *cmd);
// Queues the barriers that `access` needs and records the access. Zeroes the resource before its
// first use.
void hazard_image(struct gpu_cmd *cmd, struct image *image, const struct range *range,
                  const struct access *access);
void hazard_buffer(struct gpu_cmd *cmd, struct buffer *buffer, const struct access *access);
// The image or buffer will be overwritten entirely and need not be zeroed.
void hazard_overwrite_image(struct image *image);
void hazard_overwrite_buffer(struct buffer *buffer);
void hazard_flush(struct gpu_cmd *cmd); // records the queued barriers, outside of any rendering
// The caller may have accessed the image in any way, and left it in `layout`.
void hazard_external_use(struct image *image, VkImageLayout layout);
// Initial state of an object in recycled memory.
struct hazard hazard_recycled(void);
VkImageLayout hazard_transfer_layout(const struct image *image, bool write);
VkImageLayout hazard_shader_layout(const struct image *image); // for access by shaders

// Matches bindings to the shader by name, queues their barriers, fills one write per shader
// binding.
struct bound_set {
    VkWriteDescriptorSet writes[MAX_BINDINGS];
    VkDescriptorImageInfo images[MAX_BINDINGS];
    VkDescriptorBufferInfo buffers[MAX_BINDINGS];
};
bool bind_prepare(struct gpu_cmd *cmd, const struct pipeline *pipeline,
                  const struct gpu_binding *bindings, int binding_count, size_t push_bytes,
                  struct bound_set *set);
void bind_record(struct gpu_cmd *cmd, const struct pipeline *pipeline, const struct bound_set *set,
                 const void *push);
// Subresources that a sampled binding covers.
struct range bind_sampled_range(const struct image *image, const struct gpu_binding *binding,
                                VkImageViewType view);

// render_targets.c. The subresource of a target; 3D images have one state for all slices.
struct range render_target_range(const struct image *image, const struct gpu_target *target);
bool render_has_target(const struct gpu_cmd *cmd, const struct image *image,
                       const struct range *range);
void render_suspend(struct gpu_cmd *cmd); // ends an active rendering; the next draw resumes it

bool cmd_init(struct gpu *gpu, struct gpu_cmd *cmd, bool adopted);
void cmd_finish(struct gpu *gpu, struct gpu_cmd *cmd);
// On the main queue. NULL: a frame is being recorded, or the device is lost.
struct gpu_cmd *transfer_begin(struct gpu *gpu);
// The same on the upload queue, if it takes the object.
struct gpu_cmd *transfer_begin_image(struct gpu *gpu, const struct image *image);
struct gpu_cmd *transfer_begin_buffer(struct gpu *gpu, const struct buffer *buffer);
bool transfer_end(struct gpu *gpu, struct gpu_cmd *cmd); // submits and waits

bool scopes_init(struct gpu *gpu, struct scopes *scopes, const char *name);
void scopes_start(struct gpu_cmd *cmd);
void scopes_stop(struct gpu_cmd *cmd);
void scopes_collect(struct gpu_cmd *cmd); // reads timestamps of a completed recording
void ring_start(struct gpu_cmd *cmd);

// client.c
struct frame_times {
    struct gpu_timing list[MAX_SCOPES + 1];
    int count;
    uint64_t serial; // of the recording; 0: none
};
struct client {
    uint32_t number;
    struct frame_times times;
};
struct client *client_find(const struct gpu *gpu, uint32_t number); // NULL: none, or removed

// ---- The device ---------------------------------------------------------------------------------

// timeline.c
bool timeline_create(struct gpu *gpu, struct queue *queue, const char *name);
bool timeline_wait(struct gpu *gpu, const struct queue *queue, uint64_t value); // false: lost
bool timeline_wait_all(struct gpu *gpu); // for all submissions
// Serial up to which the GPU has completed every recording; returns their commands to CMD_FREE.
uint64_t timeline_completed_serial(struct gpu *gpu);

// upload_queue.c. Whether it executes the uploads of an object.
bool upload_queue_takes_image(const struct gpu *gpu, const struct image *image);
bool upload_queue_takes_buffer(const struct gpu *gpu, const struct buffer *buffer);
// Whether the main queue has not waited for the newest upload.
bool upload_queue_is_ahead(const struct gpu *gpu);

// submit.c. Submits the command buffer, or none if it is NULL. The main queue waits for the uploads
// before.
bool queue_submit(struct gpu *gpu, struct queue *queue, VkCommandBuffer commands);
// Makes all uploads visible to what is submitted to the main queue from now on.
bool queue_join_uploads(struct gpu *gpu);

// deferred_delete.c. An object is freed once the GPU has completed all recordings up to `serial`.
struct deferred_delete {
    uint64_t serial;
    void (*free)(struct gpu *gpu, void *object);
    void *object;
};
void deferred_delete_add(struct gpu *gpu, void (*free)(struct gpu *gpu, void *object),
                         void *object);
void deferred_delete_collect(struct gpu *gpu); // frees what the GPU no longer uses
void deferred_delete_finish(struct gpu *gpu);  // frees all; the device must be idle

// "owner.name" in `out` where an owner is pushed and the name is without one, else the name.
const char *owner_name(const struct gpu *gpu, const char *name, char out[NAME_SIZE]);

struct gpu {
    struct host *host;
    struct gpu_device_info info;
    struct gpu_limits limits;
    VkPhysicalDeviceLimits vk_limits;
    uint32_t max_push_descriptors;
    double ns_per_tick;
    uint64_t tick_mask;
    char *shader_dir;

    bool adopted;
    struct gpu_adopt adopt;
    struct vulkan_functions vk;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    int validation_messages;
    const char *owners[MAX_OWNERS];
    uint32_t owner_depth;
    VkPhysicalDevice physical;
    VkDevice device; // NULL until its functions are loaded
    // Allocator of all objects of the device: NULL, or a copy of the caller's.
    const VkAllocationCallbacks *allocator;
    VkAllocationCallbacks allocator_copy;
    struct queue queue, upload_queue; // the main queue, and a caller's second one
    uint64_t joined;                  // value of upload_queue.timeline that `queue` waited for
    uint32_t queue_family;            // of both
    bool lost;

    VkPipelineCache pipeline_cache;
    struct memory memory;
    struct alias **aliases;
    uint32_t alias_count;
    struct table images, buffers, samplers, pipelines;
    struct pipeline_pool pipeline_pool;
    struct compiled_pipelines compiled;
    bool compiler;             // of another thread: has pipelines alone, see compiler.c
    uint32_t internal_buffers; // rings, not counted as live objects
    gpu_sampler default_sampler;
    struct buffer *staging[2]; // upload, download

    uint64_t serial; // of the newest recording
    uint64_t ops;
    struct gpu_cmd cmds[CMD_COUNT];
    uint32_t next_frame;
    struct gpu_cmd *recording; // NULL: none

    struct deferred_delete *deferred;
    size_t deferred_count, deferred_capacity;
    struct frame_times times; // of the newest frame of any client
    struct client *clients;
    uint32_t client_count, newest_client; // newest_client: the last number given
    uint32_t client;                      // of new objects and recordings
    struct gpu_counters counters;
};

// pipeline_cache.c. NULL: an empty one.
bool pipeline_cache_create(struct gpu *gpu, const void *bytes, size_t size);
// instance.c
bool instance_create(struct host *host, bool validation, struct vulkan_functions *vk,
                     VkInstance *out);
bool instance_watch(struct gpu *gpu); // counts validation messages from now on
// device.c
VkPhysicalDevice device_choose(struct host *host, const struct vulkan_functions *vk,
                               VkInstance instance, const char *wanted);
void device_describe(const struct vulkan_functions *vk, VkPhysicalDevice physical,
                     struct gpu_device_info *out);
// The first required feature that a chain of vkCreateDevice does not enable; NULL: none is known.
const char *device_missing_feature(const void *chain);
bool device_family_is_usable(const struct gpu *gpu, uint32_t family);
bool device_create(struct gpu *gpu);
bool device_use(struct gpu *gpu, VkDevice device); // loads its functions
void device_read_limits(struct gpu *gpu);

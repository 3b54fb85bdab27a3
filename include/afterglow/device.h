/// GPUs: the library opens a Vulkan device or uses the caller's.
#ifndef AFTERGLOW_DEVICE_H
#define AFTERGLOW_DEVICE_H

#include <afterglow/context.h>

AG_BEGIN

struct ag_device;

struct ag_device_info {
    char name[256], driver[256];
    bool software;        ///< runs on the CPU
    bool usable;          ///< supports everything that the library needs
    char missing[256];    ///< unsupported features, if not usable
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};

/// Writes at most `capacity` entries; *count is the number of devices. Thread: the context's.
AG_API enum ag_result ag_device_list(struct ag_context *context, struct ag_device_info *out,
                                     int capacity, int *count);

/// Device memory that the library asks its program for.
struct ag_memory_request {
    uint64_t bytes, alignment;
    uint32_t vk_memory_type; ///< index of the memory type
    bool mapped;             ///< must be mapped, and stay so until it is freed
    uint64_t reserved[4];    ///< 0; see ABI in types.h
};
/// The memory that it returns: a VkDeviceMemory or a part of one.
struct ag_memory_block {
    void *vk_memory;      ///< VkDeviceMemory
    uint64_t offset;      ///< in it, a multiple of the alignment
    void *mapped;         ///< address of the offset; NULL unless it was to be mapped
    void *handle;         ///< of the program, for `free`
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// All device memory of the library comes from these two callbacks, in blocks of mostly 64 MiB, in
/// which it places its resources; 16 MiB and more are blocks of their own. Callbacks run within the
/// library's functions, on the calling thread, and must not call the library.
struct ag_memory_callbacks {
    /// false: there is none; the library tries fewer bytes or another memory type, then the
    /// function that needs it returns AG_ERROR_MEMORY. *out is zeroed before.
    bool (*allocate)(void *user, const struct ag_memory_request *request,
                     struct ag_memory_block *out);
    /// With what `allocate` got and returned. The GPU does not use the block any more.
    void (*free)(void *user, const struct ag_memory_request *request,
                 const struct ag_memory_block *block);
    void *user;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};

/// A caller's Vulkan handles. The device must have enabled Vulkan 1.3, VK_KHR_push_descriptor and
/// the features of ag_device_required_features; <afterglow/vulkan.h> fills them in. The handles
/// must stay valid until the device is destroyed (ag_device_destroy).
struct ag_device_adopt {
    void *instance, *physical_device, *device, *queue;
    uint32_t queue_family;            ///< of both queues
    void (*lock_queue)(void *user);   ///< called before each submission to either; may be NULL
    void (*unlock_queue)(void *user); ///< called after it; may be NULL
    void *user;
    /// VkPhysicalDeviceFeatures2 that vkCreateDevice was given, with its chain: a required feature
    /// that it does not enable is an error. NULL: not checked, Vulkan cannot tell.
    const void *vk_enabled_features;
    const struct ag_memory_callbacks *memory; ///< NULL: the library allocates device memory
    /// VkAllocationCallbacks for the host memory of all Vulkan objects of the library; its
    /// pUserData must stay valid as long as the handles. NULL: the driver's.
    const void *vk_allocation_callbacks;
    /// PFN_vkGetInstanceProcAddr that loads every Vulkan function of this device, for a program
    /// with a loader of its own; the functions must stay valid as long as the handles. NULL: the
    /// loader that the library is linked with.
    void (*get_instance_proc_addr)(void);
    /// A second VkQueue of the same family: uploads of new objects go there, and do not wait for
    /// frames in flight. It may be `queue`, which saves no wait. NULL: uploads go to `queue`.
    void *upload_queue;
};

struct ag_device_desc {
    const char *device; ///< index in ag_device_list, part of a name, or NULL for the best
    bool validation;    ///< enable Vulkan validation and its synchronization checks; default false
    const struct ag_device_adopt *adopt; ///< NULL: the library opens a device
    /// Bytes of ag_device_pipeline_cache from an earlier run, needed only during the call. Damaged
    /// ones and those of another device or driver are ignored (AG_LOG_INFO says so); do not pass
    /// what an attacker could have written. NULL: none.
    const void *pipeline_cache;
    size_t pipeline_cache_bytes;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};

/// Thread: any.
AG_API void ag_device_desc_default(struct ag_device_desc *desc);
/// desc NULL: the defaults. Thread: the context's.
AG_API enum ag_result ag_device_create(struct ag_context *context,
                                       const struct ag_device_desc *desc, struct ag_device **out);
/// A device that renderers use stays until the last of them is destroyed, and what it adopted must
/// stay valid until then; a warning says so. Thread: the context's.
AG_API void ag_device_destroy(struct ag_device *device);
/// Thread: the context's.
AG_API void ag_device_get_info(const struct ag_device *device, struct ag_device_info *out);
/// Vulkan features that an adopted device must enable, one name per line; a static string.
/// Thread: any.
AG_API const char *ag_device_required_features(void);
/// Number of messages from the validation layers so far; 0 without validation.
/// Thread: the context's.
AG_API int ag_device_validation_messages(const struct ag_device *device);
/// Copies what the driver has compiled so far to `out`, for ag_device_desc.pipeline_cache of later
/// runs: call it when all renderers are created. *bytes is the size; out NULL: the size alone. Too
/// little `capacity` is AG_ERROR_ARGUMENT. Thread: the context's.
AG_API enum ag_result ag_device_pipeline_cache(struct ag_device *device, void *out, size_t capacity,
                                               size_t *bytes);

/// Counts of objects created and work submitted on a device so far.
struct ag_device_counters {
    uint64_t images, buffers, pipelines; ///< created
    uint64_t compiled;  ///< of the pipelines: compiled, not reused after their destruction
    uint64_t frames;    ///< recorded
    uint64_t transfers; ///< blocking uploads and downloads
    uint64_t passes;    ///< of frames, recorded
    uint64_t upload_queue_transfers; ///< of the transfers: on ag_device_adopt.upload_queue
    uint64_t reserved[6];            ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API void ag_device_get_counters(const struct ag_device *device, struct ag_device_counters *out);

struct ag_memory {
    char owner[32]; ///< a technique, "frame", "scene" or "gpu"
    uint64_t bytes;
};
/// GPU memory that the library allocated on a device, by owner. Returns the number of owners and
/// writes at most `capacity`. See ag_renderer_memory. Thread: the context's.
AG_API int ag_device_memory(struct ag_device *device, struct ag_memory *out, int capacity);

AG_END

#endif

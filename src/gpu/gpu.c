// Creation and destruction of the device and of the objects that all recordings share.
#include "gpu/vk.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

// As far as Vulkan tells what a device was created with.
static bool check_adopted(struct gpu *gpu)
{
    if (!device_family_is_usable(gpu, gpu->queue_family))
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu device %s: queue family %u has no graphics and compute",
                         gpu->info.name, gpu->queue_family);
    const char *missing = device_missing_feature(gpu->adopt.enabled_features);
    return !missing || host_fail(gpu->host, FAIL_ARGUMENT,
                                 "gpu device %s: it was created without the feature %s",
                                 gpu->info.name, missing);
}

static bool adopt_device(struct gpu *gpu, const struct gpu_adopt *adopt)
{
    if (!adopt->instance || !adopt->physical_device || !adopt->device || !adopt->queue) {
        return host_fail(
            gpu->host, FAIL_ARGUMENT,
            "gpu adopted device: instance, physical_device, device and queue must be there");
    }
    if (!adopt->lock_queue != !adopt->unlock_queue) {
        return host_fail(
            gpu->host, FAIL_ARGUMENT,
            "gpu adopted device: lock_queue and unlock_queue come together or not at all");
    }
    gpu->adopted = true;
    gpu->adopt = *adopt;
    gpu->instance = adopt->instance;
    gpu->physical = adopt->physical_device;
    gpu->queue.handle = adopt->queue;
    gpu->upload_queue.handle = adopt->upload_queue;
    gpu->queue_family = adopt->queue_family;
    if (adopt->vk_allocation_callbacks) {
        gpu->allocator_copy = *(const VkAllocationCallbacks *)adopt->vk_allocation_callbacks;
        gpu->allocator = &gpu->allocator_copy;
    }
    const char *missing = vulkan_load_instance(
        &gpu->vk, gpu->instance, (PFN_vkGetInstanceProcAddr)adopt->get_instance_proc_addr);
    if (missing) return vk_missing(gpu->host, missing);
    device_describe(&gpu->vk, gpu->physical, &gpu->info);
    if (gpu->info.usable) return check_adopted(gpu) && device_use(gpu, adopt->device);
    return host_fail(gpu->host, FAIL_UNSUPPORTED, "gpu device %s: it lacks %s", gpu->info.name,
                     gpu->info.missing);
}

static bool open_device(struct gpu *gpu, const struct gpu_desc *desc)
{
    if (desc->adopt) {
        if (!adopt_device(gpu, desc->adopt)) return false;
        return !desc->validation || instance_watch(gpu);
    }
    if (!instance_create(gpu->host, desc->validation, &gpu->vk, &gpu->instance)) return false;
    if (desc->validation && !instance_watch(gpu)) return false;
    gpu->physical = device_choose(gpu->host, &gpu->vk, gpu->instance, desc->device);
    if (!gpu->physical) return false;
    device_describe(&gpu->vk, gpu->physical, &gpu->info);
    return device_create(gpu);
}

static bool create_shared(struct gpu *gpu, const struct gpu_desc *desc)
{
    if (!timeline_create(gpu, &gpu->queue, "gpu.timeline")) return false;
    if (gpu->upload_queue.handle &&
        !timeline_create(gpu, &gpu->upload_queue, "gpu.upload_timeline"))
        return false;
    if (!pipeline_cache_create(gpu, desc->pipeline_cache, desc->pipeline_cache_bytes)) return false;
    for (int i = 0; i < CMD_COUNT; i++) {
        if (!cmd_init(gpu, &gpu->cmds[i], i >= CMD_ADOPTED)) return false;
    }
    return gpu_sampler_get(
        gpu,
        &(struct gpu_sampler_desc){
            .name = "gpu.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP },
        &gpu->default_sampler);
}

struct gpu *gpu_create(struct host *host, const struct gpu_desc *desc)
{
    struct gpu *gpu = host_alloc(host, 1, sizeof *gpu);
    if (!gpu) return NULL;
    gpu->host = host;
    if (!open_device(gpu, desc)) goto fail;
    device_read_limits(gpu);
    if (desc->shader_dir && desc->shader_dir[0]) {
        gpu->shader_dir = host_strdup(host, desc->shader_dir);
        if (!gpu->shader_dir) goto fail;
        if (access(gpu->shader_dir, R_OK | X_OK) != 0)
            host_log(host, LOG_WARNING, "gpu shaders %s: %s; the embedded ones are used",
                     gpu->shader_dir, strerror(errno));
    }
    if (!create_shared(gpu, desc)) goto fail;
    host_log(host, LOG_INFO, "gpu device %s (%s)%s", gpu->info.name, gpu->info.driver,
             desc->validation ? ", with validation" : "");
    return gpu;
fail:
    gpu_destroy(gpu);
    return NULL;
}

// Logs and frees objects that the caller did not destroy. name_offset: of the object's name.
static void free_table(struct gpu *gpu, struct table *table, const char *kind, size_t name_offset,
                       void (*free)(struct gpu *gpu, void *object))
{
    for (uint32_t i = 0; i < table->count; i++) {
        if (!table->objects[i]) continue;
        host_log(gpu->host, LOG_ERROR, "gpu %s %s: it was never destroyed", kind,
                 (const char *)table->objects[i] + name_offset);
        free(gpu, table->objects[i]);
    }
    table_finish(gpu->host, table);
}

static void free_objects(struct gpu *gpu)
{
    for (int i = 0; i < CMD_COUNT; i++) cmd_finish(gpu, &gpu->cmds[i]);
    deferred_delete_finish(gpu);
    for (struct pipeline *p; (p = pipeline_pool_remove_oldest(&gpu->pipeline_pool));)
        pipeline_free(gpu, p);
    compiled_finish(gpu);
    free_table(gpu, &gpu->pipelines, "pipeline", offsetof(struct pipeline, name), pipeline_release);
    free_table(gpu, &gpu->images, "image", offsetof(struct image, name), image_free);
    free_table(gpu, &gpu->buffers, "buffer", offsetof(struct buffer, name), buffer_free);
    samplers_finish(gpu);
    for (int i = 0; i < 2; i++) buffer_free(gpu, gpu->staging[i]);
    gpu->vk.DestroySemaphore(gpu->device, gpu->queue.timeline, gpu->allocator);
    gpu->vk.DestroySemaphore(gpu->device, gpu->upload_queue.timeline, gpu->allocator);
    gpu->vk.DestroyPipelineCache(gpu->device, gpu->pipeline_cache, gpu->allocator);
}

void gpu_destroy(struct gpu *gpu)
{
    if (!gpu) return;
    if (gpu->device) {
        gpu_wait(gpu);
        free_objects(gpu);
        host_free(gpu->host, gpu->aliases);
        memory_finish(gpu);
        if (!gpu->adopted) gpu->vk.DestroyDevice(gpu->device, NULL);
    }
    if (gpu->messenger) gpu->vk.DestroyDebugUtilsMessengerEXT(gpu->instance, gpu->messenger, NULL);
    if (gpu->instance && !gpu->adopted) gpu->vk.DestroyInstance(gpu->instance, NULL);
    host_free(gpu->host, gpu->shader_dir);
    host_free(gpu->host, gpu->clients);
    host_free(gpu->host, gpu);
}

const struct gpu_device_info *gpu_info(const struct gpu *gpu)
{
    return &gpu->info;
}

int gpu_validation_messages(const struct gpu *gpu)
{
    return gpu->validation_messages;
}

int gpu_live_objects(const struct gpu *gpu)
{
    return (int)(gpu->images.live + gpu->buffers.live + gpu->pipelines.live -
                 gpu->internal_buffers);
}

const struct gpu_limits *gpu_limits(const struct gpu *gpu)
{
    return &gpu->limits;
}

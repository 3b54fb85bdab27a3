// Devices: forwards to gpu/.
#include "api/objects.h"

#include "gpu/gpu.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

static void info_out(struct ag_device_info *out, const struct gpu_device_info *info)
{
    *out = (struct ag_device_info){ .software = info->type == GPU_CPU, .usable = info->usable };
    snprintf(out->name, sizeof out->name, "%s", info->name);
    snprintf(out->driver, sizeof out->driver, "%s", info->driver);
    snprintf(out->missing, sizeof out->missing, "%s", info->missing);
}

enum ag_result ag_device_list(struct ag_context *context, struct ag_device_info *out, int capacity,
                              int *count)
{
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, count);
    *count = 0;
    AG_REQUIRE(context, capacity >= 0, "capacity %d is negative", capacity);
    AG_REQUIRE(context, out || capacity == 0, "out is NULL");
    struct gpu_device_info *infos = host_alloc(&context->host, (size_t)capacity, sizeof *infos);
    bool ok = infos && gpu_list_devices(&context->host, infos, capacity, count);
    for (int i = 0; ok && i < *count && i < capacity; i++) info_out(&out[i], &infos[i]);
    host_free(&context->host, infos);
    return api_done(context, ok);
}

void ag_device_desc_default(struct ag_device_desc *desc)
{
    if (desc) *desc = (struct ag_device_desc){ 0 };
}

static bool adopt_is_whole(const struct ag_device_adopt *adopt)
{
    return adopt->instance && adopt->physical_device && adopt->device && adopt->queue;
}

// ---- Memory of the program

static struct ag_memory_request request_out(const struct gpu_memory_request *request)
{
    return (struct ag_memory_request){ .bytes = request->bytes,
                                       .alignment = request->alignment,
                                       .vk_memory_type = request->memory_type,
                                       .mapped = request->mapped };
}

static bool allocate_memory(void *user, const struct gpu_memory_request *wanted,
                            struct gpu_memory_block *out)
{
    const struct ag_device *device = user;
    const struct ag_memory_request request = request_out(wanted);
    struct ag_memory_block block = { 0 };
    if (!device->memory.allocate(device->memory.user, &request, &block)) return false;
    *out = (struct gpu_memory_block){ .memory = block.vk_memory,
                                      .offset = block.offset,
                                      .mapped = block.mapped,
                                      .handle = block.handle };
    return true;
}

static void free_memory(void *user, const struct gpu_memory_request *wanted,
                        const struct gpu_memory_block *given)
{
    const struct ag_device *device = user;
    const struct ag_memory_request request = request_out(wanted);
    const struct ag_memory_block block = { .vk_memory = given->memory,
                                           .offset = given->offset,
                                           .mapped = given->mapped,
                                           .handle = given->handle };
    device->memory.free(device->memory.user, &request, &block);
}

static struct gpu_adopt lent_device(struct ag_device *device, const struct ag_device_adopt *lent)
{
    struct gpu_adopt out = { .instance = lent->instance,
                             .physical_device = lent->physical_device,
                             .device = lent->device,
                             .queue = lent->queue,
                             .upload_queue = lent->upload_queue,
                             .queue_family = lent->queue_family,
                             .lock_queue = lent->lock_queue,
                             .unlock_queue = lent->unlock_queue,
                             .user = lent->user,
                             .enabled_features = lent->vk_enabled_features,
                             .vk_allocation_callbacks = lent->vk_allocation_callbacks,
                             .get_instance_proc_addr = lent->get_instance_proc_addr };
    if (!lent->memory) return out;
    device->memory = *lent->memory;
    out.memory = (struct gpu_memory_callbacks){ allocate_memory, free_memory, device };
    return out;
}

// ---- Creation

static enum ag_result adopt_check(const char *function, struct ag_context *context,
                                  const struct ag_device_adopt *lent)
{
    if (!lent) return AG_OK;
    AG_REQUIRE_FOR(function, context, adopt_is_whole(lent),
                   "an adopted device needs instance, physical_device, device and queue");
    if (!lent->memory) return AG_OK;
    AG_REQUIRE_KNOWN(function, context, lent->memory);
    AG_REQUIRE_FOR(function, context, lent->memory->allocate && lent->memory->free,
                   "memory needs allocate and free");
    return AG_OK;
}

static bool has_shaders(const char *folder)
{
    DIR *entries = opendir(folder);
    bool found = false;
    for (const struct dirent *entry; entries && !found && (entry = readdir(entries));) {
        const size_t length = strlen(entry->d_name);
        found = length > 4 && strcmp(entry->d_name + length - 4, ".spv") == 0;
    }
    if (entries) closedir(entries);
    return found;
}

static void warn_of_shader_dir(struct ag_context *context)
{
    if (context->shader_dir && !has_shaders(context->shader_dir))
        host_log(&context->host, LOG_WARNING,
                 "AFTERGLOW_SHADER_DIR %s: no .spv file can be found in it; the embedded shaders "
                 "are used",
                 context->shader_dir);
}

enum ag_result ag_device_create(struct ag_context *context, const struct ag_device_desc *desc,
                                struct ag_device **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    struct ag_device_desc fallback;
    ag_device_desc_default(&fallback);
    if (!desc) desc = &fallback;
    AG_REQUIRE_KNOWN(__func__, context, desc);
    const enum ag_result checked = adopt_check(__func__, context, desc->adopt);
    if (checked != AG_OK) return checked;
    AG_REQUIRE(context, desc->pipeline_cache || desc->pipeline_cache_bytes == 0,
               "pipeline_cache is NULL");
    warn_of_shader_dir(context);
    struct ag_device *device = host_alloc(&context->host, 1, sizeof *device);
    if (!device) return api_done(context, false);
    struct gpu_adopt adopt = { 0 };
    if (desc->adopt) adopt = lent_device(device, desc->adopt);
    struct gpu_desc gpu_desc = { .device = desc->device,
                                 .validation = desc->validation || context->validation,
                                 .shader_dir = context->shader_dir,
                                 .adopt = desc->adopt ? &adopt : NULL,
                                 .pipeline_cache = desc->pipeline_cache,
                                 .pipeline_cache_bytes = desc->pipeline_cache_bytes };
    device->context = context;
    api_context_use(context);
    device->adopted = desc->adopt != NULL;
    device->gpu = gpu_create(&context->host, &gpu_desc);
    if (!device->gpu) {
        ag_device_destroy(device);
        return api_done(context, false);
    }
    *out = device;
    return api_done(context, true);
}

static void free_device(struct ag_device *device)
{
    struct ag_context *context = device->context;
    if (device->gpu) gpu_destroy(device->gpu);
    host_free(&context->host, device);
    api_context_release(context);
}

void api_device_release(struct ag_device *device)
{
    if (lifetime_release(&device->life)) free_device(device);
}

void ag_device_destroy(struct ag_device *device)
{
    if (!device) return;
    if (lifetime_destroy(&device->life))
        free_device(device);
    else if (device->adopted)
        host_log(
            &device->context->host, LOG_WARNING,
            "ag_device_destroy: renderers or preparations still use the device (%d); its Vulkan "
            "handles must stay valid until they are destroyed",
            device->life.users);
}

void ag_device_get_info(const struct ag_device *device, struct ag_device_info *out)
{
    if (!out) return;
    *out = (struct ag_device_info){ 0 };
    if (device) info_out(out, gpu_info(device->gpu));
}

const char *ag_device_required_features(void)
{
    return gpu_required_features();
}

enum ag_result ag_device_pipeline_cache(struct ag_device *device, void *out, size_t capacity,
                                        size_t *bytes)
{
    struct ag_context *context = device ? device->context : NULL;
    AG_REQUIRE_POINTER(context, bytes);
    *bytes = 0;
    AG_REQUIRE_POINTER(context, device);
    return api_done(context, gpu_pipeline_cache_read(device->gpu, out, capacity, bytes));
}

int ag_device_validation_messages(const struct ag_device *device)
{
    return device ? gpu_validation_messages(device->gpu) : 0;
}

void ag_device_get_counters(const struct ag_device *device, struct ag_device_counters *out)
{
    if (!out) return;
    *out = (struct ag_device_counters){ 0 };
    if (!device) return;
    const struct gpu_counters *counters = gpu_counters(device->gpu);
    out->images = counters->images;
    out->buffers = counters->buffers;
    out->pipelines = counters->pipelines;
    out->compiled = counters->compiled;
    out->frames = counters->frames;
    out->transfers = counters->transfers;
    out->passes = counters->passes;
    out->upload_queue_transfers = counters->upload_queue_transfers;
}

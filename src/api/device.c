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
    const struct ag_device_adopt *lent = desc->adopt;
    if (lent) AG_REQUIRE_KNOWN(__func__, context, lent);
    AG_REQUIRE(context, !lent || adopt_is_whole(lent),
               "an adopted device needs instance, physical_device, device and queue");

    AG_REQUIRE(context, desc->pipeline_cache || desc->pipeline_cache_bytes == 0,
               "pipeline_cache is NULL");
    struct gpu_adopt adopt = { 0 };
    if (lent)
        adopt = (struct gpu_adopt){
            lent->instance,           lent->physical_device, lent->device,       lent->queue,
            lent->queue_family,       lent->lock_queue,      lent->unlock_queue, lent->user,
            lent->vk_enabled_features
        };
    struct gpu_desc gpu_desc = { .device = desc->device,
                                 .validation = desc->validation || context->validation,
                                 .shader_dir = context->shader_dir,
                                 .adopt = lent ? &adopt : NULL,
                                 .pipeline_cache = desc->pipeline_cache,
                                 .pipeline_cache_bytes = desc->pipeline_cache_bytes };
    warn_of_shader_dir(context);
    struct ag_device *device = host_alloc(&context->host, 1, sizeof *device);
    if (!device) return api_done(context, false);
    device->context = context;
    device->adopted = lent != NULL;
    device->gpu = gpu_create(&context->host, &gpu_desc);
    if (!device->gpu) {
        ag_device_destroy(device);
        return api_done(context, false);
    }
    *out = device;
    return api_done(context, true);
}

void ag_device_destroy(struct ag_device *device)
{
    if (!device) return;
    if (device->gpu) gpu_destroy(device->gpu);
    host_free(&device->context->host, device);
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
}

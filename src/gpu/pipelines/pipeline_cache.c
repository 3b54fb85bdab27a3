// The driver's pipeline cache from and to bytes of the caller, which may be of another driver,
// damaged or forged: Vulkan checks only that they are of the same driver and device. A header of
// our own with a hash comes first.
#include "gpu/vk.h"

#include "core/hash.h"

#include <string.h>

enum { MAGIC_BYTES = 8 };
static const char MAGIC[MAGIC_BYTES + 1] = "AGCACHE1";

struct header {
    char magic[MAGIC_BYTES];
    uint64_t bytes; // of Vulkan's data, which follow
    uint64_t hash;  // of them
    uint64_t zero;
};

// The reason why the data behind the header do not fit; NULL: they fit.
static const char *misfit(const struct gpu *gpu, const struct header *header, const char *data)
{
    VkPhysicalDeviceProperties device;
    VkPipelineCacheHeaderVersionOne vulkan;
    if (header->bytes < sizeof vulkan || hash_bytes(data, (size_t)header->bytes, 0) != header->hash)
        return "it is damaged";
    memcpy(&vulkan, data, sizeof vulkan);
    gpu->vk.GetPhysicalDeviceProperties(gpu->physical, &device);
    if (vulkan.headerSize < sizeof vulkan || vulkan.headerSize > header->bytes ||
        vulkan.headerVersion != VK_PIPELINE_CACHE_HEADER_VERSION_ONE)
        return "it is of an unknown version";
    if (vulkan.vendorID != device.vendorID || vulkan.deviceID != device.deviceID)
        return "it is of another device";
    if (memcmp(vulkan.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) != 0)
        return "it is of another driver";
    return NULL;
}

// Vulkan's data in the caller's bytes, or NULL.
static const char *accepted(const struct gpu *gpu, const void *bytes, size_t size,
                            size_t *data_bytes)
{
    struct header header;
    const char *data = NULL, *why = "it is not a pipeline cache";
    *data_bytes = 0;
    if (!bytes || size == 0) return NULL;
    if (size >= sizeof header) {
        memcpy(&header, bytes, sizeof header);
        data = (const char *)bytes + sizeof header;
        if (memcmp(header.magic, MAGIC, MAGIC_BYTES) == 0 && header.zero == 0)
            why =
                header.bytes == size - sizeof header ? misfit(gpu, &header, data) : "it is damaged";
    }
    if (!why) *data_bytes = size - sizeof header;
    host_log(gpu->host, LOG_INFO, "gpu pipeline cache of %zu bytes: %s", size,
             why ? why : "it is used");
    return why ? NULL : data;
}

bool pipeline_cache_create(struct gpu *gpu, const void *bytes, size_t size)
{
    size_t data_bytes;
    const char *data = accepted(gpu, bytes, size, &data_bytes);
    char *aligned = data ? host_alloc(gpu->host, data_bytes, 1) : NULL; // for the driver
    if (data && !aligned) return false;
    if (data) memcpy(aligned, data, data_bytes);
    const VkPipelineCacheCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                             .initialDataSize = data_bytes,
                                             .pInitialData = aligned };
    const bool ok =
        VK_CALL(gpu, CreatePipelineCache, gpu->device, &info, gpu->allocator, &gpu->pipeline_cache);
    host_free(gpu->host, aligned);
    return ok;
}

bool gpu_pipeline_cache_read(struct gpu *gpu, void *out, size_t capacity, size_t *bytes)
{
    size_t size;
    struct header header = { .zero = 0 };
    *bytes = 0;
    if (!VK_CALL(gpu, GetPipelineCacheData, gpu->device, gpu->pipeline_cache, &size, NULL))
        return false;
    *bytes = sizeof header + size;
    if (!out) return true;
    if (capacity < *bytes)
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu pipeline cache: it has %zu bytes, there is room for %zu", *bytes,
                         capacity);
    char *data = (char *)out + sizeof header;
    if (!VK_CALL(gpu, GetPipelineCacheData, gpu->device, gpu->pipeline_cache, &size, data))
        return false;
    memcpy(header.magic, MAGIC, MAGIC_BYTES);
    header.bytes = size;
    header.hash = hash_bytes(data, size, 0);
    memcpy(out, &header, sizeof header);
    *bytes = sizeof header + size;
    return true;
}

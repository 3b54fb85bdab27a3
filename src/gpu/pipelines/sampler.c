// Samplers, one per description, destroyed with the device.
#include "gpu/vk.h"

static VkSamplerAddressMode address_mode(enum gpu_wrap wrap)
{
    switch (wrap) {
    case GPU_REPEAT:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case GPU_MIRROR:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
        return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    }
}

static bool equal(const struct gpu_sampler_desc *a, const struct gpu_sampler_desc *b)
{
    return a->filter == b->filter && a->mip_filter == b->mip_filter && a->wrap_u == b->wrap_u &&
           a->wrap_v == b->wrap_v && a->wrap_w == b->wrap_w &&
           a->compare_greater == b->compare_greater;
}

static bool check_desc(struct gpu *gpu, const struct gpu_sampler_desc *d)
{
    const char *name = d->name ? d->name : "";
    if ((unsigned)d->filter > GPU_LINEAR || (unsigned)d->mip_filter > GPU_LINEAR ||
        (unsigned)d->wrap_u > GPU_CLAMP || (unsigned)d->wrap_v > GPU_CLAMP ||
        (unsigned)d->wrap_w > GPU_CLAMP) {
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu sampler %s: unknown filter or wrap", name);
    }
    return true;
}

static VkSamplerCreateInfo create_info(const struct gpu_sampler_desc *d)
{
    VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = d->filter == GPU_LINEAR ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
        .mipmapMode = d->mip_filter == GPU_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                  : VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = address_mode(d->wrap_u),
        .addressModeV = address_mode(d->wrap_v),
        .addressModeW = address_mode(d->wrap_w),
        .compareEnable = d->compare_greater,
        .compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    info.minFilter = info.magFilter;
    return info;
}

bool gpu_sampler_get(struct gpu *gpu, const struct gpu_sampler_desc *desc, gpu_sampler *out)
{
    out->id = 0;
    if (!check_desc(gpu, desc)) return false;
    for (uint32_t i = 0; i < gpu->samplers.count;
         i++) { // none is ever removed: an id is its index + 1
        struct sampler *known = gpu->samplers.objects[i];
        if (!equal(&known->desc, desc)) continue;
        out->id = i + 1;
        return true;
    }
    struct sampler *sampler = host_alloc(gpu->host, 1, sizeof *sampler);
    if (!sampler) return false;
    sampler->desc = *desc;
    sampler->desc.name = NULL;
    VkSamplerCreateInfo info = create_info(desc);
    if (!VK_CALL(gpu, CreateSampler, gpu->device, &info, gpu->allocator, &sampler->handle))
        goto fail;
    char name[NAME_SIZE];
    VK_NAME(gpu, VK_OBJECT_TYPE_SAMPLER, sampler->handle, owner_name(gpu, desc->name, name));
    out->id = table_add(gpu->host, &gpu->samplers, sampler);
    if (out->id) return true;
    gpu->vk.DestroySampler(gpu->device, sampler->handle, gpu->allocator);
fail:
    host_free(gpu->host, sampler);
    return false;
}

VkSampler sampler_handle(struct gpu *gpu, gpu_sampler handle)
{
    struct sampler *sampler =
        table_get(&gpu->samplers, handle.id ? handle.id : gpu->default_sampler.id);
    return sampler ? sampler->handle : VK_NULL_HANDLE;
}

void samplers_finish(struct gpu *gpu)
{
    for (uint32_t i = 0; i < gpu->samplers.count; i++) {
        struct sampler *sampler = gpu->samplers.objects[i];
        gpu->vk.DestroySampler(gpu->device, sampler->handle, gpu->allocator);
        host_free(gpu->host, sampler);
    }
    table_finish(gpu->host, &gpu->samplers);
}

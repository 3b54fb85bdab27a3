// Images and their views. A view is created at the first binding of a part, and cached in the
// image.
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

static uint32_t mip_size(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

VkExtent3D image_extent(const struct image *image, uint32_t mip)
{
    return (VkExtent3D){ mip_size(image->desc.width, mip), mip_size(image->desc.height, mip),
                         image->desc.dimension == GPU_3D ? mip_size(image->desc.depth, mip) : 1 };
}

size_t image_part_bytes(const struct image *image, uint32_t mip)
{
    VkExtent3D e = image_extent(image, mip);
    return (size_t)e.width * e.height * e.depth * format_of(image->desc.format)->bytes;
}

bool image_check_part(struct gpu *gpu, const struct image *image, uint32_t mip, uint32_t layer)
{
    if (mip < image->desc.mips && layer < image->layers) return true;
    return host_fail(gpu->host, FAIL_ARGUMENT,
                     "gpu image %s: no mip %u of layer %u; it has %u and %u", image->name, mip,
                     layer, image->desc.mips, image->layers);
}

// Replaces 0 by defaults.
static void complete(struct gpu_image_desc *desc)
{
    if (!desc->mips) desc->mips = 1;
    if (!desc->depth)
        desc->depth = desc->dimension == GPU_CUBE || desc->dimension == GPU_CUBE_ARRAY ? 6 : 1;
}

static bool check_shape(struct gpu *gpu, const struct gpu_image_desc *d)
{
    const VkPhysicalDeviceLimits *l = &gpu->vk_limits;
    bool volume = d->dimension == GPU_3D;
    bool cube = d->dimension == GPU_CUBE || d->dimension == GPU_CUBE_ARRAY;
    uint32_t side = volume ? l->maxImageDimension3D
                    : cube ? l->maxImageDimensionCube
                           : l->maxImageDimension2D;
    uint32_t depth = volume ? l->maxImageDimension3D : l->maxImageArrayLayers;
    if (!d->width || !d->height || d->width > side || d->height > side || d->depth > depth) {
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu image %s: %u x %u x %u is not within 1 to %u x %u x %u", d->name,
                         d->width, d->height, d->depth, side, side, depth);
    }
    if ((d->dimension == GPU_2D && d->depth != 1) || (d->dimension == GPU_CUBE && d->depth != 6) ||
        (cube && (d->depth % 6 || d->width != d->height))) {
        return host_fail(
            gpu->host, FAIL_ARGUMENT,
            "gpu image %s: %u x %u with %u layers does not fit its dimension (a 2D image has one "
            "layer, a cube six square ones)",
            d->name, d->width, d->height, d->depth);
    }
    uint32_t largest = d->width > d->height ? d->width : d->height;
    if (volume && d->depth > largest) largest = d->depth;
    uint32_t levels = 0;
    for (; largest; largest >>= 1) levels++;
    if (d->mips > levels) {
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu image %s: %u mips, its size has only %u",
                         d->name, d->mips, levels);
    }
    return true;
}

static bool check_desc(struct gpu *gpu, const struct gpu_image_desc *d)
{
    const uint32_t usages = GPU_SAMPLED | GPU_STORAGE | GPU_ATTACHMENT;
    if (!d->name || !d->name[0])
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu image: it has no name");
    if ((unsigned)d->dimension > GPU_CUBE_ARRAY || d->format <= GPU_FORMAT_NONE ||
        d->format >= GPU_IMPORT_FORMAT_COUNT || d->usage & ~usages) {
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu image %s: unknown dimension, format or usage", d->name);
    }
    return check_shape(gpu, d);
}

VkImageUsageFlags image_usage(const struct gpu_image_desc *d)
{
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (d->usage & GPU_SAMPLED) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (d->usage & GPU_STORAGE) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (d->usage & GPU_ATTACHMENT) {
        usage |= d->format == GPU_D32F ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                       : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    }
    return usage;
}

static VkImageCreateInfo create_info(const struct gpu_image_desc *d)
{
    bool volume = d->dimension == GPU_3D;
    VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
        .format = format_of(d->format)->vk,
        .extent = { d->width, d->height, volume ? d->depth : 1 },
        .mipLevels = d->mips,
        .arrayLayers = volume ? 1 : d->depth,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = image_usage(d),
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    if (d->dimension == GPU_CUBE || d->dimension == GPU_CUBE_ARRAY) {
        info.flags |= VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    }
    if (volume && d->usage & GPU_ATTACHMENT) info.flags |= VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT;
    return info;
}

static bool check_supported(struct gpu *gpu, const struct gpu_image_desc *d,
                            const VkImageCreateInfo *info)
{
    VkImageFormatProperties p;
    VkResult result = gpu->vk.GetPhysicalDeviceImageFormatProperties(
        gpu->physical, info->format, info->imageType, info->tiling, info->usage, info->flags, &p);
    if (result == VK_SUCCESS && info->extent.width <= p.maxExtent.width &&
        info->extent.height <= p.maxExtent.height && info->extent.depth <= p.maxExtent.depth &&
        info->arrayLayers <= p.maxArrayLayers && info->mipLevels <= p.maxMipLevels) {
        return true;
    }
    return host_fail(gpu->host, FAIL_UNSUPPORTED,
                     "gpu image %s: the device has no %s images of %u x %u x %u for %s%s%s",
                     d->name, format_of(d->format)->name, d->width, d->height, d->depth,
                     d->usage & GPU_SAMPLED ? "sampling " : "",
                     d->usage & GPU_STORAGE ? "storage " : "",
                     d->usage & GPU_ATTACHMENT ? "rendering" : "");
}

static struct image *image_new(struct gpu *gpu, const struct gpu_image_desc *desc)
{
    char name[NAME_SIZE];
    struct gpu_image_desc d = *desc;
    d.name = owner_name(gpu, d.name, name);
    complete(&d);
    if (gpu->lost) {
        host_fail(gpu->host, FAIL_DEVICE, "gpu image %s: the device was lost",
                  d.name ? d.name : "");
        return NULL;
    }
    if (!check_desc(gpu, &d)) return NULL;
    struct image *image = host_alloc(gpu->host, 1, sizeof *image);
    if (!image) return NULL;
    image->desc = d;
    snprintf(image->name, sizeof image->name, "%s", d.name);
    image->desc.name = image->name;
    image->desc.alias = NULL;
    image->layers = d.dimension == GPU_3D ? 1 : d.depth;
    image->aspect = format_aspects(d.format) & ~(VkImageAspectFlags)VK_IMAGE_ASPECT_STENCIL_BIT;
    image->whole = true;
    image->hazards = host_alloc(gpu->host, (size_t)d.mips * image->layers, sizeof *image->hazards);
    if (!image->hazards) {
        host_free(gpu->host, image);
        return NULL;
    }
    return image;
}

static bool allocate(struct gpu *gpu, struct image *image, const char *alias)
{
    VkMemoryRequirements needs;
    gpu->vk.GetImageMemoryRequirements(gpu->device, image->handle, &needs);
    if (alias && gpu->client) return alias_allocate(gpu, image, alias, &needs);
    return memory_allocate(gpu, &needs, MEMORY_DEVICE, false, image->name, &image->memory);
}

static bool create_handle(struct gpu *gpu, struct image *image, const char *alias)
{
    VkImageCreateInfo info = create_info(&image->desc);
    if (!check_supported(gpu, &image->desc, &info)) return false;
    if (!VK_CALL(gpu, CreateImage, gpu->device, &info, gpu->allocator, &image->handle)) {
        image->handle = VK_NULL_HANDLE;
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_IMAGE, image->handle, image->name);
    if (!allocate(gpu, image, alias)) return false;
    const struct allocation *memory = image->alias ? &image->alias->memory : &image->memory;
    if (memory->recycled) image->hazards[0] = hazard_recycled();
    return VK_CALL(gpu, BindImageMemory, gpu->device, image->handle, memory->memory,
                   memory->offset);
}

bool gpu_image_create(struct gpu *gpu, const struct gpu_image_desc *desc, gpu_image *out)
{
    out->id = 0;
    if (desc->format >= GPU_FORMAT_COUNT)
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu image %s: its format cannot be created",
                         desc->name ? desc->name : "");
    deferred_delete_collect(gpu);
    struct image *image = image_new(gpu, desc);
    if (!image) return false;
    image->zero_pending = true;
    if (!create_handle(gpu, image, desc->alias)) goto fail;
    out->id = table_add(gpu->host, &gpu->images, image);
    if (!out->id) goto fail;
    gpu->counters.images++;
    return true;
fail:
    image_free(gpu, image);
    return false;
}

bool gpu_image_wrap(struct gpu *gpu, const struct gpu_image_desc *desc, void *vk_image,
                    uint32_t layout, gpu_image *out)
{
    out->id = 0;
    if (!vk_image)
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu image %s: no VkImage to wrap", desc->name);
    struct image *image = image_new(gpu, desc);
    if (!image) return false;
    image->handle = (VkImage)vk_image;
    image->wrapped = image->shared = true;
    hazard_external_use(image, (VkImageLayout)layout);
    out->id = table_add(gpu->host, &gpu->images, image);
    if (!out->id) {
        image_free(gpu, image);
        return false;
    }
    return true;
}

void image_free(struct gpu *gpu, void *object)
{
    struct image *image = object;
    if (!image) return;
    for (uint32_t i = 0; i < image->view_count; i++) {
        gpu->vk.DestroyImageView(gpu->device, image->views[i].handle, gpu->allocator);
    }
    if (!image->wrapped) gpu->vk.DestroyImage(gpu->device, image->handle, gpu->allocator);
    alias_release(gpu, image);
    memory_free(gpu, &image->memory);
    host_free(gpu->host, image->views);
    host_free(gpu->host, image->hazards);
    host_free(gpu->host, image);
}

void gpu_image_destroy(struct gpu *gpu, gpu_image *handle)
{
    struct image *image = gpu && handle ? table_remove(&gpu->images, handle->id) : NULL;
    if (handle) handle->id = 0;
    if (!image) return;
    alias_retire(image);
    deferred_delete_add(gpu, image_free, image);
}

const struct gpu_image_desc *gpu_image_info(const struct gpu *gpu, gpu_image handle)
{
    struct image *image = image_get(gpu, handle);
    return image ? &image->desc : NULL;
}

void *gpu_image_handle(const struct gpu *gpu, gpu_image handle, uint32_t *layout)
{
    struct image *image = image_get(gpu, handle);
    if (!image) return NULL;
    image->shared = true;
    if (layout) *layout = (uint32_t)hazard_shader_layout(image);
    return (void *)image->handle;
}

static bool same_view(const struct image_view *view, VkImageViewType type, const struct range *r)
{
    return view->type == type && view->range.mip == r->mip &&
           view->range.mip_count == r->mip_count && view->range.layer == r->layer &&
           view->range.layer_count == r->layer_count;
}

VkImageView image_view(struct gpu *gpu, struct image *image, VkImageViewType type,
                       const struct range *range)
{
    for (uint32_t i = 0; i < image->view_count; i++) {
        if (same_view(&image->views[i], type, range)) return image->views[i].handle;
    }
    // The array grows by eight entries.
    if (image->view_count % 8 == 0) {
        struct image_view *views =
            host_realloc(gpu->host, image->views, image->view_count + 8, sizeof *views);
        if (!views) return VK_NULL_HANDLE;
        image->views = views;
    }
    struct image_view view = { .type = type, .range = *range };
    if (!VK_CALL(gpu, CreateImageView, gpu->device,
                 &(VkImageViewCreateInfo){
                     .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                     .image = image->handle,
                     .viewType = type,
                     .format = format_of(image->desc.format)->vk,
                     .subresourceRange = { image->aspect, range->mip, range->mip_count,
                                           range->layer, range->layer_count },
                 },
                 gpu->allocator, &view.handle)) {
        return VK_NULL_HANDLE;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_IMAGE_VIEW, view.handle, image->name);
    image->views[image->view_count++] = view;
    return view.handle;
}

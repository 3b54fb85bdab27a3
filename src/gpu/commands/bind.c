// Bindings by name: descriptor writes and barriers for a pipeline.
#include "gpu/vk.h"

#include <string.h>

static bool is_buffer(VkDescriptorType type)
{
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

// Bindings are mostly listed in the shader's order: try the same index first.
static const struct gpu_binding *find(const struct gpu_binding *bindings, int count,
                                      const char *name, int hint)
{
    if (hint < count && strcmp(bindings[hint].name, name) == 0) return &bindings[hint];
    for (int i = 0; i < count; i++) {
        if (strcmp(bindings[i].name, name) == 0) return &bindings[i];
    }
    return NULL;
}

static uint32_t layers_of_view(const struct image *image, VkImageViewType view, uint32_t layer)
{
    switch (view) {
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
        return image->layers - layer;
    case VK_IMAGE_VIEW_TYPE_CUBE:
        return 6;
    case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY:
        return (image->layers - layer) / 6 * 6;
    default:
        return 1;
    }
}

struct range bind_sampled_range(const struct image *image, const struct gpu_binding *binding,
                                VkImageViewType view)
{
    struct range range = { .mip = binding->mip, .layer = binding->one_layer ? binding->layer : 0 };
    range.mip_count = binding->one_mip ? 1 : image->desc.mips - binding->mip;
    range.layer_count = layers_of_view(image, view, range.layer);
    if (binding->one_layer && view == VK_IMAGE_VIEW_TYPE_2D_ARRAY) range.layer_count = 1;
    return range;
}

static bool view_fits(const struct image *image, VkImageViewType view)
{
    enum gpu_dimension d = image->desc.dimension;
    if (view == VK_IMAGE_VIEW_TYPE_3D || d == GPU_3D)
        return view == VK_IMAGE_VIEW_TYPE_3D && d == GPU_3D;
    if (view == VK_IMAGE_VIEW_TYPE_CUBE || view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) {
        return d == GPU_CUBE || d == GPU_CUBE_ARRAY;
    }
    return true;
}

static bool prepare_image(struct gpu_cmd *cmd, const struct pipeline *pipeline,
                          const struct shader_binding *want, const struct gpu_binding *given,
                          VkDescriptorImageInfo *out)
{
    struct gpu *gpu = cmd->gpu;
    struct image *image = image_get(gpu, given->image);
    if (!image)
        return gpu_misuse(gpu, "pipeline %s: no image for \"%s\"", pipeline->name, want->name);
    bool storage = want->type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    if (!(image->desc.usage & (storage ? GPU_STORAGE : GPU_SAMPLED))) {
        return gpu_misuse(gpu, "pipeline %s: image %s was not created for \"%s\" (%s)",
                          pipeline->name, image->name, want->name,
                          storage ? "storage" : "sampling");
    }
    if (!view_fits(image, want->view) || given->mip >= image->desc.mips ||
        (given->one_layer && given->layer >= image->layers)) {
        return gpu_misuse(gpu, "pipeline %s: \"%s\" cannot see mip %u, layer %u of image %s",
                          pipeline->name, want->name, given->mip, given->layer, image->name);
    }
    struct range range = bind_sampled_range(image, given, want->view);
    if (storage) range.mip_count = 1;
    if (range.layer + range.layer_count > image->layers) {
        return gpu_misuse(gpu, "pipeline %s: \"%s\" sees more layers than image %s has",
                          pipeline->name, want->name, image->name);
    }
    if (render_has_target(cmd, image, &range)) {
        return gpu_misuse(gpu, "pipeline %s: image %s is bound to \"%s\" and rendered to at once",
                          pipeline->name, image->name, want->name);
    }
    struct access access = { want->stages, want->writes, hazard_shader_layout(image) };
    hazard_image(cmd, image, &range, &access);
    *out = (VkDescriptorImageInfo){
        .imageView = image_view(gpu, image, want->view, &range),
        .imageLayout = access.layout,
    };
    if (!storage) out->sampler = sampler_handle(gpu, given->sampler);
    if (!storage && !out->sampler) {
        return gpu_misuse(gpu, "pipeline %s: the sampler of \"%s\" is none of this device's",
                          pipeline->name, want->name);
    }
    if (!out->imageView) cmd->broken = true; // out of memory
    return out->imageView != VK_NULL_HANDLE;
}

static bool prepare_buffer(struct gpu_cmd *cmd, const struct pipeline *pipeline,
                           const struct shader_binding *want, const struct gpu_binding *given,
                           VkDescriptorBufferInfo *out)
{
    struct gpu *gpu = cmd->gpu;
    struct buffer *buffer = buffer_get(gpu, given->buffer);
    if (!buffer)
        return gpu_misuse(gpu, "pipeline %s: no buffer for \"%s\"", pipeline->name, want->name);
    bool uniform = want->type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkPhysicalDeviceLimits *l = &gpu->vk_limits;
    size_t alignment =
        uniform ? l->minUniformBufferOffsetAlignment : l->minStorageBufferOffsetAlignment;
    size_t most = uniform ? l->maxUniformBufferRange : l->maxStorageBufferRange;
    size_t bytes = given->bytes;
    if (given->offset < buffer->bytes && !bytes) bytes = buffer->bytes - given->offset;
    if (given->offset >= buffer->bytes || bytes > buffer->bytes - given->offset || bytes > most ||
        given->offset % alignment) {
        return gpu_misuse(
            gpu,
            "pipeline %s: \"%s\" cannot see %zu bytes at %zu of buffer %s, which has %zu "
            "(offsets are multiples of %zu, at most %zu bytes)",
            pipeline->name, want->name, bytes, given->offset, buffer->name, buffer->bytes,
            alignment, most);
    }
    hazard_buffer(cmd, buffer, &(struct access){ .stages = want->stages, .write = want->writes });
    *out = (VkDescriptorBufferInfo){ buffer->handle, given->offset, bytes };
    return true;
}

static bool prepare_one(struct gpu_cmd *cmd, const struct pipeline *pipeline, int index,
                        const struct gpu_binding *bindings, int count, struct bound_set *set)
{
    const struct shader_binding *want = &pipeline->reflection.bindings[index];
    const struct gpu_binding *given = find(bindings, count, want->name, index);
    if (!given) {
        return gpu_misuse(cmd->gpu, "pipeline %s: nothing is bound to \"%s\"", pipeline->name,
                          want->name);
    }
    VkWriteDescriptorSet *write = &set->writes[index];
    *write = (VkWriteDescriptorSet){
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstBinding = want->binding,
        .descriptorCount = 1,
        .descriptorType = want->type,
    };
    if (is_buffer(want->type)) {
        write->pBufferInfo = &set->buffers[index];
        return prepare_buffer(cmd, pipeline, want, given, &set->buffers[index]);
    }
    write->pImageInfo = &set->images[index];
    return prepare_image(cmd, pipeline, want, given, &set->images[index]);
}

bool bind_prepare(struct gpu_cmd *cmd, const struct pipeline *pipeline,
                  const struct gpu_binding *bindings, int binding_count, size_t push_bytes,
                  struct bound_set *set)
{
    const struct reflection *r = &pipeline->reflection;
    if (push_bytes < r->push_bytes) {
        return gpu_misuse(cmd->gpu, "pipeline %s: %zu bytes of push constants, it declares %u",
                          pipeline->name, push_bytes, r->push_bytes);
    }
    // Writes first: a resource that is also read is then tracked as written by this operation.
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < r->binding_count; i++) {
            if (r->bindings[i].writes != (pass == 0)) continue;
            if (!prepare_one(cmd, pipeline, i, bindings, binding_count, set)) return false;
        }
    }
    return true;
}

void bind_record(struct gpu_cmd *cmd, const struct pipeline *pipeline, const struct bound_set *set,
                 const void *push)
{
    const struct reflection *r = &pipeline->reflection;
    VkPipelineBindPoint point =
        pipeline->graphics ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
    if (cmd->bound[pipeline->graphics] != pipeline->handle) {
        cmd->gpu->vk.CmdBindPipeline(cmd->buffer, point, pipeline->handle);
        cmd->bound[pipeline->graphics] = pipeline->handle;
    }
    if (r->binding_count) {
        cmd->gpu->vk.CmdPushDescriptorSetKHR(cmd->buffer, point, pipeline->layout, 0,
                                             (uint32_t)r->binding_count, set->writes);
    }
    if (r->push_bytes) {
        cmd->gpu->vk.CmdPushConstants(cmd->buffer, pipeline->layout, r->push_stages, 0,
                                      r->push_bytes, push);
    }
}

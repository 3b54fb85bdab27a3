// Renderings: targets and draws. vkCmdBeginRendering is deferred to the first draw, so that
// barriers of its bindings can come before. A later draw that needs a barrier suspends and resumes
// the rendering.
#include "gpu/vk.h"

#include <stddef.h>

static bool check_target(struct gpu *gpu, const struct gpu_target *target,
                         const struct gpu_render_desc *desc, bool depth)
{
    struct image *image = image_get(gpu, target->image);
    if (!image) return gpu_misuse(gpu, "rendering: a target is not an image");
    bool volume = image->desc.dimension == GPU_3D;
    if (!(image->desc.usage & GPU_ATTACHMENT) || (image->desc.format == GPU_D32F) != depth) {
        return gpu_misuse(gpu, "rendering: image %s is no %s target", image->name,
                          depth ? "depth" : "colour");
    }
    if (target->mip >= image->desc.mips) {
        return gpu_misuse(gpu, "rendering: image %s has no mip %u", image->name, target->mip);
    }
    VkExtent3D extent = image_extent(image, target->mip);
    if (target->layer >= (volume ? extent.depth : image->layers) || !desc->width || !desc->height ||
        desc->width > extent.width || desc->height > extent.height) {
        return gpu_misuse(gpu, "rendering: %u x %u at layer %u does not fit mip %u of image %s",
                          desc->width, desc->height, target->layer, target->mip, image->name);
    }
    return true;
}

static bool check_desc(struct gpu_cmd *cmd, const struct gpu_render_desc *desc)
{
    if (desc->color_count < 0 || desc->color_count > MAX_COLORS ||
        (uint32_t)desc->color_count > cmd->gpu->vk_limits.maxColorAttachments) {
        return gpu_misuse(cmd->gpu, "rendering: %d colour targets", desc->color_count);
    }
    for (int i = 0; i < desc->color_count; i++) {
        if (!check_target(cmd->gpu, &desc->color[i], desc, false)) return false;
    }
    return !desc->depth.image.id || check_target(cmd->gpu, &desc->depth, desc, true);
}

static struct access target_access(const struct image *image)
{
    if (image->desc.format == GPU_D32F) {
        return (struct access){ VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                true, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL };
    }
    return (struct access){ VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, true,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
}

static bool attach(struct gpu_cmd *cmd, const struct gpu_target *target,
                   VkRenderingAttachmentInfo *out)
{
    struct image *image = image_get(cmd->gpu, target->image);
    if (!image)
        return gpu_misuse(cmd->gpu, "rendering: a target was destroyed before its first draw");
    struct range range = render_target_range(image, target);
    struct access access = target_access(image);
    VkExtent3D extent = image_extent(image, target->mip);
    bool load = target->load || cmd->rendering.begun;
    if (!load && image->desc.mips == 1 && image->layers == 1 && extent.depth == 1 &&
        cmd->rendering.width == extent.width && cmd->rendering.height == extent.height) {
        hazard_overwrite_image(image);
    }
    hazard_image(cmd, image, &range, &access);
    *out = (VkRenderingAttachmentInfo){
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = image_view(cmd->gpu, image, VK_IMAGE_VIEW_TYPE_2D,
                                &(struct range){ target->mip, 1, target->layer, 1 }),
        .imageLayout = access.layout,
        .loadOp = load ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
    };
    if (image->desc.format == GPU_D32F) {
        out->clearValue.depthStencil.depth = target->clear[0];
    } else {
        out->clearValue.color = format_clear(image->desc.format, target->clear);
    }
    return out->imageView != VK_NULL_HANDLE;
}

static bool resume(struct gpu_cmd *cmd)
{
    struct rendering *r = &cmd->rendering;
    if (r->active) return true;
    VkRenderingAttachmentInfo colors[MAX_COLORS], depth;
    hazard_next_op(cmd); // a resumed rendering depends on its earlier part
    bool ok = true;
    for (int i = 0; i < r->color_count; i++) ok = ok && attach(cmd, &r->colors[i], &colors[i]);
    if (r->depth.image.id) ok = ok && attach(cmd, &r->depth, &depth);
    cmd->op = r->op;
    if (!ok) {
        cmd->broken = true;
        return false;
    }
    hazard_flush(cmd);
    cmd->gpu->vk.CmdBeginRendering(cmd->buffer,
                                   &(VkRenderingInfo){
                                       .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                       .renderArea.extent = { r->width, r->height },
                                       .layerCount = 1,
                                       .colorAttachmentCount = (uint32_t)r->color_count,
                                       .pColorAttachments = colors,
                                       .pDepthAttachment = r->depth.image.id ? &depth : NULL,
                                   });
    r->active = r->begun = true;
    cmd->gpu->vk.CmdSetViewport(cmd->buffer, 0, 1,
                                &(VkViewport){ 0, 0, (float)r->width, (float)r->height, 0, 1 });
    cmd->gpu->vk.CmdSetScissor(cmd->buffer, 0, 1, &(VkRect2D){ .extent = { r->width, r->height } });
    return true;
}

// Queues barriers for gpu_render_desc.reads.
static void prepare_reads(struct gpu_cmd *cmd, const struct gpu_render_desc *desc)
{
    const VkPipelineStageFlags2 stages =
        VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    for (int i = 0; i < desc->read_count; i++) {
        const struct gpu_binding *read = &desc->reads[i];
        struct image *image = image_get(cmd->gpu, read->image);
        struct buffer *buffer = buffer_get(cmd->gpu, read->buffer);
        if (image && read->mip < image->desc.mips &&
            (!read->one_layer || read->layer < image->layers)) {
            struct range range = bind_sampled_range(
                image, read, read->one_layer ? VK_IMAGE_VIEW_TYPE_2D : VK_IMAGE_VIEW_TYPE_2D_ARRAY);
            if (render_has_target(cmd, image, &range)) continue;
            hazard_image(
                cmd, image, &range,
                &(struct access){ .stages = stages, .layout = hazard_shader_layout(image) });
        } else if (buffer) {
            hazard_buffer(
                cmd, buffer,
                &(struct access){ .stages = stages | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT });
        }
    }
}

void gpu_render_begin(struct gpu_cmd *cmd, const struct gpu_render_desc *desc)
{
    struct rendering *r = &cmd->rendering;
    if (r->open) {
        gpu_misuse(cmd->gpu, "rendering: another is still open");
        gpu_render_end(cmd);
    }
    *r = (struct rendering){ .open = true };
    if (cmd->gpu->lost || cmd->broken || !check_desc(cmd, desc)) {
        r->invalid = true;
        return;
    }
    for (int i = 0; i < desc->color_count; i++) r->colors[i] = desc->color[i];
    r->color_count = desc->color_count;
    r->depth = desc->depth;
    r->width = desc->width;
    r->height = desc->height;
    hazard_next_op(cmd);
    prepare_reads(cmd, desc);
    hazard_next_op(cmd);
    r->op = cmd->op;
}

static bool formats_match(struct gpu_cmd *cmd, const struct pipeline *pipeline)
{
    const struct rendering *r = &cmd->rendering;
    bool same = pipeline->color_count == r->color_count &&
                (pipeline->desc.depth_format != GPU_FORMAT_NONE) == (r->depth.image.id != 0);
    for (int i = 0; same && i < r->color_count; i++) {
        struct image *image = image_get(cmd->gpu, r->colors[i].image);
        same = image && image->desc.format == pipeline->desc.color_formats[i];
    }
    return same ||
           gpu_misuse(cmd->gpu, "draw with %s: the targets are not of its formats", pipeline->name);
}

// The index buffer of an indexed draw, with its barrier queued; NULL: invalid.
static struct buffer *prepare_indices(struct gpu_cmd *cmd, const struct pipeline *pipeline,
                                      const struct gpu_draw_desc *draw)
{
    struct buffer *indices = buffer_get(cmd->gpu, draw->indices);
    if (!indices || draw->index_offset % 4 || draw->index_offset > indices->bytes ||
        draw->count > (indices->bytes - draw->index_offset) / 4) {
        gpu_misuse(cmd->gpu, "draw with %s: %u indices at byte %zu are not in the buffer",
                   pipeline->name, draw->count, draw->index_offset);
        return NULL;
    }
    hazard_buffer(cmd, indices, &(struct access){ .stages = VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT });
    return indices;
}

static void record_draw(struct gpu_cmd *cmd, const struct gpu_draw_desc *draw,
                        struct buffer *indices)
{
    const struct vulkan_functions *vk = &cmd->gpu->vk;
    static const VkCullModeFlags culls[] = { VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT,
                                             VK_CULL_MODE_FRONT_BIT };
    vk->CmdSetCullMode(cmd->buffer, culls[draw->cull]);
    vk->CmdSetFrontFace(cmd->buffer, draw->flip_front ? VK_FRONT_FACE_CLOCKWISE
                                                      : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    if (indices) {
        vk->CmdBindIndexBuffer(cmd->buffer, indices->handle, draw->index_offset,
                               VK_INDEX_TYPE_UINT32);
        vk->CmdDrawIndexed(cmd->buffer, draw->count, 1, 0, 0, 0);
    } else {
        vk->CmdDraw(cmd->buffer, draw->count, 1, 0, 0);
    }
}

void gpu_draw(struct gpu_cmd *cmd, const struct gpu_draw_desc *draw)
{
    struct gpu *gpu = cmd->gpu;
    struct rendering *r = &cmd->rendering;
    if (gpu->lost || cmd->broken || r->invalid || !draw->count) return;
    struct pipeline *pipeline = pipeline_get(gpu, draw->pipeline);
    if (!r->open || !pipeline || !pipeline->graphics || (unsigned)draw->cull > GPU_CULL_FRONT) {
        gpu_misuse(gpu, "draw: %s",
                   r->open ? "no graphics pipeline, or no such culling" : "no rendering is open");
        return;
    }
    struct bound_set set;
    cmd->op = r->op;
    if (!formats_match(cmd, pipeline) ||
        !bind_prepare(cmd, pipeline, draw->bindings, draw->binding_count, draw->push_bytes, &set)) {
        return;
    }
    struct buffer *indices = NULL;
    if (draw->indices.id) {
        indices = prepare_indices(cmd, pipeline, draw);
        if (!indices) return;
    }
    hazard_flush(cmd);
    if (!resume(cmd)) return;
    bind_record(cmd, pipeline, &set, draw->push);
    record_draw(cmd, draw, indices);
}

void gpu_render_end(struct gpu_cmd *cmd)
{
    struct rendering *r = &cmd->rendering;
    if (!r->open) {
        gpu_misuse(cmd->gpu, "rendering: none is open");
        return;
    }
    // A rendering without draws still clears its targets.
    if (!r->invalid && !r->begun && !cmd->broken && !cmd->gpu->lost) resume(cmd);
    render_suspend(cmd);
    *r = (struct rendering){ 0 };
}

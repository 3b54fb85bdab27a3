// A program's G-buffer: checks, and images of the GPU layer for the time of a recording.
#include "api/renderer_gbuffer.h"

#include "api/renderer_state.h"

#include <stddef.h>

static const struct {
    enum frame_layer layer;
    const char *name;
    size_t member; // of struct ag_gbuffer
} members[] = {
    { FRAME_DEPTH, "gbuffer.depth", offsetof(struct ag_gbuffer, depth) },
    { FRAME_NORMAL, "gbuffer.normal", offsetof(struct ag_gbuffer, normal) },
    { FRAME_ALBEDO, "gbuffer.albedo", offsetof(struct ag_gbuffer, albedo) },
    { FRAME_MATERIAL, "gbuffer.material", offsetof(struct ag_gbuffer, material) },
    { FRAME_DIELECTRIC, "gbuffer.dielectric", offsetof(struct ag_gbuffer, dielectric) },
    { FRAME_EMISSIVE, "gbuffer.emissive", offsetof(struct ag_gbuffer, emissive) },
    { FRAME_MOTION, "gbuffer.motion", offsetof(struct ag_gbuffer, motion) },
    { FRAME_ID, "gbuffer.id", offsetof(struct ag_gbuffer, id) },
};
enum { MEMBER_COUNT = sizeof members / sizeof *members };

enum ag_result renderer_gbuffer_check(const char *function, const struct ag_view *v,
                                      const struct ag_gbuffer *gbuffer)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_FOR(function, context, !v->host_gbuffer || gbuffer,
                   "gbuffer is NULL, in spite of host_gbuffer at creation");
    AG_REQUIRE_FOR(function, context, v->host_gbuffer || !gbuffer,
                   "there is a gbuffer, but it was created without host_gbuffer");
    if (!gbuffer) return AG_OK;
    AG_REQUIRE_KNOWN(function, context, gbuffer);
    const float scale = gbuffer->emissive.scale;
    AG_REQUIRE_FOR(function, context,
                   !gbuffer->emissive.vk_image || (isfinite(scale) && scale > 0.0f),
                   "gbuffer.emissive: its scale %g is not positive", (double)scale);
    return AG_OK;
}

static bool open_member(const struct ag_view *v, int i, const struct ag_layer_handle *handle,
                        gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = members[i].name,
                                         .dimension = GPU_2D,
                                         .format = frame_layer_format(members[i].layer),
                                         .width = (uint32_t)v->width,
                                         .height = (uint32_t)v->height,
                                         .usage = GPU_SAMPLED };
    const struct gpu_image_handles handles = { .image = handle->vk_image,
                                               .format = handle->vk_format,
                                               .usage = handle->vk_usage,
                                               .layout = handle->vk_layout };
    if (handle->width != v->width || handle->height != v->height)
        return host_fail(renderer_host(v->renderer), FAIL_ARGUMENT,
                         "%s: its size is %dx%d, not %dx%d", members[i].name, handle->width,
                         handle->height, v->width, v->height);
    return gpu_image_import(v->renderer->device->gpu, &desc, &handles, out);
}

bool renderer_gbuffer_open(const struct ag_view *v, const struct ag_gbuffer *gbuffer,
                           struct frame_gbuffer *out)
{
    *out = (struct frame_gbuffer){ .emissive_scale = 1.0f };
    if (!gbuffer) return true;
    if (gbuffer->emissive.vk_image) out->emissive_scale = gbuffer->emissive.scale;
    for (int i = 0; i < MEMBER_COUNT; i++) {
        const struct ag_layer_handle *handle =
            (const void *)((const char *)gbuffer + members[i].member);
        if (handle->vk_image && !open_member(v, i, handle, &out->layers[members[i].layer]))
            return false;
    }
    return true;
}

void renderer_gbuffer_finish(const struct ag_view *v, struct frame_gbuffer *gbuffer)
{
    for (int l = 0; l < FRAME_LAYER_COUNT; l++)
        gpu_image_destroy(v->renderer->device->gpu, &gbuffer->layers[l]);
}

// A program's G-buffer: checks, and images of the GPU layer for the time of a recording.
#include "api/renderer/gbuffer.h"

#include "api/renderer/state.h"

#include <stddef.h>
#include <stdio.h>

// formats: with a layout, ended by GPU_FORMAT_NONE.
static const struct {
    enum frame_layer layer;
    const char *name;
    size_t member; // of struct ag_gbuffer
    enum gpu_format formats[14];
} members[] = {
    { FRAME_DEPTH,
      "gbuffer.depth",
      offsetof(struct ag_gbuffer, depth),
      { GPU_D32F, GPU_D16, GPU_D24, GPU_D24_S8, GPU_D32F_S8, GPU_R32F } },
    { FRAME_NORMAL,
      "gbuffer.normal",
      offsetof(struct ag_gbuffer, normal),
      { GPU_RG16F, GPU_RG32F, GPU_RG16_SNORM, GPU_RG16, GPU_RGBA8, GPU_RGBA8_SNORM, GPU_A2B10G10R10,
        GPU_RGBA16, GPU_RGBA16_SNORM, GPU_RGBA16F, GPU_RGBA32F } },
    { FRAME_ALBEDO,
      "gbuffer.albedo",
      offsetof(struct ag_gbuffer, albedo),
      { GPU_RGBA8_SRGB, GPU_RGBA8, GPU_BGRA8_SRGB, GPU_BGRA8, GPU_A2B10G10R10, GPU_RGBA16,
        GPU_RGBA16F, GPU_B10G11R11F } },
    { FRAME_MATERIAL,
      "gbuffer.material",
      offsetof(struct ag_gbuffer, material),
      { GPU_RG8, GPU_RGBA8, GPU_BGRA8, GPU_RG16, GPU_RG16F, GPU_RGBA16F } },
    { FRAME_DIELECTRIC,
      "gbuffer.dielectric",
      offsetof(struct ag_gbuffer, dielectric),
      { GPU_RGBA8, GPU_RGBA16, GPU_RGBA16F } },
    { FRAME_EMISSIVE,
      "gbuffer.emissive",
      offsetof(struct ag_gbuffer, emissive),
      { GPU_RGBA16F, GPU_RGBA32F, GPU_B10G11R11F } },
    { FRAME_MOTION,
      "gbuffer.motion",
      offsetof(struct ag_gbuffer, motion),
      { GPU_RGBA16F, GPU_RG16F, GPU_RG32F, GPU_RG16_SNORM, GPU_RGBA32F } },
    { FRAME_ID, "gbuffer.id", offsetof(struct ag_gbuffer, id), { GPU_RG32U } },
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
    AG_REQUIRE_FOR(function, context, api_finite(gbuffer->motion_offset, 2),
                   "gbuffer.motion_offset is not finite");
    return AG_OK;
}

// ---- layouts

void ag_gbuffer_layout_default(struct ag_gbuffer_layout *layout)
{
    if (!layout) return;
    *layout = (struct ag_gbuffer_layout){ .normal_octahedral = true,
                                          .normal_scale = 1.0f,
                                          .albedo_alpha = true,
                                          .metallic_channel = 1,
                                          .motion_scale = { 1.0f, 1.0f },
                                          .motion_distance = true };
}

enum ag_result renderer_layout_check(const char *function, struct ag_context *context,
                                     bool host_gbuffer, const struct ag_gbuffer_layout *layout)
{
    if (!layout) return AG_OK;
    const float values[] = { layout->normal_scale, layout->normal_bias, layout->motion_scale[0],
                             layout->motion_scale[1] };
    AG_REQUIRE_FOR(function, context, host_gbuffer,
                   "there is a gbuffer_layout, but not host_gbuffer");
    AG_REQUIRE_KNOWN(function, context, layout);
    AG_REQUIRE_FOR(function, context, api_finite(values, 4),
                   "gbuffer_layout has a scale or bias that is not finite");
    AG_REQUIRE_FOR(function, context,
                   layout->roughness_channel >= -1 && layout->roughness_channel < 4 &&
                       layout->metallic_channel >= -1 && layout->metallic_channel < 4,
                   "gbuffer_layout: channels must be -1 to 3, not %d and %d",
                   layout->roughness_channel, layout->metallic_channel);
    return AG_OK;
}

// Depth without a far plane is that of the frame: near / distance.
static bool reads_in_place(const struct api_view *m)
{
    return !m->forward_depth && (m->camera.orthographic || isinf(m->host_far_m));
}

enum ag_result renderer_depth_check(const char *function, const struct ag_view *v,
                                    const struct api_view *m)
{
    AG_REQUIRE_FOR(function, view_context(v), v->has_layout || reads_in_place(m),
                   "the depth of matrices is %s, which gbuffer.depth is read with only if the view "
                   "was created with a gbuffer_layout",
                   m->forward_depth ? "not reversed" : "that of a finite far plane");
    return AG_OK;
}

// Both depths are linear in 1 / distance, or in orthographic views in the distance: reversed, n/f +
// (1 − n/f) · depth is near / distance; forward, 1 − depth is the reversed one.
static void encode_depth(const struct api_view *m, struct gbuffer_encoding *out)
{
    const bool finite = m && !m->camera.orthographic && isfinite(m->host_far_m);
    const float share = finite ? m->camera.near_m / m->host_far_m : 0.0f; // n/f
    const bool forward = m && m->forward_depth;
    out->depth_offset = forward ? 1.0f : share;
    out->depth_scale = forward ? -(1.0f - share) : 1.0f - share;
    out->depth_without_surface = forward ? 1.0f : 0.0f;
}

static uint32_t channel_of(int channel)
{
    return channel < 0 ? GBUFFER_NO_CHANNEL : (uint32_t)channel;
}

static int channels_of(const struct ag_layer_handle *handle)
{
    return gpu_format_channels(gpu_format_of_vk(handle->vk_format));
}

static struct gbuffer_encoding encoding_of(const struct ag_gbuffer_layout *layout,
                                           const struct ag_gbuffer *gbuffer,
                                           const struct api_view *matrices)
{
    struct gbuffer_encoding out = {
        .normal_scale = layout->normal_scale,
        .normal_bias = layout->normal_bias,
        .normal_octahedral = layout->normal_octahedral,
        .normal_in_view_space = layout->normal_in_view_space,
        .albedo_alpha = layout->albedo_alpha && channels_of(&gbuffer->albedo) == 4,
        .roughness = channel_of(layout->roughness_channel),
        .metallic = channel_of(layout->metallic_channel),
        .motion_scale_x = layout->motion_scale[0],
        .motion_scale_y = layout->motion_scale[1],
        .motion_offset_x = gbuffer->motion_offset[0],
        .motion_offset_y = gbuffer->motion_offset[1],
        .motion_has_distance = layout->motion_distance && channels_of(&gbuffer->motion) > 2,
    };
    encode_depth(matrices, &out);
    return out;
}

// ---- images

static bool fail_format(const struct ag_view *v, int i, uint32_t vk_format)
{
    char list[256] = "";
    size_t used = 0;
    for (const enum gpu_format *f = members[i].formats; *f && used < sizeof list; f++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "",
                                 gpu_format_name(*f));
    return host_fail(renderer_host(v->renderer), FAIL_ARGUMENT,
                     "%s: its VkFormat %u is none of %s (struct ag_gbuffer_layout)",
                     members[i].name, vk_format, list);
}

// The format of a member; GPU_FORMAT_NONE: the view cannot read it.
static enum gpu_format format_of_member(const struct ag_view *v, int i, uint32_t vk_format)
{
    if (!v->has_layout) return frame_layer_format(members[i].layer);
    const enum gpu_format format = gpu_format_of_vk(vk_format);
    for (const enum gpu_format *f = members[i].formats; *f; f++)
        if (*f == format) return format;
    fail_format(v, i, vk_format);
    return GPU_FORMAT_NONE;
}

static bool fits(const struct ag_view *v, int i, const struct ag_layer_handle *handle)
{
    const bool larger = v->has_layout && members[i].layer != FRAME_ID &&
                        handle->width >= v->width && handle->height >= v->height;
    if (larger || (handle->width == v->width && handle->height == v->height)) return true;
    return host_fail(renderer_host(v->renderer), FAIL_ARGUMENT,
                     "%s: its size is %dx%d, not %dx%d%s", members[i].name, handle->width,
                     handle->height, v->width, v->height,
                     v->has_layout && members[i].layer != FRAME_ID ? " or larger" : "");
}

static bool open_member(const struct ag_view *v, int i, const struct ag_layer_handle *handle,
                        gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = members[i].name,
                                         .dimension = GPU_2D,
                                         .format = format_of_member(v, i, handle->vk_format),
                                         .width = (uint32_t)handle->width,
                                         .height = (uint32_t)handle->height,
                                         .usage = GPU_SAMPLED };
    const struct gpu_image_handles handles = { .image = handle->vk_image,
                                               .format = handle->vk_format,
                                               .usage = handle->vk_usage,
                                               .layout = handle->vk_layout };
    return desc.format && fits(v, i, handle) &&
           gpu_image_import(v->renderer->device->gpu, &desc, &handles, out);
}

bool renderer_gbuffer_open(const struct ag_view *v, const struct ag_gbuffer *gbuffer,
                           const struct api_view *matrices, struct gbuffer_encoding *encoding,
                           struct frame_gbuffer *out)
{
    *out = (struct frame_gbuffer){ .emissive_scale = 1.0f };
    if (!gbuffer) return true;
    if (v->has_layout) *encoding = encoding_of(&v->layout, gbuffer, matrices);
    out->encoding = v->has_layout ? encoding : NULL;
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

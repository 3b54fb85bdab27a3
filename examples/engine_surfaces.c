#include "engine_surfaces.h"

#include <math.h>
#include <string.h>

const struct engine_layout engine_layouts[ENGINE_LAYOUTS] = {
    { "reversed",
      ENGINE_REVERSED,
      { VK_FORMAT_D32_SFLOAT,    // without a far plane
        VK_FORMAT_R16G16_SNORM,  // octahedral
        VK_FORMAT_R8G8B8A8_SRGB, // alpha 1: surface
        VK_FORMAT_UNDEFINED } }, // no motion
    { "forward",
      ENGINE_FORWARD,
      { VK_FORMAT_D32_SFLOAT,               // with a far plane
        VK_FORMAT_A2B10G10R10_UNORM_PACK32, // (n + 1)/2
        VK_FORMAT_R8G8B8A8_UNORM,           // linear, without a meaning of alpha
        VK_FORMAT_R32G32_SFLOAT } },        // pixels, without the jitter
};

void engine_layout_describe(const struct engine_layout *layout, int width, int height,
                            struct ag_gbuffer_layout *out)
{
    ag_gbuffer_layout_default(out);
    if (layout->depth == ENGINE_REVERSED) return; // formats and matrices say the rest
    out->normal_octahedral = false;
    out->normal_scale = 2;
    out->normal_bias = -1;
    out->albedo_alpha = false;
    out->motion_scale[0] = -1 / (float)width; // the engine's points from now to the last frame
    out->motion_scale[1] = -1 / (float)height;
    out->motion_distance = false;
}

// A unit vector along an axis, octahedral, as two signed words.
static uint32_t octahedral_snorm(int axis, bool negative)
{
    const uint16_t one = negative ? 0x8001 : 0x7fff;
    const uint16_t x = axis == 0 ? one : axis == 2 && negative ? 0x7fff : 0;
    const uint16_t y = axis == 1 ? one : axis == 2 && negative ? 0x7fff : 0;
    return x | (uint32_t)y << 16;
}

// The same as three components of 10 bits, of which 512 is the nearest to 0.
static uint32_t biased_10_bits(int axis, bool negative)
{
    uint32_t packed = 0;
    for (int i = 0; i < 3; i++) packed |= (i != axis ? 512u : negative ? 0u : 1023u) << (10 * i);
    return packed;
}

static void encode_albedo(const float color[3], bool srgb, bool surface, uint8_t out[4])
{
    for (int i = 0; i < 3; i++)
        out[i] = srgb ? srgb_byte(color[i]) : (uint8_t)(255 * color[i] + 0.5f);
    out[3] = surface ? 255 : 0;
}

// Pixels from where the surface is to where it was, both without jitter.
static void find_motion(const struct engine_frame *frame, const struct box_hit *hit,
                        const float point[3], const struct host_gbuffer *size, float out[2])
{
    float before[3], now[2], last[2];
    for (int i = 0; i < 3; i++)
        before[i] =
            point[i] + frame->last_boxes[hit->box].center[i] - frame->boxes[hit->box].center[i];
    engine_camera_project(&frame->camera, point, size->width, size->height, now);
    engine_camera_project(&frame->last_camera, before, size->width, size->height, last);
    for (int i = 0; i < 2; i++) out[i] = last[i] - now[i];
}

// The images as arrays; `motion` is NULL if the layout has none.
struct texels {
    float *depth, (*motion)[2];
    uint32_t *normal;
    uint8_t (*albedo)[4];
};

static void draw_pixel(const struct engine_frame *frame, const struct engine_layout *layout,
                       const struct host_gbuffer *size, size_t p, const struct texels *out)
{
    const float pixel[2] = { (float)(p % (size_t)size->width), (float)(p / (size_t)size->width) };
    float eye[3], ray[3], point[3];
    engine_camera_ray(&frame->camera, pixel, size->width, size->height, eye, ray);
    const struct box_hit hit = boxes_hit(frame->boxes, eye, ray);
    const bool surface = hit.distance < INFINITY, forward = layout->depth == ENGINE_FORWARD;
    out->depth[p] = engine_camera_depth(&frame->camera, hit.distance);
    out->normal[p] =
        forward ? biased_10_bits(hit.axis, hit.negative) : octahedral_snorm(hit.axis, hit.negative);
    encode_albedo(frame->boxes[hit.box].color, !forward, surface, out->albedo[p]);
    if (!out->motion) return;
    memset(out->motion[p], 0, sizeof out->motion[p]);
    for (int i = 0; i < 3; i++) point[i] = eye[i] + hit.distance * ray[i];
    if (surface) find_motion(frame, &hit, point, size, out->motion[p]);
}

void engine_draw(const struct engine_frame *frame, const struct engine_layout *layout,
                 const struct host_gbuffer *out)
{
    struct texels texels;
    texels.depth = (float *)host_gbuffer_texels(out, SURFACE_DEPTH);
    texels.normal = (uint32_t *)host_gbuffer_texels(out, SURFACE_NORMAL);
    texels.albedo = (uint8_t(*)[4])host_gbuffer_texels(out, SURFACE_ALBEDO);
    texels.motion = layout->formats[SURFACE_MOTION]
                        ? (float(*)[2])host_gbuffer_texels(out, SURFACE_MOTION)
                        : NULL;
    for (size_t p = 0; p < (size_t)out->width * (size_t)out->height; p++)
        draw_pixel(frame, layout, out, p, &texels);
}

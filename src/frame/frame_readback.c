// Layers of a frame as physical values on the CPU. Waits for the GPU.
//
// Radiance in cd/m², irradiance in lux; albedo linear; normals as unit vectors in world space;
// depth in metres along the view axis; positions in world space (normals, depth and positions are 0
// without a surface); roughness and metallic in channels 0 and 1; motion as in FRAME_MOTION;
// ids as instance and triangle, −1 without a surface; display values linear 0…1 (sRGB decoded), as
// png_write expects. Layers that no technique writes have neutral values: indirect light 0,
// visibility 1.
#include "frame/frame_state.h"

#include "frame/octahedral.h"

#include "image/png_file.h"

#include <math.h>

struct source {
    const char *name;
    enum frame_layer layer;
    bool scaled;   // radiometric: divided by the radiance scale
    bool optional; // `neutral` if no technique writes it
    float neutral;
};

static const struct source sources[] = {
    [READ_COLOR] = { "color", FRAME_COLOR, .scaled = true },
    [READ_DIRECT] = { "direct", FRAME_DIRECT, .scaled = true },
    [READ_INDIRECT] = { "indirect", FRAME_INDIRECT, .scaled = true },
    [READ_IRRADIANCE] = { "irradiance", FRAME_IRRADIANCE, .scaled = true, .optional = true },
    [READ_VISIBILITY] = { "visibility", FRAME_VISIBILITY, .optional = true, .neutral = 1.0f },
    [READ_SPECULAR] = { "specular", FRAME_SPECULAR, .scaled = true, .optional = true },
    [READ_ALBEDO] = { "albedo", FRAME_ALBEDO, .scaled = false },
    [READ_NORMAL] = { "normal", FRAME_NORMAL, .scaled = false },
    [READ_DEPTH] = { "depth", FRAME_DEPTH, .scaled = false },
    [READ_POSITION] = { "position", FRAME_DEPTH, .scaled = false },
    [READ_EMISSIVE] = { "emissive", FRAME_EMISSIVE, .scaled = true },
    [READ_ROUGHNESS_METALLIC] = { "roughness and metallic", FRAME_MATERIAL, .scaled = false },
    [READ_MOTION] = { "motion", FRAME_MOTION, .scaled = false },
    [READ_ID] = { "id", FRAME_ID, .scaled = false },
    [READ_DISPLAY] = { "display", FRAME_DISPLAY, .scaled = false },
};

static bool download(struct frame *f, enum frame_layer layer, float *pixels, int channels)
{
    size_t count = (size_t)f->width * f->height * (size_t)channels;
    return gpu_image_download_float(f->gpu, f->layers[layer], 0, 0, pixels, channels, count);
}

static void divide_by_scale(const struct frame *f, float *pixels, size_t count)
{
    float inverse = 1.0f / frame_radiance_scale(f);
    for (size_t i = 0; i < count; i++) pixels[i] *= inverse;
}

static bool read_depth(struct frame *f, float *pixels)
{
    if (!download(f, FRAME_DEPTH, pixels, 1)) return false;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        pixels[i] = frame_camera_distance(&f->camera, pixels[i]);
    return true;
}

static bool read_position(struct frame *f, float *pixels)
{
    size_t count = (size_t)f->width * f->height;
    float *depth = host_alloc(f->host, count, sizeof *depth);
    if (!depth || !download(f, FRAME_DEPTH, depth, 1)) {
        host_free(f->host, depth);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        float x = 2.0f * ((float)(i % f->width) + 0.5f) / (float)f->width - 1.0f;
        float y = 2.0f * ((float)(i / f->width) + 0.5f) / (float)f->height - 1.0f;
        const struct frame_sight sight = frame_camera_sight(&f->camera, x, y);
        vec3s p = glms_vec3_muladds(sight.direction, frame_camera_distance(&f->camera, depth[i]),
                                    sight.origin);
        for (int k = 0; k < 3; k++) pixels[3 * i + (size_t)k] = depth[i] > 0.0f ? p.raw[k] : 0.0f;
    }
    host_free(f->host, depth);
    return true;
}

// The albedo's alpha is 0 without a surface.
static bool read_normal(struct frame *f, float *pixels)
{
    size_t count = (size_t)f->width * f->height;
    float *albedo = host_alloc(f->host, count, 4 * sizeof *albedo);
    bool ok =
        albedo && download(f, FRAME_ALBEDO, albedo, 4) && download(f, FRAME_NORMAL, pixels, 3);
    for (size_t i = 0; ok && i < count; i++) {
        float *p = &pixels[3 * i];
        vec3s n = octahedral_decode((vec2s){ { p[0], p[1] } });
        for (int k = 0; k < 3; k++) p[k] = albedo[4 * i + 3] > 0.0f ? n.raw[k] : 0.0f;
    }
    host_free(f->host, albedo);
    return ok;
}

static bool read_display(struct frame *f, float *pixels, int channels)
{
    if (!download(f, FRAME_DISPLAY, pixels, channels)) return false;
    for (size_t i = 0; i < (size_t)f->width * f->height * (size_t)channels; i++)
        pixels[i] = srgb_decode(pixels[i]);
    return true;
}

static bool neutral(const struct frame *f, const struct source *source, float *pixels, size_t count)
{
    if (f->layers[source->layer].id || !source->optional) return false;
    for (size_t i = 0; i < count; i++) pixels[i] = source->neutral;
    return true;
}

bool frame_read(struct frame *f, enum frame_readback what, float *pixels, int channels)
{
    if ((unsigned)what >= sizeof sources / sizeof *sources)
        return host_fail(f->host, FAIL_ARGUMENT, "frame layer %d: unknown layer", (int)what);
    const struct source *source = &sources[what];
    int expected = what == READ_DEPTH || what == READ_VISIBILITY ? 1 : what == READ_ID ? 2 : 3;
    if (channels != expected) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame layer %s: it has %d channels, not %d",
                         source->name, expected, channels);
    }
    if (f->index == 0)
        return host_fail(f->host, FAIL_ARGUMENT, "frame layer %s: no frame was rendered",
                         source->name);
    size_t count = (size_t)f->width * f->height * (size_t)channels;
    if (neutral(f, source, pixels, count)) return true;
    if (!f->layers[source->layer].id) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame layer %s: it was not requested",
                         source->name);
    }
    if (!frame_keeps_layer(f, source->layer)) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame layer %s: it was not kept", source->name);
    }
    if (what == READ_DEPTH) return read_depth(f, pixels);
    if (what == READ_POSITION) return read_position(f, pixels);
    if (what == READ_NORMAL) return read_normal(f, pixels);
    if (what == READ_DISPLAY) return read_display(f, pixels, channels);
    if (!download(f, source->layer, pixels, channels)) return false;
    for (size_t i = 0; what == READ_ID && i < count; i++) pixels[i] -= 1.0f;
    if (source->scaled) divide_by_scale(f, pixels, count);
    return true;
}

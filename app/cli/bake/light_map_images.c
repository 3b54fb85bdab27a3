// Images of a light map's atlas for its page.
#include "light_map_report.h"
#include "cli/files/interrupt.h"
#include "cli/page/page.h"
#include "shell/srgb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST_SIDE = 2048 }; // of an image; larger ones leave out texels

// ---- colours, sRGB

struct colour {
    unsigned char r, g, b;
};
enum { STOPS = 5 };
static const struct colour SURFACELESS = { 88, 88, 92 }, ONE_TEXEL = { 140, 140, 140 };
// From 1/2.8 of the reached density to 2.8 times as much.
static const struct colour DENSITIES[STOPS] = {
    { 178, 24, 43 }, { 244, 165, 130 }, { 247, 247, 247 }, { 146, 197, 222 }, { 33, 102, 172 }
};
static const float DENSITY_RANGE = 1.5f; // powers of 2
// From 0.5 % to 50 %, on a log scale.
static const struct colour NOISES[STOPS] = {
    { 13, 8, 135 }, { 126, 3, 168 }, { 204, 71, 120 }, { 248, 149, 64 }, { 240, 249, 33 }
};
static const float NOISE_LEAST = 0.005f, NOISE_DECADES = 2.0f;
static const struct colour OPEN = { 214, 214, 216 }, PARTLY = { 254, 196, 79 },
                           FILLED = { 84, 39, 136 }, LEAKS = { 227, 26, 28 };

// share: 0…1 along the stops.
static struct colour along(const struct colour stops[STOPS], float share)
{
    const float at = fminf(fmaxf(share, 0.0f), 1.0f) * (STOPS - 1);
    const int i = at < STOPS - 2 ? (int)at : STOPS - 2;
    const float t = at - (float)i;
    const struct colour a = stops[i], b = stops[i + 1];
    return (struct colour){ (unsigned char)((float)a.r + t * (float)(b.r - a.r)),
                            (unsigned char)((float)a.g + t * (float)(b.g - a.g)),
                            (unsigned char)((float)a.b + t * (float)(b.b - a.b)) };
}

// Successive numbers have hues far apart.
static struct colour chart_colour(float value)
{
    static const float GOLDEN = 0.61803399f, SATURATION = 0.55f;
    const float hue = fmodf(value * GOLDEN, 1.0f), light = 0.6f + 0.15f * fmodf(value, 3.0f);
    float rgb[3];
    for (int k = 0; k < 3; k++) {
        const float t = fabsf(fmodf(6.0f * hue + (float)(4 - 2 * k) + 2.0f, 6.0f) - 3.0f) - 1.0f;
        rgb[k] = 255.0f * light * (1.0f - SATURATION + SATURATION * fminf(fmaxf(t, 0.0f), 1.0f));
    }
    return (struct colour){ (unsigned char)rgb[0], (unsigned char)rgb[1], (unsigned char)rgb[2] };
}

static json_t *colour_json(struct colour c)
{
    return json_sprintf("#%02x%02x%02x", c.r, c.g, c.b);
}

static json_t *stops_json(const struct colour stops[STOPS])
{
    json_t *out = json_array();
    for (int i = 0; i < STOPS; i++) json_array_append_new(out, colour_json(stops[i]));
    return out;
}

json_t *light_map_colours(void)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "density", stops_json(DENSITIES),
                     "noise", stops_json(NOISES), "one_texel", colour_json(ONE_TEXEL), "none",
                     colour_json(SURFACELESS), "open", colour_json(OPEN), "partly",
                     colour_json(PARTLY), "filled", colour_json(FILLED), "leak",
                     colour_json(LEAKS));
}

// ---- images

enum kind { LIGHT, CHARTS, DENSITY, LEAK, NOISE, KINDS };
static const char *const NAMES[KINDS][2] = { { "light.png", "light-back.png" },
                                             { "charts.png", NULL }, // as those of fronts
                                             { "density.png", NULL },
                                             { "leaks.png", "leaks-back.png" },
                                             { "noise.png", "noise-back.png" } };

struct painting {
    const struct light_map_run *run;
    bool back;
    float reached; // density
    struct ag_image *value, *open, *light;
};

static struct colour colour_of(const struct painting *p, enum kind kind, size_t texel)
{
    const float value = p->value->pixels[texel];
    if (kind != NOISE && !isfinite(value)) return SURFACELESS;
    switch (kind) {
    case CHARTS:
        return chart_colour(value);
    case DENSITY:
        if (!(value > 0.0f)) return ONE_TEXEL;
        return along(DENSITIES, 0.5f + 0.5f * log2f(value / p->reached) / DENSITY_RANGE);
    case LEAK: {
        const float open = p->open->pixels[texel];
        return value > 0.0f                 ? LEAKS
               : open > 0.0f && open < 1.0f ? PARTLY
               : open > 0.0f                ? OPEN
                                            : FILLED;
    }
    case NOISE:
        if (!isfinite(p->open->pixels[texel])) return SURFACELESS;
        return along(NOISES, isfinite(value) ? log10f(value / NOISE_LEAST) / NOISE_DECADES : 0.0f);
    default:
        return SURFACELESS;
    }
}

static void set_pixel(const struct painting *p, enum kind kind, size_t texel, float *pixel)
{
    if (kind == LIGHT && isfinite(p->value->pixels[texel])) {
        memcpy(pixel, p->light->pixels + 3 * texel, 3 * sizeof *pixel);
        return;
    }
    const struct colour c = kind == LIGHT ? SURFACELESS : colour_of(p, kind, texel);
    pixel[0] = srgb_linear(c.r);
    pixel[1] = srgb_linear(c.g);
    pixel[2] = srgb_linear(c.b);
}

static enum ag_result paint(const struct painting *p, enum kind kind, struct ag_image **out)
{
    const int width = p->value->width, height = p->value->height;
    const int longest = width > height ? width : height,
              step = (longest + MOST_SIDE - 1) / MOST_SIDE;
    const enum ag_result result =
        ag_image_create(p->run->session->context, width / step, height / step, 3, out);
    for (int y = 0; result == AG_OK && y < (*out)->height; y++)
        for (int x = 0; x < (*out)->width; x++)
            set_pixel(p, kind, (size_t)(y * step) * (size_t)width + (size_t)(x * step),
                      (*out)->pixels + 3 * ((size_t)y * (size_t)(*out)->width + (size_t)x));
    return result;
}

// White surfaces under the light. The exposure is that of the texels.
static enum ag_result show_light(const struct painting *p, struct ag_image **out)
{
    static const float PI = 3.14159265f;
    struct ag_context *context = p->run->session->context;
    struct ag_image *map = NULL, *radiance = NULL;
    enum ag_result result = ag_lightmap_read(p->run->lightmap, p->back, &map);
    if (result == AG_OK) result = ag_image_create(context, map->width, map->height, 4, &radiance);
    for (size_t i = 0; result == AG_OK && i < (size_t)map->width * (size_t)map->height; i++) {
        for (size_t k = 0; k < 3; k++) {
            map->pixels[3 * i + k] /= PI;
            radiance->pixels[4 * i + k] = map->pixels[3 * i + k];
        }
        radiance->pixels[4 * i + 3] = isfinite(p->value->pixels[i]) ? 1.0f : 0.0f;
    }
    if (result == AG_OK)
        result = ag_image_tonemap(context, map, ag_image_auto_exposure(radiance), out);
    ag_image_destroy(context, map);
    ag_image_destroy(context, radiance);
    return result;
}

static enum ag_result read_layer(const struct painting *p, enum ag_lightmap_layer layer,
                                 struct ag_image **out)
{
    return ag_lightmap_read_layer(p->run->lightmap, layer, p->back, out);
}

static enum ag_result read_values(struct painting *p, enum kind kind)
{
    static const enum ag_lightmap_layer layers[KINDS] = { AG_LIGHTMAP_CHART, AG_LIGHTMAP_CHART,
                                                          AG_LIGHTMAP_DENSITY, AG_LIGHTMAP_LEAK,
                                                          AG_LIGHTMAP_NOISE };
    enum ag_result result = read_layer(p, layers[kind], &p->value);
    if (result == AG_OK && (kind == LEAK || kind == NOISE))
        result = read_layer(p, AG_LIGHTMAP_OPEN, &p->open);
    return result == AG_OK && kind == LIGHT ? show_light(p, &p->light) : result;
}

static enum ag_result make_image(const struct light_map_run *run, enum kind kind, bool back,
                                 const char *path)
{
    struct ag_context *context = run->session->context;
    struct ag_lightmap_info info = { 0 };
    ag_lightmap_get_info(run->lightmap, &info);
    struct painting p = { .run = run, .back = back, .reached = info.texels_per_m };
    struct ag_image *image = NULL;
    enum ag_result result = read_values(&p, kind);
    if (result == AG_OK) result = paint(&p, kind, &image);
    interrupt_hold();
    if (result == AG_OK) result = ag_image_write_png(context, path, image);
    interrupt_release();
    ag_image_destroy(context, image);
    ag_image_destroy(context, p.value);
    ag_image_destroy(context, p.open);
    ag_image_destroy(context, p.light);
    return result;
}

static enum status add_image(const struct light_map_run *run, enum kind kind, bool back,
                             const struct folder *folder, struct page *page)
{
    char path[PATH_SIZE];
    const char *name = NAMES[kind][back];
    if (!name) return DONE;
    if (!folder_file(folder, name, path))
        return fail("cannot write %s/%s: the path is too long", folder->shown, name);
    const enum ag_result result = make_image(run, kind, back, path);
    if (result == AG_OK) return page_add_image(page, name);
    fail_library(run->session->context, result);
    return FAILED;
}

enum status light_map_images_write(const struct light_map_run *run, bool noise,
                                   const struct folder *folder, struct page *page)
{
    struct ag_lightmap_info info = { 0 };
    enum status status = DONE;
    ag_lightmap_get_info(run->lightmap, &info);
    for (int back = 0; back < (info.has_back ? 2 : 1); back++)
        for (int kind = 0; kind < (noise ? KINDS : NOISE) && status == DONE; kind++)
            status = add_image(run, (enum kind)kind, back != 0, folder, page);
    return status;
}

void light_map_images_remove(const struct page *page, const struct folder *folder)
{
    char path[PATH_SIZE];
    const char *name;
    json_t *value;
    json_object_foreach(page->images, name, value)
    {
        if (folder_file(folder, name, path)) unlink(path);
    }
}

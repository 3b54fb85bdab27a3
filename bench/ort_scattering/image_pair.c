#include "ort_scattering/image_pair.h"

#include "ort_scattering/reference.h"

#include <math.h>

// ---- layers

static enum ag_result render(struct image_pair *p, const char *gi, const char *const names[LAYERS])
{
    struct ag_renderer_desc desc;
    struct ag_renderer *renderer = NULL;
    struct bench_bakes bakes;
    ag_renderer_desc_default(&desc);
    desc.width = p->bench->width;
    desc.height = p->bench->height;
    desc.gi = gi;
    desc.indirect_layer = true;
    enum ag_result result = bench_bakes_prepare(&bakes, p->bench->context, p->scene, gi);
    desc.bakes = bakes.bakes;
    desc.bake_count = bakes.count;
    if (result == AG_OK) result = ag_renderer_create(p->bench->device, p->scene, &desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &p->frame);
    for (int k = 0; k < LAYERS && result == AG_OK; k++)
        if (names[k]) result = ag_renderer_read(renderer, names[k], &p->layer[k]);
    ag_renderer_destroy(renderer);
    bench_bakes_finish(&bakes);
    return result;
}

static enum ag_result set_colour(struct image_pair *p, bool black)
{
    struct ag_scene_info info;
    enum ag_result result = ag_scene_get_info(p->scene, 0, 0.0, &info);
    for (int m = 0; m < info.materials && result == AG_OK; m++) {
        struct ag_material_info material;
        result = ag_scene_get_material(p->scene, m, &material);
        for (int c = 0; c < 3; c++) material.material.base_color[c] = black ? 0.0f : 1.0f;
        if (result == AG_OK) result = ag_scene_set_material(p->scene, m, &material.material);
    }
    return result;
}

enum ag_result image_pair_render(struct image_pair *p)
{
    static const char *const HIGHLIGHTS[LAYERS] = {
        [HIGHLIGHT] = "direct", [POSITION] = "position", [DEPTH] = "depth"
    };
    static const char *const DIFFUSE[LAYERS] = {
        [REFLECTED] = "indirect", [IRRADIANCE] = "irradiance"
    };
    static const char *const ORT[LAYERS] = { [OF_ORT] = "color" };
    enum ag_result result = set_colour(p, true);
    if (result == AG_OK) result = render(p, "none", HIGHLIGHTS);
    if (result == AG_OK) result = set_colour(p, false);
    if (result == AG_OK) result = render(p, "ambient", DIFFUSE);
    return result == AG_OK ? render(p, p->gi, ORT) : result;
}

// ---- the reference

static float luminance_of(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

// That of diffuse light in the lit part: most pixels of a back-lit image are to stay black.
static enum ag_result find_exposure(const struct image_pair *p, float *ev)
{
    static const float LIT = 0.02f, BRIGHTER = 1.5f; // of the brightest; EV
    const struct ag_image *sum = p->layer[SUM];
    struct ag_image *masked = NULL;
    float most = 0.0f;
    const enum ag_result result =
        ag_image_create(p->bench->context, sum->width, sum->height, 4, &masked);
    for (int i = 0; i < sum->width * sum->height; i++)
        most = fmaxf(most, luminance_of(sum->pixels + 3 * i));
    for (int i = 0; result == AG_OK && i < sum->width * sum->height; i++) {
        const float *rgb = sum->pixels + 3 * i;
        for (int c = 0; c < 3; c++) masked->pixels[4 * i + c] = rgb[c];
        masked->pixels[4 * i + 3] = luminance_of(rgb) > LIT * most ? 1.0f : 0.0f;
    }
    if (result == AG_OK) *ev = ag_image_auto_exposure(masked) - BRIGHTER;
    ag_image_destroy(p->bench->context, masked);
    return result;
}

static void add_highlights(const struct image_pair *p)
{
    struct ag_image *sum = p->layer[SUM];
    for (int i = 0; i < 3 * sum->width * sum->height; i++) {
        const float irradiance = p->layer[IRRADIANCE]->pixels[i];
        const float diffuse =
            irradiance > 0.0f ? p->layer[REFLECTED]->pixels[i] / irradiance : 0.0f;
        sum->pixels[i] = p->layer[HIGHLIGHT]->pixels[i] + diffuse * sum->pixels[i];
    }
}

enum ag_result image_pair_make_reference(struct image_pair *p)
{
    struct scattering_reference *reference = NULL;
    const struct scattering_desc desc = { p->scene_name, p->gi, p->points };
    const struct ag_image *size = p->layer[POSITION];
    const double begun = bench_now_ms();
    enum ag_result result =
        ag_image_create(p->bench->context, size->width, size->height, 3, &p->layer[SUM]);
    if (result != AG_OK) return result;
    if (!scattering_reference_open(&desc, &reference)) result = AG_ERROR_MEMORY;
    if (result == AG_OK) {
        scattering_reference_light(reference, &p->light);
        scattering_reference_gather(reference, size, p->layer[SUM]);
        result = find_exposure(p, &p->ev);
        add_highlights(p);
        fprintf(stderr, "reference: %.1f s\n", 1e-3 * (bench_now_ms() - begun));
    }
    scattering_reference_close(reference);
    return result;
}

// ---- results

static double mean_of(const double rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

enum ag_result image_pair_print_errors(const struct image_pair *p)
{
    struct ag_compare_desc desc;
    struct ag_metrics m;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = p->ev;
    desc.mask = p->layer[DEPTH];
    const enum ag_result result =
        ag_image_metrics(p->bench->context, p->layer[OF_ORT], p->layer[SUM], &desc, &m);
    if (result == AG_OK)
        printf("%s, %s: relmse %.4f, FLIP %.4f, energy %.4f (%.3f %.3f %.3f)\n", p->scene_name,
               p->light_name, m.relmse, m.flip, mean_of(m.mean_a) / mean_of(m.mean_b),
               m.mean_a[0] / m.mean_b[0], m.mean_a[1] / m.mean_b[1], m.mean_a[2] / m.mean_b[2]);
    return result;
}

enum ag_result image_pair_write(const struct image_pair *p)
{
    struct ag_context *context = p->bench->context;
    struct ag_image *side[2] = { NULL, NULL }, *pair = NULL;
    enum ag_result result = ag_image_tonemap(context, p->layer[OF_ORT], p->ev, &side[0]);
    if (result == AG_OK) result = ag_image_tonemap(context, p->layer[SUM], p->ev, &side[1]);
    if (result == AG_OK) result = ag_image_side_by_side(context, side[0], side[1], 4, &pair);
    if (result == AG_OK)
        result = bench_write_png(p->bench, p->folder, "back-lit", p->light_name, pair);
    for (int i = 0; i < 2; i++) ag_image_destroy(context, side[i]);
    ag_image_destroy(context, pair);
    return result;
}

void image_pair_finish(struct image_pair *p)
{
    for (int k = 0; k < LAYERS; k++) ag_image_destroy(p->bench->context, p->layer[k]);
    ag_scene_destroy(p->scene);
}

#include "paper_prt/view.h"

#include <math.h>

enum { SKY_WIDTH = 128, SKY_HEIGHT = 64, COLOURS = 3 };

static const float PI = 3.14159265f, ROUGHNESS = 0.5f;

// ---- environment

// A light whose radiance falls by e where the cosine of the angle to it falls by 1/sharpness.
static const struct broad_light {
    float to[3], sharpness, radiance[COLOURS]; // unit; –; cd/m²
} LIGHTS[] = {
    { { 0.64f, 0.6f, 0.48f }, 12.0f, { 20000.0f, 15000.0f, 9000.0f } },
    { { -0.8f, 0.36f, -0.48f }, 6.0f, { 3000.0f, 5000.0f, 9000.0f } },
};
enum { LIGHT_COUNT = sizeof LIGHTS / sizeof *LIGHTS };

static void radiance_from(const float direction[3], float out[COLOURS])
{
    static const float zenith[COLOURS] = { 900.0f, 1300.0f, 2000.0f },
                       nadir[COLOURS] = { 400.0f, 350.0f, 300.0f };
    const float up = 0.5f + 0.5f * direction[1];
    for (int c = 0; c < COLOURS; c++) out[c] = up * zenith[c] + (1.0f - up) * nadir[c];
    for (int l = 0; l < LIGHT_COUNT; l++) {
        float cosine = 0.0f;
        for (int a = 0; a < 3; a++) cosine += LIGHTS[l].to[a] * direction[a];
        const float share = expf(LIGHTS[l].sharpness * (cosine - 1.0f));
        for (int c = 0; c < COLOURS; c++) out[c] += share * LIGHTS[l].radiance[c];
    }
}

// Equirectangular, as ag_environment_load has it.
static void draw_sky(struct ag_image *image)
{
    for (int y = 0; y < SKY_HEIGHT; y++)
        for (int x = 0; x < SKY_WIDTH; x++) {
            const float elevation = PI * (0.5f - ((float)y + 0.5f) / SKY_HEIGHT),
                        azimuth = 2.0f * PI * (((float)x + 0.5f) / SKY_WIDTH - 0.5f);
            const float direction[3] = { cosf(elevation) * sinf(azimuth), sinf(elevation),
                                         -cosf(elevation) * cosf(azimuth) };
            radiance_from(direction, image->pixels + COLOURS * (y * SKY_WIDTH + x));
        }
}

static enum ag_result create_environment(struct prt_view *view)
{
    struct ag_context *context = view->bench->context;
    struct ag_image *image = NULL;
    enum ag_result result = ag_image_create(context, SKY_WIDTH, SKY_HEIGHT, COLOURS, &image);
    if (result == AG_OK) {
        draw_sky(image);
        result = ag_environment_from_image(context, image, &view->environment);
    }
    ag_image_destroy(context, image);
    return result;
}

enum ag_result prt_view_turn(struct prt_view *view, float rotation)
{
    struct ag_environment_use use;
    ag_environment_use_default(&use);
    use.rotation = rotation;
    return ag_scene_set_environment(view->scene, view->environment, &use);
}

// Light that is not distant is not transferred.
static enum ag_result replace_light(struct prt_view *view)
{
    static const float black[COLOURS] = { 0.0f, 0.0f, 0.0f };
    enum ag_result result = ag_scene_remove_lights(view->scene);
    if (result == AG_OK) result = ag_scene_set_sky(view->scene, black);
    if (result == AG_OK) result = create_environment(view);
    return result == AG_OK ? prt_view_turn(view, 0.0f) : result;
}

// ---- scene

static enum ag_result make_metal(struct ag_scene *scene)
{
    struct ag_scene_info info;
    enum ag_result result = ag_scene_get_info(scene, 0, 0.0, &info);
    for (int i = 0; i < info.materials && result == AG_OK; i++) {
        struct ag_material_info material;
        result = ag_scene_get_material(scene, i, &material);
        material.material.metallic = 1.0f;
        material.material.roughness = ROUGHNESS;
        if (result == AG_OK) result = ag_scene_set_material(scene, i, &material.material);
    }
    return result;
}

enum ag_result prt_view_open(struct prt_view *view, const char *scene, bool metal)
{
    enum ag_result result = bench_open_scene(view->bench, scene, &view->scene, &view->frame);
    if (result == AG_OK) result = replace_light(view);
    return result == AG_OK && metal ? make_metal(view->scene) : result;
}

void prt_view_close(struct prt_view *view)
{
    ag_scene_destroy(view->scene);
    ag_environment_destroy(view->environment);
}

enum ag_result prt_view_render(const struct prt_view *view, struct ag_renderer *renderer,
                               struct ag_image **out)
{
    const enum ag_result result = ag_renderer_render(renderer, &view->frame);
    return result == AG_OK ? ag_renderer_read(renderer, "color", out) : result;
}

// ---- comparison

static enum ag_result measure_exposure(const struct prt_view *view, struct prt_baseline *baseline)
{
    struct ag_context *context = view->bench->context;
    const struct ag_image *from = baseline->image;
    struct ag_image *masked = NULL;
    const enum ag_result result = ag_image_create(context, from->width, from->height, 4, &masked);
    if (result != AG_OK) return result;
    for (int i = 0; i < from->width * from->height; i++) {
        for (int c = 0; c < COLOURS; c++)
            masked->pixels[4 * i + c] = from->pixels[from->channels * i + c];
        masked->pixels[4 * i + 3] = baseline->mask->pixels[i] > 0.0f ? 1.0f : 0.0f;
    }
    baseline->ev = ag_image_auto_exposure(masked);
    ag_image_destroy(context, masked);
    return AG_OK;
}

enum ag_result prt_baseline_create(const struct prt_view *view, const char *gi,
                                   struct prt_baseline *out)
{
    struct ag_renderer *renderer = NULL;
    enum ag_result result = bench_create_renderer(view->bench, view->scene, gi, NULL, &renderer);
    if (result == AG_OK) result = prt_view_render(view, renderer, &out->image);
    if (result == AG_OK) result = ag_renderer_read(renderer, "depth", &out->mask);
    if (result == AG_OK) result = measure_exposure(view, out);
    ag_renderer_destroy(renderer);
    return result;
}

void prt_baseline_destroy(const struct prt_view *view, struct prt_baseline *baseline)
{
    ag_image_destroy(view->bench->context, baseline->image);
    ag_image_destroy(view->bench->context, baseline->mask);
}

static enum ag_result flip_of(const struct prt_view *view, const struct prt_baseline *baseline,
                              const struct ag_image *image, const struct ag_image *mask,
                              double *out)
{
    struct ag_compare_desc desc;
    struct ag_metrics metrics = { 0 };
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = baseline->ev;
    desc.mask = mask;
    const enum ag_result result =
        ag_image_metrics(view->bench->context, image, baseline->image, &desc, &metrics);
    *out = metrics.flip;
    return result;
}

enum ag_result prt_baseline_flip(const struct prt_view *view, const struct prt_baseline *baseline,
                                 struct ag_renderer *renderer, struct prt_flip *out)
{
    struct ag_image *image = NULL;
    enum ag_result result = prt_view_render(view, renderer, &image);
    if (result == AG_OK) result = flip_of(view, baseline, image, NULL, &out->all);
    if (result == AG_OK) result = flip_of(view, baseline, image, baseline->mask, &out->surface);
    ag_image_destroy(view->bench->context, image);
    return result;
}

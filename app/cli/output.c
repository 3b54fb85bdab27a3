// Output images: layers, their display in a PNG, EXR attributes.
#include "output.h"
#include "cli/files/interrupt.h"
#include "values.h"

#include "image/srgb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- names

void output_default(const char *scene, const char *ending, char out[PATH_SIZE])
{
    const char *slash = strrchr(scene, '/');
    const char *name = scene[0] == '@' ? scene + 1 : slash ? slash + 1 : scene;
    const char *dot = strrchr(name, '.');
    size_t length = scene[0] == '@'     ? strcspn(name, ":/")
                    : dot && dot > name ? (size_t)(dot - name)
                                        : strlen(name);
    snprintf(out, PATH_SIZE, "%.*s%s", length < 255 ? (int)length : 255, name, ending);
}

// ---- layers

static enum status unknown_layer(const char *name, const char *(*layer_name)(int))
{
    const char *known[MAX_LAYERS];
    int count = 0;
    for (const char *layer; count < MAX_LAYERS && (layer = layer_name(count));)
        known[count++] = layer;
    const char *nearest = ag_nearest_name(name, known, count);
    if (nearest) return wrong_usage("unknown layer %s in --aov: did you mean %s?", name, nearest);
    return wrong_usage("unknown layer %s in --aov: see --help", name);
}

static bool layer_exists(const char *name, const char *(*layer_name)(int))
{
    const char *layer;
    for (int i = 0; (layer = layer_name(i)); i++)
        if (strcmp(layer, name) == 0) return true;
    return false;
}

// Layers of a reference keep their former names for one release.
static const char *current_name(const char *name)
{
    static const struct {
        const char *old_name, *name;
    } aliases[] = {
        { "gathered", "indirect_emitters_sky" },
        { "gathered_irradiance", "irradiance_emitters_sky" },
    };
    for (size_t i = 0; i < sizeof aliases / sizeof aliases[0]; i++) {
        if (strcmp(aliases[i].old_name, name) != 0) continue;
        note("warning: --aov: layer %s is now %s; the old name will be removed in the next release",
             name, aliases[i].name);
        return aliases[i].name;
    }
    return name;
}

static enum status add_layer(struct output *output, const char *name,
                             const char *(*layer_name)(int))
{
    if (!layer_exists(name, layer_name)) name = current_name(name);
    if (!layer_exists(name, layer_name)) return unknown_layer(name, layer_name);
    for (int i = 0; i < output->layer_count; i++)
        if (strcmp(output->layers[i], name) == 0)
            return wrong_usage("wrong value --aov: layer %s is named twice", name);
    output->layers[output->layer_count++] = name; // names are unique, so there is space
    return DONE;
}

enum status output_plan(const struct arguments *a, const char *path, const char *(*layer_name)(int),
                        const char *fallback, struct output *out)
{
    *out = (struct output){ .exr = has_extension(path, "exr") };
    enum status status = DONE;
    int wrote = snprintf(out->names, sizeof out->names, "%s", a->aov ? a->aov : fallback);
    if (wrote >= (int)sizeof out->names)
        return wrong_usage("wrong value --aov: the list is too long");
    char *rest = out->names;
    while (rest && status == DONE) status = add_layer(out, strsep(&rest, ","), layer_name);
    if (status != DONE) return status;
    if (!out->exr && out->layer_count > 1)
        return wrong_usage("cannot write %d layers into %s: a PNG holds one, an .exr holds all",
                           out->layer_count, path);
    if (output_has_layer(out, "debug") && !a->debug_view)
        return wrong_usage("cannot write layer debug: it requires --debug-view");
    return DONE;
}

bool output_has_layer(const struct output *output, const char *layer)
{
    for (int i = 0; i < output->layer_count; i++)
        if (strcmp(output->layers[i], layer) == 0) return true;
    return false;
}

// ---- conversion of layers to display values 0…1

// Maps −1…1 to bytes 0…255 as normal maps do; the inverse sRGB curve cancels the encoding of the
// file.
static void show_direction(struct ag_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        float value = 0.5f + 0.5f * image->pixels[i];
        image->pixels[i] = srgb_decode(fminf(fmaxf(value, 0.0f), 1.0f));
    }
}

// Grey for no motion (and NaN), 0 or 1 for the largest.
static void show_motion(struct ag_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    float most = 0.0f;
    for (size_t i = 0; i < count; i++)
        if (isfinite(image->pixels[i])) most = fmaxf(most, fabsf(image->pixels[i]));
    for (size_t i = 0; i < count; i++) {
        bool shown = most > 0.0f && isfinite(image->pixels[i]);
        image->pixels[i] = shown ? image->pixels[i] / most : 0.0f;
    }
    show_direction(image);
}

// Maps each channel from its finite range to 0…1; NaN to 0.
static void show_range(struct ag_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    size_t channels = (size_t)image->channels;
    for (size_t c = 0; c < channels; c++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < pixels; i++) {
            float value = image->pixels[i * channels + c];
            if (!isfinite(value)) continue;
            low = fminf(low, value);
            high = fmaxf(high, value);
        }
        float scale = high > low ? 1.0f / (high - low) : 0.0f;
        for (size_t i = 0; i < pixels; i++) {
            float *value = &image->pixels[i * channels + c];
            *value = isfinite(*value) ? (*value - low) * scale : 0.0f;
        }
    }
}

// Inverse depth: the nearest surface is white, background (0) black.
static void show_depth(struct ag_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    float nearest = INFINITY;
    for (size_t i = 0; i < pixels; i++)
        if (image->pixels[i] > 0.0f) nearest = fminf(nearest, image->pixels[i]);
    for (size_t i = 0; i < pixels; i++)
        image->pixels[i] = image->pixels[i] > 0.0f ? nearest / image->pixels[i] : 0.0f;
}

// Radiance of a white diffuse surface with this irradiance.
static void irradiance_to_radiance(struct ag_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) image->pixels[i] *= 0.318309886f;
}

// A number of 32 bits whose bits all depend on those of n (Wellons' lowbias32).
static uint32_t scrambled(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7feb352du;
    n = (n ^ n >> 15) * 0x846ca68bu;
    return n ^ n >> 16;
}

// False colours: a hue for each instance, a brightness for each triangle; black: no surface.
static enum ag_result show_ids(struct session *session, struct ag_image **image)
{
    struct ag_image *ids = *image, *shown = NULL;
    const enum ag_result result =
        ag_image_create(session->context, ids->width, ids->height, 3, &shown);
    if (result != AG_OK) return result;
    for (size_t i = 0; i < (size_t)ids->width * (size_t)ids->height; i++) {
        const float *id = &ids->pixels[2 * i];
        if (id[0] < 0.0f) continue;
        const uint32_t color = scrambled((uint32_t)id[0] + 1);
        const float brightness =
            0.6f + 0.4f * (float)(scrambled((uint32_t)id[1] + 1) & 0xff) / 255.0f;
        for (int c = 0; c < 3; c++)
            shown->pixels[3 * i + (size_t)c] =
                brightness * (0.1f + 0.9f * (float)(color >> (8 * c) & 0xff) / 255.0f);
    }
    ag_image_destroy(session->context, ids);
    *image = shown;
    return AG_OK;
}

static enum ag_result tonemap(struct session *session, float ev, struct ag_image **image)
{
    struct ag_image *display = NULL;
    enum ag_result result =
        ag_image_tonemap_curve(session->context, *image, ev, session->arguments->tonemap, &display);
    if (result != AG_OK) return result;
    ag_image_destroy(session->context, *image);
    *image = display;
    return AG_OK;
}

// Conversion of a layer; RADIANCE if not listed.
enum conversion { RADIANCE, UNCHANGED, DIRECTION, MOTION, DEPTH, RANGE, IRRADIANCE, IDS };

static enum conversion conversion_of(const char *layer)
{
    static const struct {
        const char *layer;
        enum conversion conversion;
    } conversions[] = {
        { "albedo", UNCHANGED },
        { "visibility", UNCHANGED },
        { "display", UNCHANGED },
        { "normal", DIRECTION },
        { "motion", MOTION },
        { "depth", DEPTH },
        { "obscurance", UNCHANGED },
        { "ambient_occlusion", UNCHANGED },
        { "position", RANGE },
        { "samples", RANGE },
        { "irradiance", IRRADIANCE },
        { "irradiance_emitters_sky", IRRADIANCE },
        { "id", IDS },
    };
    for (size_t i = 0; i < sizeof conversions / sizeof conversions[0]; i++)
        if (strcmp(conversions[i].layer, layer) == 0) return conversions[i].conversion;
    return RADIANCE;
}

enum ag_result layer_to_display(struct session *session, const char *layer, float ev,
                                struct ag_image **image)
{
    switch (conversion_of(layer)) {
    case UNCHANGED:
        return AG_OK;
    case DIRECTION:
        show_direction(*image);
        return AG_OK;
    case MOTION:
        show_motion(*image);
        return AG_OK;
    case DEPTH:
        show_depth(*image);
        return AG_OK;
    case RANGE:
        show_range(*image);
        return AG_OK;
    case IDS:
        return show_ids(session, image);
    case IRRADIANCE:
        irradiance_to_radiance(*image);
        break;
    case RADIANCE:
        break;
    }
    return tonemap(session, ev, image);
}

// ---- layers of frames

static enum ag_result read_layers(struct ag_renderer *renderer, const struct output *output,
                                  struct output_images *out)
{
    *out = (struct output_images){ 0 };
    enum ag_result result = ag_renderer_exposure(renderer, &out->ev);
    for (int i = 0; i < output->layer_count && result == AG_OK; i++)
        result = ag_renderer_read(renderer, output->layers[i], &out->layers[i]);
    return result;
}

enum status output_read(struct session *session, struct ag_renderer *renderer,
                        const struct output *output, struct output_images *out)
{
    const enum ag_result result = read_layers(renderer, output, out);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

void output_finish(struct session *session, struct output_images *images)
{
    for (int i = 0; i < MAX_LAYERS; i++) ag_image_destroy(session->context, images->layers[i]);
    ag_image_destroy(session->context, images->radiance);
    *images = (struct output_images){ 0 };
}

static bool is_averaged(const char *layer)
{
    static const char *const averaged[] = { "color",    "direct",     "indirect", "irradiance",
                                            "specular", "visibility", "albedo",   "emissive" };
    for (size_t i = 0; i < sizeof averaged / sizeof *averaged; i++)
        if (strcmp(averaged[i], layer) == 0) return true;
    return false;
}

// Adds a layer of the newest frame to the sum; the last one makes it a mean.
static enum ag_result add_layer_of_frame(struct session *session, struct ag_renderer *renderer,
                                         const char *layer, int index, int count,
                                         struct ag_image **sum)
{
    struct ag_image *image = NULL;
    const enum ag_result result = ag_renderer_read(renderer, layer, &image);
    if (result != AG_OK) return result;
    const size_t values = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < values && index > 0; i++) image->pixels[i] += (*sum)->pixels[i];
    for (size_t i = 0; i < values && index + 1 == count; i++) image->pixels[i] /= (float)count;
    ag_image_destroy(session->context, *sum);
    *sum = image;
    return AG_OK;
}

// Radiance is averaged, then exposed and tone mapped, as for a PNG of the layer color.
static enum ag_result show_mean(struct session *session, struct output_images *out,
                                struct ag_image **display)
{
    struct ag_image *shown = NULL;
    const enum ag_result result = ag_image_tonemap_curve(session->context, out->radiance, out->ev,
                                                         session->arguments->tonemap, &shown);
    if (result != AG_OK) return result;
    ag_image_destroy(session->context, *display);
    *display = shown;
    return AG_OK;
}

enum status output_average(struct session *session, struct ag_renderer *renderer,
                           const struct output *output, int index, int count,
                           struct output_images *out)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < output->layer_count && result == AG_OK; i++) {
        const char *layer = output->layers[i];
        const bool shows = strcmp(layer, "display") == 0;
        struct ag_image **sum = shows ? &out->radiance : &out->layers[i];
        if (!shows && !is_averaged(layer)) continue;
        result = add_layer_of_frame(session, renderer, shows ? "color" : layer, index, count, sum);
        if (result == AG_OK && shows && index + 1 == count)
            result = show_mean(session, out, &out->layers[i]);
    }
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

static enum ag_result write_png(struct session *session, const char *layer,
                                struct output_images *images, const char *path)
{
    enum ag_result result = layer_to_display(session, layer, images->ev, &images->layers[0]);
    interrupt_hold();
    if (result == AG_OK) result = ag_image_write_png(session->context, path, images->layers[0]);
    interrupt_release();
    return result;
}

// ---- EXR

// No time or host name: equal commands write equal files.
static enum ag_result write_exr(struct session *session, struct ag_renderer *renderer,
                                const struct output *output, const struct output_images *images,
                                const char *path)
{
    const struct arguments *a = session->arguments;
    struct ag_image_layer layers[MAX_LAYERS];
    for (int i = 0; i < output->layer_count; i++)
        layers[i] = (struct ag_image_layer){ output->layers[i], images->layers[i] };
    char exposure[32], seed[32], version[32], scale[32], antialias[32];
    int v = ag_version();
    snprintf(exposure, sizeof exposure, "%.9g", (double)images->ev);
    snprintf(scale, sizeof scale, "%.9g", (double)a->scene_scale);
    snprintf(antialias, sizeof antialias, "%d", a->frame_samples);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)a->seed);
    snprintf(version, sizeof version, "%d.%d.%d", v / 10000, v / 100 % 100, v % 100);
    const struct ag_attribute attributes[] = {
        { "afterglow.scene", a->positional[0] },
        { "afterglow.camera", session->camera_name },
        { "afterglow.gi", ag_renderer_gi(renderer) },
        { "afterglow.exposure_ev", exposure },
        { "afterglow.seed", seed },
        { "afterglow.version", version },
        { "afterglow.scene_scale", scale },
        { "afterglow.antialias", antialias },
    };
    const int all = sizeof attributes / sizeof attributes[0];
    const int count = a->frame_samples == 1 ? all - 1 : all;
    interrupt_hold();
    const enum ag_result result =
        ag_image_write_exr(session->context, path, layers, output->layer_count, attributes, count);
    interrupt_release();
    return result;
}

static enum ag_result write_layers(struct session *session, struct ag_renderer *renderer,
                                   const struct output *output, struct output_images *images,
                                   const char *path)
{
    if (output->exr) return write_exr(session, renderer, output, images, path);
    return write_png(session, output->layers[0], images, path);
}

enum ag_result output_try(struct session *session, struct ag_renderer *renderer,
                          const struct output *output, const char *path)
{
    struct output_images images;
    enum ag_result result = read_layers(renderer, output, &images);
    if (result == AG_OK) result = write_layers(session, renderer, output, &images, path);
    output_finish(session, &images);
    return result;
}

enum status output_write(struct session *session, struct ag_renderer *renderer,
                         const struct output *output, struct output_images *images,
                         const char *path)
{
    const enum ag_result result = write_layers(session, renderer, output, images, path);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

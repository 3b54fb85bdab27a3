// Adds samples until there are enough and writes a file at intervals.
#include "tracing.h"
#include "cli/files/interrupt.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static const double LONGEST_STEP_S = 2.0; // between checks of the clock
enum { MAX_ATTRIBUTES = 16 };

const char tracing_kept_layers[] =
    "color,direct,indirect,indirect_emitters_sky,irradiance,irradiance_emitters_sky,error,samples";

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int samples_of(const struct tracing *t)
{
    struct ag_reference_info info = { 0 };
    ag_reference_get_info(t->reference, &info);
    return info.samples;
}

// Eighteen sums of 8 bytes, the tone mapped image, and 4 channels of 4 bytes for each layer.
uint64_t tracing_bytes_per_pixel(int layer_count)
{
    return 18 * 8 + 16 + 16 * (uint64_t)layer_count;
}

struct ag_reference_desc tracing_describe(const struct session *session,
                                          const struct ag_camera *camera)
{
    const struct arguments *a = session->arguments;
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = a->width;
    desc.height = a->height;
    desc.camera = *camera;
    desc.time_s = a->time_s;
    desc.animation = session->animation;
    desc.bounces = a->bounces;
    desc.direct_only = a->direct_only;
    desc.indirect_only = a->indirect_only;
    desc.guiding = !a->no_guiding;
    desc.antialias = a->antialias;
    desc.obscurance_radius_m = a->obscurance_radius_m;
    desc.occlusion_decay_per_m = a->occlusion_decay_per_m;
    desc.obscurance_sphere = a->obscurance_sphere;
    desc.seed = a->seed;
    return desc;
}

enum status tracing_begin(struct tracing *t, struct session *session,
                          const struct ag_camera *camera, int wanted)
{
    *t = (struct tracing){ .session = session,
                           .wanted = wanted,
                           .fov_rad = camera->vertical_fov_rad };
    const struct ag_reference_desc desc = tracing_describe(session, camera);
    enum ag_result result = ag_reference_create(session->scene, &desc, &t->reference);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

void tracing_take(struct tracing *t, struct session *session, const struct ag_camera *camera,
                  struct ag_reference *reference, double seconds)
{
    *t = (struct tracing){ .session = session,
                           .reference = reference,
                           .seconds = seconds,
                           .fov_rad = camera->vertical_fov_rad };
    t->wanted = t->done = samples_of(t);
}

void tracing_end(struct tracing *t)
{
    ag_reference_destroy(t->reference);
    *t = (struct tracing){ 0 };
}

enum ag_result tracing_resume(struct tracing *t, const char *path)
{
    enum ag_result result = ag_reference_resume(t->reference, path);
    if (result == AG_OK) t->begun = t->done = samples_of(t);
    return result;
}

// ---- rendering

struct step {
    const struct tracing *tracing;
    int samples;
};

static bool show_progress(void *user, double done)
{
    const struct step *step = user;
    const struct tracing *t = step->tracing;
    int samples = t->done + (int)(done * step->samples);
    progress("path tracing", samples - t->begun, t->wanted - t->begun);
    return !interrupt_caught();
}

// Number of samples for the next step, estimated from the previous ones.
static int next_step(const struct tracing *t)
{
    int fresh = t->done - t->begun, left = t->wanted - t->done;
    if (fresh == 0) return 1;
    double fit = LONGEST_STEP_S * fresh / fmax(t->seconds, 1e-6);
    return fit < 1.0 ? 1 : fit < left ? (int)fit : left;
}

static enum status render_step(struct tracing *t)
{
    struct step step = { t, next_step(t) };
    double begun = now_s();
    enum ag_result result = ag_reference_render(t->reference, step.samples, show_progress, &step);
    t->seconds += now_s() - begun;
    t->done = samples_of(t);
    if (result == AG_OK || result == AG_ERROR_CANCELLED) return DONE;
    return fail_library(t->session->context, result);
}

static enum status keep(const struct tracing_keeper *keeper)
{
    return keeper->keep ? keeper->keep(keeper->user) : DONE;
}

enum status tracing_converge(struct tracing *t, const struct tracing_keeper *keeper)
{
    enum status status = DONE;
    double kept_s = now_s();
    interrupt_catch();
    while (status == DONE && t->done < t->wanted && !interrupt_caught()) {
        bool first = t->done == t->begun;
        status = render_step(t);
        bool due = (first && keeper->first) || now_s() - kept_s > keeper->every_s;
        if (status != DONE || !due || t->done >= t->wanted || interrupt_caught()) continue;
        status = keep(keeper);
        kept_s = now_s();
    }
    progress_end();
    return status == DONE ? keep(keeper) : status;
}

// ---- what an image depends on

enum { ORIGIN_COUNT = 9 };

static const char *const origin_names[ORIGIN_COUNT] = {
    "afterglow.scene", "afterglow.camera", "afterglow.bounces",
    "afterglow.seed",  "afterglow.size",   "afterglow.fov",
    "afterglow.time",  "afterglow.light",  "afterglow.options",
};
static const char *const origin_labels[ORIGIN_COUNT] = { "scene",  "camera", "--bounces",
                                                         "--seed", "--size", "--fov",
                                                         "--time", "light",  "options" };

struct origin {
    char text[ORIGIN_COUNT][LIGHT_SIZE];
};

static void find_origin(const struct tracing *t, struct origin *out)
{
    const struct arguments *a = t->session->arguments;
    const char *only = a->direct_only ? "--direct-only" : a->indirect_only ? "--indirect-only" : "";
    char scale[32] = "";
    if (a->scene_scale != 1.0f)
        snprintf(scale, sizeof scale, " scene-scale=%.9g", (double)a->scene_scale);
    int i = 0;
    snprintf(out->text[i++], LIGHT_SIZE, "%s", a->positional[0]);
    snprintf(out->text[i++], LIGHT_SIZE, "%s", t->session->camera_name);
    snprintf(out->text[i++], LIGHT_SIZE, a->bounces < 0 ? "unlimited" : "%d", a->bounces);
    snprintf(out->text[i++], LIGHT_SIZE, "%llu", (unsigned long long)a->seed);
    snprintf(out->text[i++], LIGHT_SIZE, "%dx%d", a->width, a->height);
    snprintf(out->text[i++], LIGHT_SIZE, "%.6g", degrees(t->fov_rad));
    snprintf(out->text[i++], LIGHT_SIZE, "%.9g %d", a->time_s, t->session->animation);
    snprintf(out->text[i++], LIGHT_SIZE, "%s",
             t->session->light[0] ? t->session->light : "that of the scene");
    snprintf(out->text[i++], LIGHT_SIZE, "%s guiding=%d antialias=%d radius=%.6g decay=%.6g%s%s",
             only, !a->no_guiding, a->antialias, (double)a->obscurance_radius_m,
             (double)a->occlusion_decay_per_m, a->obscurance_sphere ? " sphere" : "", scale);
}

bool tracing_differences(const struct tracing *t, const char *path, char out[SPEC_SIZE])
{
    struct origin origin;
    char theirs[LIGHT_SIZE];
    size_t used = 0;
    find_origin(t, &origin);
    out[0] = 0;
    for (int i = 0; i < ORIGIN_COUNT && used < SPEC_SIZE; i++) {
        if (ag_image_read_attribute(t->session->context, path, origin_names[i], theirs,
                                    sizeof theirs) != AG_OK)
            return false;
        if (!theirs[0] || strcmp(theirs, origin.text[i]) == 0) continue;
        int wrote = snprintf(out + used, SPEC_SIZE - used, "%s%s %s", used ? ", " : "",
                             origin_labels[i], theirs);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    return used > 0;
}

// ---- files

static enum ag_result write_layers(const struct tracing *t, const char *path,
                                   const struct ag_image_layer *layers, int count,
                                   const struct ag_attribute *more, int more_count)
{
    char version[32];
    struct origin origin;
    int v = ag_version();
    snprintf(version, sizeof version, "%d.%d.%d", v / 10000, v / 100 % 100, v % 100);
    find_origin(t, &origin);
    struct ag_attribute attributes[MAX_ATTRIBUTES] = {
        { "afterglow.version", version },
        { AG_REFERENCE_CHECKPOINT, ag_reference_checkpoint(t->reference) },
    };
    int used = 2;
    for (int i = 0; i < ORIGIN_COUNT; i++)
        attributes[used++] = (struct ag_attribute){ origin_names[i], origin.text[i] };
    for (int i = 0; i < more_count && used < MAX_ATTRIBUTES; i++) attributes[used++] = more[i];
    return ag_image_write_exr(t->session->context, path, layers, count, attributes, used);
}

enum ag_result tracing_write_exr(const struct tracing *t, const struct output *output,
                                 const char *path, const struct ag_attribute *more, int more_count)
{
    struct ag_image *images[MAX_LAYERS] = { 0 };
    struct ag_image_layer layers[MAX_LAYERS];
    enum ag_result result = AG_OK;
    int count = output->layer_count;
    for (int i = 0; i < count && result == AG_OK; i++) {
        result = ag_reference_read(t->reference, output->layers[i], &images[i]);
        layers[i] = (struct ag_image_layer){ output->layers[i], images[i] };
    }
    interrupt_hold();
    if (result == AG_OK) result = write_layers(t, path, layers, count, more, more_count);
    interrupt_release();
    for (int i = 0; i < count; i++) ag_image_destroy(t->session->context, images[i]);
    return result;
}

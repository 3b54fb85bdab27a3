// afterglow reference: the path-traced picture, better with every pass.
#include "commands.h"
#include "interrupt.h"
#include "json.h"
#include "output.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const double WRITE_EVERY_S = 10.0; // while it converges
static const double LONGEST_STEP_S = 2.0; // between two looks at the clock
static const char KEPT_LAYERS[] =
    "color,direct,indirect,gathered,irradiance,gathered_irradiance,error,samples";

struct job {
    const struct arguments *arguments;
    struct session session;
    struct ag_reference *reference;
    struct picture picture;
    char path[PATH_SIZE];
    double render_s, written_s; // time spent in rendering; when the picture was written last
    int done, begun;            // samples; those of the file that was gone on with
    float exposure_ev;
};

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- what the command line alone decides

static enum status plan(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (a->output && strlen(a->output) >= sizeof job->path)
        return wrong_usage("wrong value -o: the path is longer than %d", PATH_SIZE - 1);
    if (a->output)
        snprintf(job->path, sizeof job->path, "%s", a->output);
    else
        output_default(a->positional[0], "-reference.exr", job->path);
    bool exr = has_extension(job->path, "exr");
    if (a->resume && !exr)
        return wrong_usage("cannot use --resume with %s: a PNG cannot be gone on with", job->path);
    return picture_plan(a, job->path, ag_reference_layer_name, exr ? KEPT_LAYERS : "color",
                        &job->picture);
}

static enum status prepare(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = session_load(&job->session, a->positional[0]);
    if (status == DONE) status = session_light(&job->session);
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = a->width;
    desc.height = a->height;
    desc.time_s = a->time_s;
    desc.animation = job->session.animation;
    desc.bounces = a->bounces;
    desc.direct_only = a->direct_only;
    desc.indirect_only = a->indirect_only;
    desc.antialias = a->antialias;
    desc.seed = a->seed;
    if (status == DONE) status = session_camera(&job->session, a->time_s, &desc.camera);
    if (status != DONE) return status;
    enum ag_result result = ag_reference_create(job->session.scene, &desc, &job->reference);
    return result == AG_OK ? DONE : fail_library(job->session.context, result);
}

static int samples_done(const struct job *job)
{
    struct ag_reference_info info = { 0 };
    ag_reference_get_info(job->reference, &info);
    return info.samples;
}

static enum status go_on(struct job *job)
{
    if (!job->arguments->resume || access(job->path, F_OK) != 0) return DONE;
    enum ag_result result = ag_reference_resume(job->reference, job->path);
    if (result != AG_OK) {
        fail_library(job->session.context, result);
        return FAILED; // what the file holds is not the command line's affair
    }
    job->begun = job->done = samples_done(job);
    return DONE;
}

// ---- the picture

static enum ag_result find_exposure(struct job *job)
{
    const struct arguments *a = job->arguments;
    job->exposure_ev = a->exposure_ev;
    if (a->has_exposure) return AG_OK;
    struct ag_image *image = NULL;
    enum ag_result result =
        ag_reference_read(job->reference, a->indirect_only ? "color" : "direct", &image);
    if (result == AG_OK) job->exposure_ev = ag_image_auto_exposure(image);
    ag_image_destroy(job->session.context, image);
    return result;
}

static enum ag_result write_png(struct job *job)
{
    struct ag_context *context = job->session.context;
    const char *layer = job->picture.layers[0];
    struct ag_image *image = NULL;
    enum ag_result result = ag_reference_read(job->reference, layer, &image);
    if (result == AG_OK) result = picture_show(&job->session, layer, job->exposure_ev, &image);
    if (result == AG_OK) result = ag_image_write_png(context, job->path, image);
    ag_image_destroy(context, image);
    return result;
}

static enum ag_result write_layers(struct job *job, const struct ag_image_layer *layers, int count)
{
    const struct arguments *a = job->arguments;
    char exposure[32], seed[32], version[32], bounces[32];
    int v = ag_version();
    snprintf(exposure, sizeof exposure, "%.9g", (double)job->exposure_ev);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)a->seed);
    snprintf(version, sizeof version, "%d.%d.%d", v / 10000, v / 100 % 100, v % 100);
    snprintf(bounces, sizeof bounces, a->bounces < 0 ? "unlimited" : "%d", a->bounces);
    const struct ag_attribute attributes[] = {
        { "afterglow.scene", a->positional[0] },
        { "afterglow.camera", job->session.camera_name },
        { "afterglow.bounces", bounces },
        { "afterglow.exposure_ev", exposure },
        { "afterglow.seed", seed },
        { "afterglow.version", version },
        { AG_REFERENCE_CHECKPOINT, ag_reference_checkpoint(job->reference) },
    };
    return ag_image_write_exr(job->session.context, job->path, layers, count, attributes,
                              sizeof attributes / sizeof attributes[0]);
}

static enum ag_result write_exr(struct job *job)
{
    struct ag_image *images[MAX_LAYERS] = { 0 };
    struct ag_image_layer layers[MAX_LAYERS];
    enum ag_result result = AG_OK;
    int count = job->picture.layer_count;
    for (int i = 0; i < count && result == AG_OK; i++) {
        result = ag_reference_read(job->reference, job->picture.layers[i], &images[i]);
        layers[i] = (struct ag_image_layer){ job->picture.layers[i], images[i] };
    }
    if (result == AG_OK) result = write_layers(job, layers, count);
    for (int i = 0; i < count; i++) ag_image_destroy(job->session.context, images[i]);
    return result;
}

static enum status write_picture(struct job *job)
{
    enum ag_result result = find_exposure(job);
    interrupt_hold();
    if (result == AG_OK) result = job->picture.exr ? write_exr(job) : write_png(job);
    interrupt_release();
    job->written_s = now_s();
    if (result == AG_OK) return DONE;
    fail_library(job->session.context, result);
    return FAILED;
}

// ---- rendering

struct step {
    const struct job *job;
    int samples;
};

static bool show_progress(void *user, double done)
{
    const struct step *step = user;
    int samples = step->job->done + (int)(done * step->samples);
    progress("path tracing", samples - step->job->begun,
             step->job->arguments->spp - step->job->begun);
    return !interrupt_caught();
}

// As many samples as fit into a step, judged by those before.
static int next_step(const struct job *job)
{
    int fresh = job->done - job->begun, left = job->arguments->spp - job->done;
    if (fresh == 0) return 1;
    double fit = LONGEST_STEP_S * fresh / fmax(job->render_s, 1e-6);
    return fit < 1.0 ? 1 : fit < left ? (int)fit : left;
}

static enum status render_step(struct job *job)
{
    struct step step = { job, next_step(job) };
    double begun = now_s();
    enum ag_result result = ag_reference_render(job->reference, step.samples, show_progress, &step);
    job->render_s += now_s() - begun;
    job->done = samples_done(job);
    if (result == AG_OK || result == AG_ERROR_CANCELLED) return DONE;
    return fail_library(job->session.context, result);
}

static enum status converge(struct job *job)
{
    enum status status = DONE;
    while (status == DONE && job->done < job->arguments->spp && !interrupt_caught()) {
        bool first = job->done == job->begun;
        status = render_step(job);
        bool due = first || now_s() - job->written_s > WRITE_EVERY_S;
        if (status == DONE && due && job->done < job->arguments->spp && !interrupt_caught())
            status = write_picture(job);
    }
    progress_end();
    return status == DONE ? write_picture(job) : status;
}

// Ctrl-C ends the work with what there is; a second one ends the program.
static enum status converge_until_interrupted(struct job *job)
{
    interrupt_catch();
    enum status status = converge(job);
    if (status != DONE || job->done >= job->arguments->spp) return status;
    return fail("reference of %s: interrupted after %d of %d samples; %s holds them",
                job->arguments->positional[0], job->done, job->arguments->spp, job->path);
}

// ---- what it says afterwards

static json_t *result_json(const struct job *job, const struct ag_reference_info *info, double rate)
{
    const struct arguments *a = job->arguments;
    json_t *document = json_object();
    if (!document) return NULL;
    json_object_set_new(document, "scene", json_text(a->positional[0]));
    json_object_set_new(document, "camera", json_text(job->session.camera_name));
    json_object_set_new(document, "size", json_pack("[i,i]", a->width, a->height));
    json_object_set_new(document, "spp", json_integer(info->samples));
    json_object_set_new(document, "bounces",
                        a->bounces < 0 ? json_null() : json_integer(a->bounces));
    json_object_set_new(document, "seconds", json_real(job->render_s));
    json_object_set_new(document, "rays", json_integer((json_int_t)info->rays));
    json_object_set_new(document, "rays_per_second", json_double(rate));
    json_object_set_new(document, "mean", json_double(info->mean));
    json_object_set_new(document, "error", json_double(info->error));
    json_object_set_new(document, "exposure_ev", json_float(job->exposure_ev));
    json_object_set_new(document, "output", json_text(job->path));
    return document;
}

static enum status report(struct job *job)
{
    struct ag_reference_info info;
    ag_reference_get_info(job->reference, &info);
    double rate = job->render_s > 0.0 ? (double)info.rays / job->render_s : (double)NAN;
    session_say(&job->session);
    if (info.rays > 0)
        note("%d samples, %.1f million rays in %.1f s: %.2f million a second", info.samples,
             (double)info.rays * 1e-6, job->render_s, rate * 1e-6);
    if (info.mean > 0.0 && isfinite(info.error))
        note("standard error %.3g cd/m2, %.2f %% of the mean", info.error,
             100.0 * info.error / info.mean);
    if (!job->arguments->output) note("written: %s", job->path);
    return job->arguments->json ? json_print(result_json(job, &info, rate)) : DONE;
}

static enum status reference(const struct arguments *arguments)
{
    struct job *job = calloc(1, sizeof *job);
    if (!job) return fail("cannot trace %s: out of memory", arguments->positional[0]);
    job->arguments = arguments;
    enum status status = session_begin(&job->session, arguments);
    if (status == DONE) status = plan(job);
    if (status == DONE) status = output_check(job->path);
    if (status == DONE) status = prepare(job);
    if (status == DONE) status = go_on(job);
    if (status == DONE) status = converge_until_interrupted(job);
    if (status == DONE) status = report(job);
    ag_reference_destroy(job->reference);
    session_end(&job->session);
    free(job);
    return status;
}

const struct command command_reference = {
    .name = "reference",
    .bit = REFERENCE,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "path-traces the same picture on the CPU, to hold the others against",
    .text = "Path-traces SCENE on all cores, with the materials, lights, camera and units of "
            "render; what "
            "glows and\n"
            "the sky light the scene too. The picture is written after the first sample and now "
            "and then, "
            "better each\n"
            "time; Ctrl-C leaves what there is, and --resume goes on with it. The result depends "
            "neither "
            "on the\n"
            "number of cores nor on interruptions but for rounding.\n",
    .examples = "  afterglow reference @cornell --size 256x256 --spp 256\n"
                "      into cornell-reference.exr, with direct and indirect light as layers\n"
                "  afterglow reference @atrium --spp 1024 --size 640x360 --resume -o court.exr\n"
                "      repeated after Ctrl-C, it goes on where it stopped\n"
                "  afterglow reference @cornell --bounces 1 --aov color,irradiance -o one.exr\n"
                "      direct light and one bounce\n"
                "  afterglow reference house.glb --spp 256 --antialias -o house.png\n"
                "      a smooth picture, exposed\n",
    .run = reference,
};

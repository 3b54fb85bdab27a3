// afterglow reference: progressive path tracing; with other processes, as a bake.
#include "cli/bake/baking.h"
#include "commands.h"
#include "images.h"
#include "cli/files/interrupt.h"
#include "cli/files/json.h"
#include "memory.h"
#include "tracing.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double WRITE_EVERY_S = 10.0; // while sampling

struct job {
    const struct arguments *arguments;
    struct session session;
    struct ag_camera camera;
    struct tracing tracing;
    struct baking baking; // of a team
    struct output output;
    char path[PATH_SIZE];
    float exposure_ev;
};

// ---- checks of the command line

static enum status plan(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (a->output && strlen(a->output) >= sizeof job->path)
        return wrong_usage("wrong value -o: the path is longer than %d", PATH_SIZE - 1);
    if (a->output)
        snprintf(job->path, sizeof job->path, "%s", a->output);
    else
        output_default(a->positional[0], "-reference.exr", job->path);
    if (a->resume && a->team)
        return wrong_usage("cannot use --resume with afterglow-mpi: the same command continues an "
                           "interrupted one; leave it out");
    bool exr = has_extension(job->path, "exr");
    if (a->resume && !exr)
        return wrong_usage("cannot use --resume with %s: only an .exr can be resumed", job->path);
    enum status status = output_plan(a, job->path, ag_reference_layer_name,
                                     exr ? tracing_kept_layers : "color", &job->output);
    return status == DONE ? memory_check_size("trace", a->positional[0], a->width, a->height,
                                              tracing_bytes_per_pixel(job->output.layer_count), 0)
                          : status;
}

static enum status prepare(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = session_load(&job->session, a->positional[0], a->scene_scale);
    if (status == DONE) status = session_light(&job->session);
    return status == DONE ? session_camera(&job->session, a->time_s, &job->camera) : status;
}

static enum status resume(struct job *job)
{
    if (!job->arguments->resume || access(job->path, F_OK) != 0) return DONE;
    enum ag_result result = tracing_resume(&job->tracing, job->path);
    if (result == AG_OK) return DONE;
    char names[SPEC_SIZE];
    if (result == AG_ERROR_ARGUMENT && tracing_differences(&job->tracing, job->path, names))
        return fail("cannot resume %s: it was traced with %s", job->path, names);
    fail_library(job->session.context, result);
    return FAILED; // the file's content is not wrong usage
}

// ---- the image

static enum ag_result find_exposure(struct job *job)
{
    const struct arguments *a = job->arguments;
    job->exposure_ev = a->exposure_ev;
    if (a->has_exposure) return AG_OK;
    struct ag_image *color = NULL, *depth = NULL;
    enum ag_result result = ag_reference_read(job->tracing.reference, "color", &color);
    if (result == AG_OK) result = ag_reference_read(job->tracing.reference, "depth", &depth);
    if (result == AG_OK) result = image_exposure(&job->session, color, depth, &job->exposure_ev);
    ag_image_destroy(job->session.context, color);
    ag_image_destroy(job->session.context, depth);
    return result;
}

static enum ag_result write_png(struct job *job)
{
    struct ag_context *context = job->session.context;
    const char *layer = job->output.layers[0];
    struct ag_image *image = NULL;
    enum ag_result result = ag_reference_read(job->tracing.reference, layer, &image);
    if (result == AG_OK) result = layer_to_display(&job->session, layer, job->exposure_ev, &image);
    interrupt_hold();
    if (result == AG_OK) result = ag_image_write_png(context, job->path, image);
    interrupt_release();
    ag_image_destroy(context, image);
    return result;
}

static enum ag_result write_exr(struct job *job)
{
    char exposure[32];
    snprintf(exposure, sizeof exposure, "%.9g", (double)job->exposure_ev);
    const struct ag_attribute more = { "afterglow.exposure_ev", exposure };
    return tracing_write_exr(&job->tracing, &job->output, job->path, &more, 1);
}

static enum status write_output(void *user)
{
    struct job *job = user;
    enum ag_result result = find_exposure(job);
    if (result == AG_OK) result = job->output.exr ? write_exr(job) : write_png(job);
    if (result == AG_OK) return DONE;
    fail_library(job->session.context, result);
    return FAILED;
}

// ---- the samples

// Ctrl-C stops sampling and keeps the samples.
static enum status converge(struct job *job)
{
    const struct tracing_keeper keeper = { write_output, job, WRITE_EVERY_S, true };
    enum status status = tracing_converge(&job->tracing, &keeper);
    const struct tracing *t = &job->tracing;
    if (status != DONE || t->done >= t->wanted) return status;
    return fail("reference of %s: interrupted after %d of %d samples; --resume continues %s",
                job->arguments->positional[0], t->done, t->wanted, job->path);
}

static enum status trace_alone(struct job *job)
{
    enum status status =
        tracing_begin(&job->tracing, &job->session, &job->camera, job->arguments->spp);
    if (status == DONE) status = resume(job);
    if (status == DONE) session_say(&job->session);
    return status == DONE ? converge(job) : status;
}

static enum status take_samples(struct job *job)
{
    struct ag_reference *reference = NULL;
    struct ag_bake_info info = { 0 };
    const struct baking *b = &job->baking;
    const enum ag_result result = ag_reference_from_bake(b->bake, &reference);
    if (result != AG_OK) return fail_library(job->session.context, result);
    ag_bake_get_info(b->bake, &info);
    tracing_take(&job->tracing, &job->session, &job->camera, reference, info.seconds);
    const enum status status = write_output(job);
    if (status == DONE) ag_bake_remove_checkpoint(b->bake);
    return status;
}

// Rank 0 has the samples and writes the image.
static enum status trace_together(struct job *job)
{
    const struct arguments *a = job->arguments;
    const struct ag_reference_desc desc = tracing_describe(&job->session, &job->camera);
    enum status status =
        baking_begin_reference(&job->baking, &job->session, &desc, a->spp, job->path);
    if (status != DONE) return status;
    if (baking_is_followed(a)) return baking_follow(&job->baking);
    session_say(&job->session);
    status = baking_complete(&job->baking, false);
    return status == DONE ? take_samples(job) : status;
}

// ---- results

static json_t *result_json(const struct job *job, const struct ag_reference_info *info, double rate)
{
    const struct arguments *a = job->arguments;
    json_t *document = json_object();
    if (!document) return NULL;
    json_object_set_new(document, "scene_scale", json_float(a->scene_scale));
    json_object_set_new(document, "scene", json_text(a->positional[0]));
    json_object_set_new(document, "camera", json_text(job->session.camera_name));
    json_object_set_new(document, "size", json_pack("[i,i]", a->width, a->height));
    json_object_set_new(document, "spp", json_integer(info->samples));
    json_object_set_new(document, "bounces",
                        a->bounces < 0 ? json_null() : json_integer(a->bounces));
    json_object_set_new(document, "seconds", json_real(job->tracing.seconds));
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
    ag_reference_get_info(job->tracing.reference, &info);
    double seconds = job->tracing.seconds;
    double rate = seconds > 0.0 ? (double)info.rays / seconds : (double)NAN;
    if (info.rays > 0)
        note("%d sample%s, %.1f million rays in %.1f s: %.2f million per second", info.samples,
             info.samples == 1 ? "" : "s", (double)info.rays * 1e-6, seconds, rate * 1e-6);
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
    const bool follows = baking_is_followed(arguments);
    if (status == DONE && !follows) status = whole_file_check(job->path);
    if (status == DONE) status = prepare(job);
    if (status == DONE) status = arguments->team ? trace_together(job) : trace_alone(job);
    if (status == DONE && !follows) status = report(job);
    tracing_end(&job->tracing);
    baking_end(&job->baking);
    session_end(&job->session);
    free(job);
    return status;
}

const struct command command_reference = {
    .name = "reference",
    .bit = REFERENCE,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "path-trace SCENE on the CPU: slow, converges to ground truth",
    .text = "Path-traces SCENE on all cores, with materials, lights and camera as in render.\n"
            "Writes the image after the first sample, every ten seconds, and at the end.\n"
            "Ctrl-C keeps the samples; --resume continues with them.\n"
            "Neither the number of cores nor interruptions change the result, up to rounding.\n"
            "mpirun -n N afterglow-mpi reference … takes the same options but --resume and shares\n"
            "the pixels among N processes, also of several machines: see docs/clusters.md.\n",
    .examples = "  afterglow reference @cornell --size 256x256 --spp 256\n"
                "      into cornell-reference.exr, direct and indirect light as layers\n"
                "  afterglow reference @atrium --size 640x360 --spp 1024 --resume -o atrium.exr\n"
                "      run it again after Ctrl-C to continue\n"
                "  afterglow reference @cornell --bounces 1 --aov color,irradiance -o one.exr\n"
                "      direct light and one bounce\n"
                "  afterglow reference house.glb --spp 256 --antialias -o house.png\n"
                "      an exposed image with smooth edges\n",
    .run = reference,
};

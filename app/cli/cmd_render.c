// afterglow render: frames of a scene, without a window.
#include "cli/bake/baking.h"
#include "commands.h"
#include "memory.h"
#include "output.h"
#include "statistics.h"
#include "values.h"
#include "cli/terminal/waiting.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct job {
    const struct arguments *arguments;
    struct session session;
    struct ag_device *device;
    struct ag_renderer *renderer;
    uint64_t gpu_bytes; // estimate
    struct bakes bakes;
    struct output output;
    struct statistics statistics;
    char pattern[PATH_SIZE]; // of -o
    bool sequence;           // the pattern has a frame number
    bool measure;            // collect times
    float exposure_ev;       // of the newest frame
    int rendered, to_render; // frames, also jittered ones
};

// ---- checks of the command line

static enum status plan_output(struct job *job)
{
    const struct arguments *a = job->arguments;
    if (a->output)
        snprintf(job->pattern, sizeof job->pattern, "%s", a->output);
    else
        output_default(a->positional[0], ".png", job->pattern);
    char first[PATH_SIZE];
    if (a->output && strlen(a->output) >= sizeof job->pattern)
        return wrong_usage("wrong value -o: the path is longer than %d", PATH_SIZE - 1);
    if (!value_frame_path(job->pattern, 0, first, sizeof first, &job->sequence))
        return wrong_usage("wrong value -o %s: at most one frame number (%%04d)", job->pattern);
    bool exr = has_extension(job->pattern, "exr");
    const char *fallback = a->debug_view ? exr ? "color,debug" : "debug" : "color";
    return output_plan(a, job->pattern, ag_layer_name, fallback, &job->output);
}

static enum status check_debug_view(const char *wanted)
{
    const char *known[256];
    int count = 0;
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        if (ag_technique_debug_view_find(i, wanted) >= 0) return DONE;
        for (int k = 0; k < info.debug_view_count && count < 256; k++)
            ag_technique_debug_view_get(i, k, &known[count++], NULL);
    }
    const char *nearest = ag_nearest_name(wanted, known, count);
    if (nearest) return wrong_usage("unknown debug view %s: did you mean %s?", wanted, nearest);
    return wrong_usage("unknown debug view %s: see afterglow list", wanted);
}

static void renderer_desc(const struct job *job, struct ag_renderer_desc *desc)
{
    const struct arguments *a = job->arguments;
    ag_renderer_desc_default(desc);
    desc->width = a->width;
    desc->height = a->height;
    desc->gi = a->gi;
    desc->frame_options = arguments_frame_options(a);
    desc->indirect_layer = output_has_layer(&job->output, "indirect");
    desc->display_layer = output_has_layer(&job->output, "display");
    desc->motion_layer = output_has_layer(&job->output, "motion");
    desc->id_layer = output_has_layer(&job->output, "id");
    desc->wait_for_updates = true; // the same files each time
    desc->scene_size_m = session_scene_size_m(&job->session);
}

static enum status estimate_memory(struct job *job, struct ag_renderer_desc *desc)
{
    renderer_desc(job, desc);
    enum ag_result result = ag_renderer_estimate_memory(
        job->session.context, desc, job->arguments->light_count, &job->gpu_bytes);
    return result == AG_OK ? DONE : fail_library(job->session.context, result);
}

// Detects wrong usage before any file or device is opened.
static enum status check_usage(struct job *job)
{
    const struct arguments *a = job->arguments;
    enum status status = plan_output(job);
    if (a->frame_samples > 1 && a->frame_options && strstr(a->frame_options, "antialias=temporal"))
        return wrong_usage("cannot use --antialias with --frame-options antialias=temporal: choose "
                           "one");
    if (status == DONE && a->debug_view) status = check_debug_view(a->debug_view);
    if (status != DONE) return status;
    struct ag_renderer_desc desc;
    return estimate_memory(job, &desc);
}

static enum status check_outputs(const struct job *job)
{
    const struct arguments *a = job->arguments;
    char path[PATH_SIZE];
    bool sequence;
    value_frame_path(job->pattern, a->frames - 1, path, sizeof path, &sequence);
    enum status status = whole_file_check(path);
    return status == DONE && a->stats ? whole_file_check(a->stats) : status;
}

// ---- rendering

// Layers of 4 channels, and the image in the file's encoding. A software device has its images in
// main memory too.
static enum status check_memory(struct job *job)
{
    const struct arguments *a = job->arguments;
    struct ag_device_info device;
    struct ag_renderer_desc desc;
    enum status status = estimate_memory(job, &desc); // with the size of the scene
    if (status != DONE) return status;
    detail("%s at %dx%d takes at most %.1f MB on the GPU, without the scene", desc.gi, desc.width,
           desc.height, (double)job->gpu_bytes * 1e-6);
    ag_device_get_info(job->device, &device);
    return memory_check_size("render", a->positional[0], a->width, a->height,
                             16 * (uint64_t)(a->frame_samples > 1 ? 3 : 1) +
                                 16 * (uint64_t)job->output.layer_count,
                             device.software ? job->gpu_bytes : 0);
}

static enum status prepare(struct job *job)
{
    const struct arguments *a = job->arguments;
    struct ag_context *context = job->session.context;
    enum status status = session_load(&job->session, a->positional[0], a->scene_scale);
    if (status == DONE) status = session_light(&job->session);
    struct ag_camera camera; // unused: fails early if there is no such camera
    if (status == DONE) status = session_camera(&job->session, a->time_s, &camera);
    if (status != DONE) return status;

    struct ag_device_desc device_desc;
    ag_device_desc_default(&device_desc);
    device_desc.device = a->device;
    enum ag_result result = ag_device_create(context, &device_desc, &job->device);
    if (result != AG_OK) {
        fail_library(context, result);
        return FAILED; // a missing device is not wrong usage
    }
    status = check_memory(job);
    if (status == DONE) status = bakes_prepare(&job->bakes, &job->session, a->gi);
    if (status != DONE) return status;
    struct ag_renderer_desc desc;
    renderer_desc(job, &desc);
    desc.bakes = job->bakes.bakes;
    desc.bake_count = job->bakes.count;
    result = ag_renderer_create(job->device, job->session.scene, &desc, &job->renderer);
    if (result == AG_OK && a->debug_view)
        result = ag_renderer_set_debug_view(job->renderer, a->debug_view);
    return result == AG_OK ? DONE : fail_library(context, result);
}

static enum status describe_frame(struct job *job, int frame, struct ag_frame_desc *desc)
{
    const struct arguments *a = job->arguments;
    ag_frame_desc_default(desc);
    desc->time_s = a->time_s + frame * a->time_step_s;
    desc->animation = job->session.animation;
    desc->auto_exposure = !a->has_exposure;
    desc->exposure_ev = a->exposure_ev;
    return session_camera(&job->session, desc->time_s, &desc->camera);
}

static enum status submit_frame(struct job *job, const struct ag_frame_desc *desc)
{
    progress("rendering", job->rendered, job->to_render);
    waiting_begin(job->rendered, job->to_render);
    const enum ag_result result = ag_renderer_render(job->renderer, desc);
    // The first of several frames includes one-time work.
    const bool counts = job->measure && (job->rendered > 0 || job->to_render == 1);
    const bool measured =
        result != AG_OK || !counts || statistics_add(&job->statistics, job->renderer);
    waiting_end();
    job->rendered++;
    if (result != AG_OK) return fail_library(job->session.context, result);
    return measured ? DONE
                    : fail("cannot measure %s: out of memory", job->arguments->positional[0]);
}

static enum status render_frame(struct job *job, int frame)
{
    const struct arguments *a = job->arguments;
    const struct session *session = &job->session;
    struct ag_frame_desc desc;
    enum status status = describe_frame(job, frame, &desc);
    if (status != DONE) return status;
    enum ag_result result = AG_OK;
    if (a->environment && a->environment_value.turn != 0.0f)
        result =
            environment_turn(session->scene, session->environment, &a->environment_value, frame);
    if (result != AG_OK) return fail_library(session->context, result);
    return submit_frame(job, &desc);
}

// The mean of jittered frames, all with the exposure of the newest frame.
static enum status antialias(struct job *job, int frame, struct output_images *images)
{
    const int count = job->arguments->frame_samples;
    struct ag_frame_desc desc;
    enum status status = describe_frame(job, frame, &desc);
    desc.auto_exposure = false;
    desc.exposure_ev = images->ev;
    for (int i = 0; i < count && status == DONE; i++) {
        ag_jitter(i, count, desc.jitter);
        status = submit_frame(job, &desc);
        if (status == DONE)
            status = output_average(&job->session, job->renderer, &job->output, i, count, images);
    }
    return status;
}

static enum status write_frame(struct job *job, int frame, char path[PATH_SIZE])
{
    bool sequence;
    struct output_images images;
    value_frame_path(job->pattern, frame, path, PATH_SIZE, &sequence);
    enum status status = output_read(&job->session, job->renderer, &job->output, &images);
    if (status == DONE && job->arguments->frame_samples > 1)
        status = antialias(job, frame, &images);
    if (status == DONE)
        status = output_write(&job->session, job->renderer, &job->output, &images, path);
    output_finish(&job->session, &images);
    return status;
}

static enum status render_frames(struct job *job, char last_path[PATH_SIZE])
{
    const int frames = job->arguments->frames, samples = job->arguments->frame_samples;
    const int written = job->sequence ? frames : 1;
    // Progress is a share: the largest product is beyond it.
    const double all = frames + (samples > 1 ? (double)samples * written : 0.0);
    job->to_render = all < INT_MAX ? (int)all : INT_MAX;
    enum status status = DONE;
    for (int i = 0; i < frames && status == DONE; i++) {
        status = render_frame(job, i);
        if (status == DONE && (job->sequence || i + 1 == frames))
            status = write_frame(job, i, last_path);
    }
    progress_end();
    return status;
}

// ---- results

static json_t *result_json(struct job *job, const char *path)
{
    json_t *document =
        statistics_json(&job->statistics, &job->session, job->device, job->renderer, &job->bakes);
    if (!document) return NULL;
    json_object_set_new(document, "scene_scale", json_float(job->arguments->scene_scale));
    json_object_set_new(document, "scene", json_text(job->arguments->positional[0]));
    json_object_set_new(document, "camera", json_text(job->session.camera_name));
    json_object_set_new(document, "antialias", json_integer(job->arguments->frame_samples));
    json_object_set_new(document, "exposure_ev", json_float(job->exposure_ev));
    json_object_set_new(document, "output", json_text(path));
    return document;
}

static void describe_passes(struct job *job)
{
    for (int i = 0; i < job->statistics.pass_count; i++) {
        struct pass_times *times = &job->statistics.passes[i];
        json_t *summary = statistics_summary(times);
        detail("%-24s %9.3f ms (95th percentile %9.3f)", times->name,
               json_number_value(json_object_get(summary, "median")),
               json_number_value(json_object_get(summary, "p95")));
        json_decref(summary);
    }
}

static bool is_black(const struct ag_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < image->channels && c < 3; c++)
            if (image->pixels[i * (size_t)image->channels + (size_t)c] != 0.0f) return false;
    return true;
}

// A view without any light; that of a scene without triangles was noted before.
static void note_black_image(struct job *job)
{
    struct ag_scene_info info = { 0 };
    struct ag_image *color = NULL;
    ag_scene_get_info(job->session.scene, -1, 0.0, &info);
    if (info.triangles > 0 && ag_renderer_read(job->renderer, "color", &color) == AG_OK &&
        is_black(color))
        note("the image is black: no light reaches this view of %s; try %s--sky 600,750,1000 or "
             "another --eye and --target",
             job->arguments->positional[0],
             strcmp(job->arguments->gi, "none") == 0 ? "--gi vct, " : "");
    ag_image_destroy(job->session.context, color);
}

// One frame of a history.
static void note_noise(const struct job *job)
{
    const struct arguments *a = job->arguments;
    if (a->frames == 1 && a->frame_samples == 1 &&
        strstr(ag_renderer_gi(job->renderer), "temporal=true"))
        note("the image has noise: %s accumulates over frames; try --frames 16", a->gi);
}

static enum status report(struct job *job, const char *path)
{
    const struct arguments *a = job->arguments;
    enum status status = DONE;
    enum ag_result result = ag_renderer_exposure(job->renderer, &job->exposure_ev);
    if (result != AG_OK) return fail_library(job->session.context, result);
    if (a->stats) {
        json_t *document = statistics_json(&job->statistics, &job->session, job->device,
                                           job->renderer, &job->bakes);
        status = json_write(document, a->stats);
        json_decref(document);
    }
    if (a->verbose) describe_passes(job);
    if (!a->quiet) note_black_image(job);
    note_noise(job);
    if (status == DONE && a->json) status = json_print(result_json(job, path));
    return status;
}

static enum status render(const struct arguments *arguments)
{
    struct job *job = calloc(1, sizeof *job);
    char path[PATH_SIZE] = "";
    if (!job) return fail("cannot render %s: out of memory", arguments->positional[0]);
    job->arguments = arguments;
    job->measure = arguments->stats || arguments->json || arguments->verbose;
    enum status status = session_begin(&job->session, arguments);
    if (status == DONE) status = check_usage(job);
    if (status == DONE) status = check_outputs(job);
    if (status == DONE) status = bakes_check_files(&job->session, &arguments->gi, 1);
    if (status == DONE) status = prepare(job);
    if (status == DONE) session_say(&job->session);
    if (status == DONE) status = render_frames(job, path);
    if (status == DONE) status = report(job, path);
    if (status == DONE && !arguments->output) note("written: %s", path);

    statistics_finish(&job->statistics);
    ag_renderer_destroy(job->renderer);
    bakes_finish(&job->bakes);
    if (job->device && ag_device_validation_messages(job->device) > 0 && status == DONE)
        status = fail("cannot trust %s: Vulkan validation logged messages (see --verbose)", path);
    struct ag_device *device = job->device;
    ag_scene_destroy(job->session.scene);
    job->session.scene = NULL;
    ag_device_destroy(device);
    session_end(&job->session);
    free(job);
    return status;
}

const struct command command_render = {
    .name = "render",
    .bit = RENDER,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "render SCENE in real time on the GPU, without a window",
    .text = "Renders SCENE on the GPU, without a window, and writes an image.\n"
            "A .png is exposed and tone mapped; an .exr holds linear physical values.\n"
            "Scenes without light get a sun and a faint sky, scenes without camera a view;\n"
            "a note prints the options that give the same light and view.\n",
    .examples =
        "  afterglow render @cornell:light=point\n"
        "      direct light only, into cornell.png\n"
        "  afterglow render @atrium --gi lpv:steps=16 --size 640x360 -o lit.png\n"
        "      light propagation volumes with 16 steps\n"
        "  afterglow render @atrium --gi vct --frames 16 -o vct.png\n"
        "      vct accumulates over frames: the first ones have noise\n"
        "  afterglow render house.glb --gi lpv --light sun:1,-2,0.5:100000,95000,90000\n"
        "      add a sun\n"
        "  afterglow render @atrium --gi lpv --aov color,direct,indirect -o parts.exr\n"
        "      several layers in one file; 'afterglow diff' compares them\n"
        "  afterglow render fox.glb --gi lpv --frames 48 --time-step 0.0416 -o fox-%04d.png\n"
        "      two seconds of an animation\n"
        "  afterglow render @atrium --gi vct --antialias 16 -o smooth.png\n"
        "      smooth edges: the mean of 16 frames\n"
        "  afterglow render @atrium --gi lpv --frames 21 --stats times.json\n"
        "      measure 20 frames; the first warms up\n",
    .run = render,
};

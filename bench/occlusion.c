// Ambient occlusion by voxel cones against rays with the same fall-off (Hong 2015, sec. 2.5.3.3.8),
// and what it takes beside techniques that look into the depth buffer.
//
//     occlusion [--gi TERM]… [--decay G]… [--frames N] [--size WxH] [--spp N] [--maps DIR]
//     [--device NAME] [SCENE]…
//
// For each scene and decay (1/m) the visibility of each term, of which vctao's has that decay, is
// held against the traced one where there is a surface. A term's time is that of its own passes,
// the least of the frames, which are rendered in turns; the first one is left out.
#include "command_line.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_TERMS = 24, MAX_DECAYS = 8, MAX_PASSES = 64, TEXT = 256 };

static const float NO_END_M = 1e6f; // of what the traced rays see

struct bench {
    struct ag_context *context;
    struct ag_device *device;
    const char *terms[MAX_TERMS], *maps, *device_name;
    int term_count, decay_count, width, height, frames, spp;
    float decays[MAX_DECAYS];
    struct bench_scenes scenes;
};

struct way {
    struct ag_renderer *renderer;
    double ms; // least of all frames
    struct ag_image *seen;
};

// What all terms are held against.
struct view {
    const char *name;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    float decay;
    struct ag_image *truth, *depth;
};

// ---- the truth

static enum ag_result trace(const struct bench *bench, struct view *view)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.camera = view->frame.camera;
    desc.direct_only = true; // the light does not matter
    desc.bounces = 0;
    desc.obscurance_radius_m = NO_END_M;
    desc.occlusion_decay_per_m = view->decay;
    struct ag_reference *reference = NULL;
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, bench->spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "ambient_occlusion", &view->truth);
    if (result == AG_OK) result = ag_reference_read(reference, "depth", &view->depth);
    ag_reference_destroy(reference);
    return result;
}

// ---- a term

static enum ag_result open_way(const struct bench *bench, const struct view *view, const char *term,
                               struct way *way)
{
    char gi[TEXT], decay[32] = "";
    if (strncmp(term, "vctao", 5) == 0)
        snprintf(decay, sizeof decay, "%cdecay=%.9g", strchr(term, ':') ? ',' : ':',
                 (double)view->decay);
    snprintf(gi, sizeof gi, "%s%s", term, decay);
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.gi = gi;
    desc.frame_options = "shadow_size=256";
    return ag_renderer_create(bench->device, view->scene, &desc, &way->renderer);
}

// A technique's pass is named "technique.pass".
static double own_passes(struct ag_renderer *renderer, const char *term)
{
    struct ag_timing timings[MAX_PASSES];
    const int count = ag_renderer_timings(renderer, timings, MAX_PASSES);
    const size_t length = strcspn(term, ":");
    double sum = 0.0;
    for (int i = 0; i < count && i < MAX_PASSES; i++)
        if (strncmp(timings[i].name, term, length) == 0 && timings[i].name[length] == '.')
            sum += timings[i].ms;
    return sum;
}

static enum ag_result render(const struct bench *bench, const struct view *view,
                             struct way ways[MAX_TERMS])
{
    enum ag_result result = AG_OK;
    for (int f = 0; f <= bench->frames; f++)
        for (int t = 0; t < bench->term_count && result == AG_OK; t++) {
            struct way *way = &ways[t];
            result = ag_renderer_render(way->renderer, &view->frame);
            if (result == AG_OK) result = ag_renderer_wait(way->renderer);
            if (result != AG_OK || f == 0) continue;
            const double ms = own_passes(way->renderer, bench->terms[t]);
            if (f == 1 || ms < way->ms) way->ms = ms;
        }
    for (int t = 0; t < bench->term_count && result == AG_OK; t++)
        result = ag_renderer_read(ways[t].renderer, "visibility", &ways[t].seen);
    return result;
}

// ---- what comes out

static void print_errors(const struct view *view, const char *term, const struct way *way)
{
    const size_t pixels = (size_t)view->truth->width * (size_t)view->truth->height;
    double sum = 0.0, squares = 0.0, off = 0.0, count = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        if (view->depth->pixels[i] <= 0.0f) continue;
        const double d = (double)way->seen->pixels[i] - (double)view->truth->pixels[i];
        sum += fabs(d);
        squares += d * d;
        off += d;
        count += 1.0;
    }
    const double n = fmax(count, 1.0);
    printf("  %-36s %8.3f %8.4f %8.4f %+8.4f\n", term, way->ms, sum / n, sqrt(squares / n),
           off / n);
    fflush(stdout);
}

static enum ag_result write_map(const struct bench *bench, const struct view *view,
                                const struct ag_image *image, const char *what)
{
    char path[2 * TEXT];
    const char *slash = strrchr(view->name, '/');
    snprintf(path, sizeof path, "%s/%s-%g-%s.png", bench->maps, slash ? slash + 1 : view->name,
             (double)view->decay, what);
    return ag_image_write_png(bench->context, path, image);
}

static enum ag_result show(const struct bench *bench, const struct view *view,
                           const struct way ways[MAX_TERMS])
{
    enum ag_result result = AG_OK;
    printf("%s, %dx%d, decay %g 1/m, %d rays a pixel\n  %-36s %8s %8s %8s %8s\n", view->name,
           bench->width, bench->height, (double)view->decay, bench->spp, "", "ms", "error", "rms",
           "bias");
    for (int t = 0; t < bench->term_count; t++) print_errors(view, bench->terms[t], &ways[t]);
    if (!bench->maps) return AG_OK;
    result = write_map(bench, view, view->truth, "traced");
    for (int t = 0; t < bench->term_count && result == AG_OK; t++)
        result = write_map(bench, view, ways[t].seen, bench->terms[t]);
    return result;
}

// ---- the run

static enum ag_result measure(const struct bench *bench, struct view *view)
{
    struct way ways[MAX_TERMS] = { 0 };
    enum ag_result result = trace(bench, view);
    for (int t = 0; t < bench->term_count && result == AG_OK; t++)
        result = open_way(bench, view, bench->terms[t], &ways[t]);
    if (result == AG_OK) result = render(bench, view, ways);
    if (result == AG_OK) result = show(bench, view, ways);
    for (int t = 0; t < bench->term_count; t++) {
        ag_image_destroy(bench->context, ways[t].seen);
        ag_renderer_destroy(ways[t].renderer);
    }
    ag_image_destroy(bench->context, view->truth);
    ag_image_destroy(bench->context, view->depth);
    view->truth = view->depth = NULL;
    return result;
}

static enum ag_result measure_scene(const struct bench *bench, const char *name)
{
    struct view view = { .name = name };
    ag_frame_desc_default(&view.frame);
    enum ag_result result = ag_scene_load(bench->context, name, &view.scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(view.scene, NULL);
    if (result == AG_OK)
        result = ag_scene_default_camera(view.scene, 0, 0.0, &view.frame.camera, NULL);
    for (int i = 0; i < bench->decay_count && result == AG_OK; i++) {
        view.decay = bench->decays[i];
        result = measure(bench, &view);
    }
    ag_scene_destroy(view.scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    char rest;
    if (strcmp(name, "--gi") == 0 && bench->term_count < MAX_TERMS)
        bench->terms[bench->term_count++] = value;
    else if (strcmp(name, "--decay") == 0 && bench->decay_count < MAX_DECAYS)
        return sscanf(value, "%f%c", &bench->decays[bench->decay_count++], &rest) == 1;
    else if (strcmp(name, "--maps") == 0)
        bench->maps = value;
    else if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &bench->frames, &rest) == 1 && bench->frames >= 1;
    else if (strcmp(name, "--spp") == 0)
        return sscanf(value, "%d%c", &bench->spp, &rest) == 1 && bench->spp >= 1;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &bench->width, &bench->height, &rest) == 2;
    else
        return false;
    return true;
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    static const char *const usual_terms[] = { "vctao", "vo:samples=5", "ssao:samples=12" };
    if (!command_line_parse(argc, argv, parse_option, bench, &bench->scenes)) return false;
    if (bench->term_count == 0)
        for (int i = 0; i < 3; i++) bench->terms[bench->term_count++] = usual_terms[i];
    if (bench->decay_count == 0) bench->decays[bench->decay_count++] = 1.0f;
    command_line_usual_scenes(&bench->scenes, "@cornell", "@atrium");
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = { .width = 320, .height = 180, .frames = 8, .spp = 64 };
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: occlusion [--gi TERM]... [--decay G]... [--frames N] [--size WxH] "
                        "[--spp N] [--maps DIR] [--device NAME] [SCENE]...\n");
        return 2;
    }
    enum ag_result result = ag_context_create(NULL, &bench.context);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench.device_name;
    if (result == AG_OK) result = ag_device_create(bench.context, &desc, &bench.device);
    for (int i = 0; i < bench.scenes.count && result == AG_OK; i++)
        result = measure_scene(&bench, bench.scenes.names[i]);
    if (result != AG_OK)
        fprintf(stderr, "occlusion: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    return result == AG_OK ? 0 : 1;
}

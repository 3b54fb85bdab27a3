// Hong 2015, section 4.2, figures 70 and 71: what interleaved sampling of voxel cone tracing saves,
// and what it changes.
//
//     interleave [--options KEY=VALUE,…] [--resolution N]… [--frames N] [--size WxH] [--maps DIR]
//     [--device NAME] [SCENE]…
//
// For each scene and resolution one frame whose pixels trace all 25 cones, one whose blocks of
// 5 × 5 pixels share them, and one in which every second pixel of every second row does. The time
// of each is that of all its passes over pixels, the least of the frames, which are rendered in
// turns; the difference is that of irradiance: the mean of |shared − raw| over the mean of raw, and
// the difference of the means.
#include "command_line.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_RESOLUTIONS = 8, MAX_PASSES = 64, TEXT = 256 };

enum { RAW, INTERLEAVED, HALF, WAYS };
static const char *const ways[WAYS] = { "interleave=1", "interleave=5", "interleave=5,half=true" };

// The passes over pixels; those before them make voxels and are the same for both.
static const char *const stages[] = { "vct.cones", "vct.edges", "vct.gather", "vct.blur",
                                      "vct.fit" };
enum { STAGES = sizeof stages / sizeof stages[0] };

struct bench {
    struct ag_context *context;
    struct ag_device *device;
    const char *options, *maps, *device_name;
    int width, height, frames;
    int resolutions[MAX_RESOLUTIONS], resolution_count;
    struct bench_scenes scenes;
};

struct way {
    struct ag_renderer *renderer;
    double ms[STAGES]; // least of all frames; 0: it has no such pass
    struct ag_image *irradiance;
};

// ---- one way

static enum ag_result way_open(const struct bench *bench, struct ag_scene *scene, int resolution,
                               int which, struct way *way)
{
    char gi[TEXT];
    snprintf(gi, sizeof gi, "vct:cones=25,resolution=%d,%s%s%s", resolution, ways[which],
             bench->options ? "," : "", bench->options ? bench->options : "");
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.gi = gi;
    return ag_renderer_create(bench->device, scene, &desc, &way->renderer);
}

static void collect(struct way *way)
{
    struct ag_timing timings[MAX_PASSES];
    const int count = ag_renderer_timings(way->renderer, timings, MAX_PASSES);
    for (int s = 0; s < STAGES; s++)
        for (int i = 0; i < count && i < MAX_PASSES; i++) {
            if (strcmp(timings[i].name, stages[s]) != 0) continue;
            if (way->ms[s] == 0.0 || timings[i].ms < way->ms[s]) way->ms[s] = timings[i].ms;
        }
}

static enum ag_result time_frames(const struct bench *bench, const struct ag_frame_desc *frame,
                                  struct way both[WAYS])
{
    enum ag_result result = AG_OK;
    for (int f = 0; f <= bench->frames; f++)
        for (int w = 0; w < WAYS && result == AG_OK; w++) {
            result = ag_renderer_render(both[w].renderer, frame);
            if (result == AG_OK) result = ag_renderer_wait(both[w].renderer);
            if (result == AG_OK && f > 0) collect(&both[w]);
        }
    return result;
}

static double whole(const struct way *way)
{
    double sum = 0.0;
    for (int s = 0; s < STAGES; s++) sum += way->ms[s];
    return sum;
}

// ---- what comes out

struct difference {
    double mean, absolute, bias; // lux, lux, lux
};

static struct difference compare(const struct ag_image *raw, const struct ag_image *seen)
{
    struct difference d = { 0 };
    const size_t values = (size_t)raw->width * (size_t)raw->height * (size_t)raw->channels;
    for (size_t i = 0; i < values; i++) {
        const double off = (double)seen->pixels[i] - (double)raw->pixels[i];
        d.mean += (double)raw->pixels[i] / (double)values;
        d.absolute += fabs(off) / (double)values;
        d.bias += off / (double)values;
    }
    return d;
}

static void print_result(const struct way both[WAYS])
{
    for (int w = 0; w < WAYS; w++) {
        printf("  %-22s %9.2f ms:", ways[w], whole(&both[w]));
        for (int s = 0; s < STAGES; s++)
            if (both[w].ms[s] > 0.0) printf(" %s %.2f", stages[s] + strlen("vct."), both[w].ms[s]);
        putchar('\n');
        if (w == RAW) continue;
        const struct difference d = compare(both[RAW].irradiance, both[w].irradiance);
        const double mean = fmax(d.mean, 1e-30);
        printf("    %.1f times faster; mean |difference| %.2f %% of the mean, difference of the "
               "means %+.2f %%\n",
               whole(&both[RAW]) / fmax(whole(&both[w]), 1e-9), 100.0 * d.absolute / mean,
               100.0 * d.bias / mean);
    }
    fflush(stdout);
}

// The difference of what blocks share, relative to the mean, saturated at a quarter; and all
// pictures of irradiance as a white surface shows it.
static enum ag_result write_maps(const struct bench *bench, const char *scene, int resolution,
                                 const struct way both[WAYS])
{
    const struct ag_image *raw = both[RAW].irradiance;
    const double mean = compare(raw, raw).mean;
    struct ag_image *map = NULL;
    char path[2 * TEXT];
    const char *name = strrchr(scene, '/') ? strrchr(scene, '/') + 1 : scene;
    enum ag_result result =
        ag_image_error_map(bench->context, both[INTERLEAVED].irradiance, raw, NULL,
                           AG_DIFFERENCE_ABSOLUTE, (float)(0.25 * mean), &map);
    snprintf(path, sizeof path, "%s/%s-%d-difference.png", bench->maps, name, resolution);
    if (result == AG_OK) result = ag_image_write_png(bench->context, path, map);
    ag_image_destroy(bench->context, map);
    for (int w = 0; w < WAYS && result == AG_OK; w++) {
        struct ag_image *shown = NULL;
        const float ev = ag_image_auto_exposure(raw);
        result = ag_image_tonemap(bench->context, both[w].irradiance, ev, &shown);
        snprintf(path, sizeof path, "%s/%s-%d-%s.png", bench->maps, name, resolution, ways[w]);
        if (result == AG_OK) result = ag_image_write_png(bench->context, path, shown);
        ag_image_destroy(bench->context, shown);
    }
    return result;
}

// ---- the run

static enum ag_result measure(const struct bench *bench, struct ag_scene *scene, const char *name,
                              const struct ag_frame_desc *frame, int resolution)
{
    struct way both[WAYS] = { 0 };
    enum ag_result result = AG_OK;
    for (int w = 0; w < WAYS && result == AG_OK; w++)
        result = way_open(bench, scene, resolution, w, &both[w]);
    if (result == AG_OK) result = time_frames(bench, frame, both);
    for (int w = 0; w < WAYS && result == AG_OK; w++)
        result = ag_renderer_read(both[w].renderer, "irradiance", &both[w].irradiance);
    if (result == AG_OK) {
        printf("%s, %dx%d, %d voxels\n", name, bench->width, bench->height, resolution);
        print_result(both);
        if (bench->maps) result = write_maps(bench, name, resolution, both);
    }
    for (int w = 0; w < WAYS; w++) {
        ag_image_destroy(bench->context, both[w].irradiance);
        ag_renderer_destroy(both[w].renderer);
    }
    return result;
}

static enum ag_result measure_scene(const struct bench *bench, const char *name)
{
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    enum ag_result result = ag_scene_load(bench->context, name, &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL);
    for (int i = 0; i < bench->resolution_count && result == AG_OK; i++)
        result = measure(bench, scene, name, &frame, bench->resolutions[i]);
    ag_scene_destroy(scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    char rest;
    if (strcmp(name, "--options") == 0)
        bench->options = value;
    else if (strcmp(name, "--maps") == 0)
        bench->maps = value;
    else if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else if (strcmp(name, "--resolution") == 0 && bench->resolution_count < MAX_RESOLUTIONS)
        return sscanf(value, "%d%c", &bench->resolutions[bench->resolution_count++], &rest) == 1;
    else if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &bench->frames, &rest) == 1 && bench->frames >= 1;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &bench->width, &bench->height, &rest) == 2;
    else
        return false;
    return true;
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    if (!command_line_parse(argc, argv, parse_option, bench, &bench->scenes)) return false;
    if (bench->resolution_count == 0) {
        bench->resolutions[bench->resolution_count++] = 64;
        bench->resolutions[bench->resolution_count++] = 128;
    }
    command_line_usual_scenes(&bench->scenes, "@cornell", "@atrium");
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = { .width = 640, .height = 360, .frames = 5 };
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: interleave [--options KEY=VALUE,...] [--resolution N]... [--frames "
                        "N] [--size WxH] "
                        "[--maps DIR] [--device NAME] [SCENE]...\n");
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
        fprintf(stderr, "interleave: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    return result == AG_OK ? 0 : 1;
}

// Interleaved sampling of voxel cone tracing (Hong 2015, section 4.2, figures 70 and 71): time
// saved and error added.
//
//     interleave [--options KEY=VALUE,…] [--resolution N]… [--frames N] [--size WxH] [--maps DIR]
//     [--device NAME] [SCENE]…
//
// For each scene and resolution three variants: 25 cones per pixel, 25 cones shared by blocks of
// 5 × 5 pixels, and the same at half resolution. The time is the sum of the per-pixel passes, each
// the minimum over frames. The difference is that of irradiance from the first variant: mean
// absolute difference and difference of the means, both relative to the mean.
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_RESOLUTIONS = 8 };

enum { PER_PIXEL, INTERLEAVED, HALF, VARIANTS };
static const char *const variants[VARIANTS] = { "interleave=1", "interleave=5",
                                                "interleave=5,half_resolution=true" };

// The per-pixel passes. Voxelization and lighting are the same for all variants.
static const char *const stages[] = { "cones", "edges", "gather", "blur", "upsample" };
enum { STAGES = sizeof stages / sizeof stages[0] };

struct interleave_bench {
    struct bench bench;
    const char *options, *maps;
    int resolutions[MAX_RESOLUTIONS], resolution_count;
};

// One scene and resolution.
struct view {
    const struct interleave_bench *b;
    const char *scene_name;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    int resolution;
    struct ag_renderer *renderers[VARIANTS];
    double ms[VARIANTS][STAGES]; // minimum over frames; 0: no such pass
    struct ag_image *irradiance[VARIANTS];
};

static enum ag_result create_renderer(struct view *view, int variant)
{
    char gi[BENCH_TEXT];
    const char *options = view->b->options;
    snprintf(gi, sizeof gi, "vct:trace=cones,temporal=false,cones=25,resolution=%d,%s%s%s",
             view->resolution, variants[variant], options ? "," : "", options ? options : "");
    return bench_create_renderer(&view->b->bench, view->scene, gi, NULL, &view->renderers[variant]);
}

static void add_sample(void *user, int variant, const struct ag_timing *timings, int count)
{
    struct view *view = user;
    for (int i = 0; i < count; i++) {
        const char *stage = passes_stage(timings[i].name, "vct");
        for (int s = 0; stage && s < STAGES; s++)
            if (strcmp(stage, stages[s]) == 0)
                passes_keep_least(&view->ms[variant][s], timings[i].ms);
    }
}

static double total_ms(const double ms[STAGES])
{
    double sum = 0.0;
    for (int s = 0; s < STAGES; s++) sum += ms[s];
    return sum;
}

// Differences of irradiance, in lux.
struct difference {
    double mean, absolute, bias;
};

static struct difference compare(const struct ag_image *reference, const struct ag_image *image)
{
    struct difference d = { 0 };
    const size_t values =
        (size_t)reference->width * (size_t)reference->height * (size_t)reference->channels;
    for (size_t i = 0; i < values; i++) {
        const double difference = (double)image->pixels[i] - (double)reference->pixels[i];
        d.mean += (double)reference->pixels[i] / (double)values;
        d.absolute += fabs(difference) / (double)values;
        d.bias += difference / (double)values;
    }
    return d;
}

static void print_view(const struct view *view)
{
    printf("%s, %dx%d, %d voxels\n", view->scene_name, view->b->bench.width, view->b->bench.height,
           view->resolution);
    for (int v = 0; v < VARIANTS; v++) {
        printf("  %-34s %9.2f ms:", variants[v], total_ms(view->ms[v]));
        for (int s = 0; s < STAGES; s++)
            if (view->ms[v][s] > 0.0) printf(" %s %.2f", stages[s], view->ms[v][s]);
        putchar('\n');
        if (v == PER_PIXEL) continue;
        const struct difference d = compare(view->irradiance[PER_PIXEL], view->irradiance[v]);
        const double percent = 100.0 / fmax(d.mean, 1e-30);
        printf("    %.1f times faster; mean |difference| %.2f %% of the mean, difference of the "
               "means %+.2f %%\n",
               total_ms(view->ms[PER_PIXEL]) / fmax(total_ms(view->ms[v]), 1e-9),
               d.absolute * percent, d.bias * percent);
    }
    fflush(stdout);
}

static enum ag_result write_map(const struct view *view, const char *content,
                                const struct ag_image *image)
{
    char variant[BENCH_TEXT];
    snprintf(variant, sizeof variant, "%d-%s", view->resolution, content);
    return bench_write_png(&view->b->bench, view->b->maps, view->scene_name, variant, image);
}

// An error map of the interleaved variant that saturates at a quarter of the mean, and the
// irradiance of all variants.
static enum ag_result write_maps(const struct view *view)
{
    struct ag_context *context = view->b->bench.context;
    const struct ag_image *reference = view->irradiance[PER_PIXEL];
    const float full = (float)(0.25 * compare(reference, reference).mean);
    const float ev = ag_image_auto_exposure(reference);
    struct ag_image *map = NULL;
    enum ag_result result = ag_image_error_map(context, view->irradiance[INTERLEAVED], reference,
                                               NULL, AG_DIFFERENCE_ABSOLUTE, full, &map);
    if (result == AG_OK) result = write_map(view, "difference", map);
    ag_image_destroy(context, map);
    for (int v = 0; v < VARIANTS && result == AG_OK; v++) {
        struct ag_image *display = NULL;
        result = ag_image_tonemap(context, view->irradiance[v], ev, &display);
        if (result == AG_OK) result = write_map(view, variants[v], display);
        ag_image_destroy(context, display);
    }
    return result;
}

static enum ag_result measure_resolution(struct view *view)
{
    const struct bench *bench = &view->b->bench;
    enum ag_result result = AG_OK;
    for (int v = 0; v < VARIANTS && result == AG_OK; v++) result = create_renderer(view, v);
    if (result == AG_OK)
        result = passes_alternate(view->renderers, VARIANTS, &view->frame, bench->frames,
                                  add_sample, view);
    for (int v = 0; v < VARIANTS && result == AG_OK; v++)
        result = ag_renderer_read(view->renderers[v], "irradiance", &view->irradiance[v]);
    if (result == AG_OK) print_view(view);
    if (result == AG_OK && view->b->maps) result = write_maps(view);
    for (int v = 0; v < VARIANTS; v++) {
        ag_image_destroy(bench->context, view->irradiance[v]);
        ag_renderer_destroy(view->renderers[v]);
    }
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct interleave_bench *b = user;
    struct view view = { .b = b, .scene_name = name };
    enum ag_result result = bench_open_scene(&b->bench, name, &view.scene, &view.frame);
    for (int i = 0; i < b->resolution_count && result == AG_OK; i++) {
        struct view with_resolution = view;
        with_resolution.resolution = b->resolutions[i];
        result = measure_resolution(&with_resolution);
    }
    ag_scene_destroy(view.scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct interleave_bench *b = user;
    if (strcmp(name, "--resolution") == 0)
        return append_int(value, 1, 4096, b->resolutions, &b->resolution_count, MAX_RESOLUTIONS);
    if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--maps") == 0)
        b->maps = value;
    else
        return false;
    return true;
}

static bool set_defaults(void *user)
{
    struct interleave_bench *b = user;
    if (b->resolution_count == 0)
        for (int r = 64; r <= 128; r *= 2) b->resolutions[b->resolution_count++] = r;
    default_scenes(&b->bench.scenes, "@cornell", "@atrium");
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "interleave",
        .usage = "[--options KEY=VALUE,...] [--resolution N]... [--maps DIR]",
        .options = BENCH_SIZE | BENCH_SCENES,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct interleave_bench b = { .bench = { .width = 640, .height = 360, .frames = 5 } };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

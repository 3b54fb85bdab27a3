// Loos 2015, table 6.1, with errors: volumetric obscurance by 5 and 9 lines and by 12 and 33
// points, the point samples and horizons that the chapter compares it with, area samples, two radii
// and a moving camera.
//
//     paper-vo [--gi SPEC]… [--frames N] [--size WxH] [--radius SHARE] [--spp N] [--device NAME]
//     [--scenes DIR] [SCENE]…
//
// Times are those of a technique's own passes: the pyramid, the estimate, and the filters. Errors
// are differences from the traced obscurance of the same radius, where there is a surface. SPEC*
// adds a second radius of a quarter of the first.
#include "paper_vo_measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SPECS = 24, PATH_SIZE = 1024 };

// print_ratios compares the first five.
enum { LINES_5, POINTS_12, SSAO_12, LINE, AREA };
static const char *const default_specs[] = { [LINES_5] = "vo:samples=5",
                                             [POINTS_12] = "vo:mode=points,samples=12",
                                             [SSAO_12] = "ssao:samples=12",
                                             [LINE] = "vo:samples=1",
                                             [AREA] = "vo:mode=areas,samples=1",
                                             "vo:samples=9",
                                             "vo:mode=points,samples=33",
                                             "ssao:samples=33",
                                             "hbao",
                                             "vo:samples=5,half_resolution=true",
                                             "vo:samples=5,temporal=true",
                                             "vo:samples=5*",
                                             "vo:samples=9*",
                                             "vo:mode=points,samples=12*",
                                             "vo:mode=points,samples=33*" };
enum { DEFAULT_SPECS = sizeof default_specs / sizeof default_specs[0] };

struct vo_bench {
    struct bench bench;
    const char *specs[MAX_SPECS];
    int spec_count, spp;
    double radius_share;
    const char *folder;
};

static void print_result(const char *spec, const struct vo_result *r)
{
    printf("%-34s %8.3f %8.3f %8.3f %8.4f %8.4f %+8.4f %8.4f %8.5f\n", spec, r->pyramid_ms,
           r->estimate_ms, r->filter_ms, r->mean_error, r->rms_error, r->bias, r->ambient_error,
           r->change);
    fflush(stdout);
}

// Ratios that the chapter gives.
static void print_ratios(const struct vo_result *r)
{
    printf("5 lines / 12 points        time %.2f, error %.2f\n",
           r[LINES_5].estimate_ms / r[POINTS_12].estimate_ms,
           r[LINES_5].mean_error / r[POINTS_12].mean_error);
    printf("5 lines / 12 points, ssao  time %.2f, error %.2f, change in the pan %.2f\n",
           r[LINES_5].estimate_ms / r[SSAO_12].estimate_ms,
           r[LINES_5].mean_error / r[SSAO_12].mean_error, r[LINES_5].change / r[SSAO_12].change);
    printf("1 area / 1 line            time %.2f without the pyramid, error %.2f\n",
           r[AREA].estimate_ms / r[LINE].estimate_ms, r[AREA].mean_error / r[LINE].mean_error);
}

static enum ag_result measure_spec(const struct vo_view *view, const char *spec,
                                   struct vo_result *out)
{
    char gi[BENCH_TEXT];
    const size_t length = strcspn(spec, "*");
    snprintf(gi, sizeof gi, "%.*s", (int)length, spec);
    return vo_measure(view, gi, spec[length] == '*', out);
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct vo_bench *b = user;
    struct vo_view view = { .bench = &b->bench, .spp = b->spp };
    struct vo_result results[MAX_SPECS];
    enum ag_result result = vo_view_open(&view, name, b->radius_share);
    for (int s = 0; s < b->spec_count && result == AG_OK; s++) {
        result = measure_spec(&view, b->specs[s], &results[s]);
        if (result != AG_OK) break;
        if (s == 0)
            printf("%s, %dx%d, radius %.4g m, %d rays a pixel, geometry %.3f ms\n"
                   "%-34s %8s %8s %8s %8s %8s %8s %8s %8s\n",
                   name, b->bench.width, b->bench.height, (double)view.radius_m, b->spp,
                   results[0].geometry_ms, "", "pyramid", "estimate", "filter", "error", "rms",
                   "bias", "from AO", "change");
        print_result(b->specs[s], &results[s]);
    }
    if (result == AG_OK && b->specs[0] == default_specs[0]) print_ratios(results);
    putchar('\n');
    vo_view_close(&view);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct vo_bench *b = user;
    char rest;
    if (strcmp(name, "--gi") == 0) return append_text(value, b->specs, &b->spec_count, MAX_SPECS);
    if (strcmp(name, "--spp") == 0) return parse_int(value, 1, 1000000, &b->spp);
    if (strcmp(name, "--radius") == 0)
        return sscanf(value, "%lf%c", &b->radius_share, &rest) == 1 && b->radius_share > 0.0;
    if (strcmp(name, "--scenes") != 0) return false;
    b->folder = value;
    return true;
}

// A courtyard with columns, one with drapes and carvings, and a single object. Files that are
// absent are skipped.
static void add_default_scenes(struct vo_bench *b)
{
    static const char *const files[] = { "sponza.glb", "bunny.glb" };
    static char paths[2][PATH_SIZE];
    struct bench_scenes *scenes = &b->bench.scenes;
    scenes->names[scenes->count++] = "@atrium";
    for (int i = 0; i < 2; i++) {
        snprintf(paths[i], PATH_SIZE, "%s/%s", b->folder, files[i]);
        FILE *file = fopen(paths[i], "rb");
        if (file)
            scenes->names[scenes->count++] = paths[i];
        else
            fprintf(stderr, "paper-vo: %s skipped: no such file (--scenes)\n", paths[i]);
        if (file) fclose(file);
    }
}

static bool set_defaults(void *user)
{
    struct vo_bench *b = user;
    const char *folder = getenv("AFTERGLOW_SCENES");
    if (!b->folder) b->folder = folder && folder[0] ? folder : "scenes";
    default_texts(default_specs, DEFAULT_SPECS, b->specs, &b->spec_count);
    if (b->bench.scenes.count == 0) add_default_scenes(b);
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-vo",
        .usage = "[--gi SPEC]... [--radius SHARE] [--spp N] [--scenes DIR]",
        .options = BENCH_SIZE | BENCH_SCENES,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct vo_bench b = { .bench = { .width = 640, .height = 360, .frames = 20 },
                                 .spp = 64,
                                 .radius_share = 0.02 };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

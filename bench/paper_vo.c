// Loos 2015, table 6.1, with the error beside the time: volumetric obscurance by 5 and 9 lines and
// by 12 and 33 points, the point samples and the horizons that it is compared with, and what the
// chapter says of areas, two radii and moving cameras.
//
//     paper-vo [--gi TERM]… [--frames N] [--size WxH] [--radius SHARE] [--spp N] [--device NAME]
//     [--scenes DIR] [SCENE]…
//
// A technique's time is its own passes': the pyramid, the estimate, and all that follows. Its error
// is the difference from the traced obscurance of the same radius, where there is a surface. TERM*
// looks with a second radius of a quarter.
#include "command_line.h"
#include "paper_vo_measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_TERMS = 24, TEXT = 256, PATH = 1024 };

// The first are held against each other below the table.
enum { LINES_5, POINTS_12, SSAO_12, LINE, AREA, HELD_TERMS };
static const char *const usual_terms[] = { [LINES_5] = "vo:samples=5",
                                           [POINTS_12] = "vo:mode=points,samples=12",
                                           [SSAO_12] = "ssao:samples=12",
                                           [LINE] = "vo:samples=1",
                                           [AREA] = "vo:mode=areas,samples=1",
                                           "vo:samples=9",
                                           "vo:mode=points,samples=33",
                                           "ssao:samples=33",
                                           "hbao",
                                           "vo:samples=5,half=true",
                                           "vo:samples=5,temporal=true",
                                           "vo:samples=5*",
                                           "vo:samples=9*",
                                           "vo:mode=points,samples=12*",
                                           "vo:mode=points,samples=33*" };
enum { USUAL_TERMS = sizeof usual_terms / sizeof usual_terms[0] };

struct bench {
    const char *terms[MAX_TERMS];
    int term_count;
    struct bench_scenes scenes;
    struct vo_view view; // what all scenes share
    double radius_share;
    const char *device_name, *folder;
};

static void print_result(const char *term, const struct vo_result *r)
{
    printf("%-28s %8.3f %8.3f %8.3f %8.4f %8.4f %+8.4f %8.4f %8.5f\n", term, r->pyramid_ms,
           r->estimate_ms, r->after_ms, r->mean_error, r->rms_error, r->bias, r->ambient_error,
           r->change);
    fflush(stdout);
}

// What the chapter claims, as ratios.
static void print_ratios(const struct vo_result *r)
{
    printf("five lines to twelve points   time %.2f, error %.2f\n",
           r[LINES_5].estimate_ms / r[POINTS_12].estimate_ms,
           r[LINES_5].mean_error / r[POINTS_12].mean_error);
    printf("five lines to ssao's twelve   time %.2f, error %.2f, change in the pan %.2f\n",
           r[LINES_5].estimate_ms / r[SSAO_12].estimate_ms,
           r[LINES_5].mean_error / r[SSAO_12].mean_error, r[LINES_5].change / r[SSAO_12].change);
    printf("an area to a line             time %.2f without the pyramid, error %.2f\n",
           r[AREA].estimate_ms / r[LINE].estimate_ms, r[AREA].mean_error / r[LINE].mean_error);
}

static enum ag_result measure_scene(const struct bench *bench, const char *name)
{
    struct vo_view view = bench->view;
    struct vo_result results[MAX_TERMS];
    enum ag_result result = vo_view_open(&view, name, bench->radius_share);
    for (int t = 0; t < bench->term_count && result == AG_OK; t++) {
        char term[TEXT];
        snprintf(term, sizeof term, "%s", bench->terms[t]);
        const size_t length = strlen(term);
        const bool twice = length > 0 && term[length - 1] == '*';
        if (twice) term[length - 1] = '\0';
        result = vo_measure(&view, term, twice, &results[t]);
        if (result != AG_OK) break;
        if (t == 0)
            printf("%s, %dx%d, radius %.4g m, %d rays a pixel, geometry %.3f ms\n"
                   "%-28s %8s %8s %8s %8s %8s %8s %8s %8s\n",
                   name, view.width, view.height, (double)view.radius_m, view.spp,
                   results[0].geometry_ms, "", "pyramid", "estimate", "after", "error", "rms",
                   "bias", "from AO", "change");
        print_result(bench->terms[t], &results[t]);
    }
    if (result == AG_OK && bench->terms[0] == usual_terms[0]) print_ratios(results);
    putchar('\n');
    vo_view_close(&view);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    char rest;
    struct vo_view *view = &bench->view;
    if (strcmp(name, "--gi") == 0 && bench->term_count < MAX_TERMS)
        bench->terms[bench->term_count++] = value;
    else if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &view->frames, &rest) == 1 && view->frames >= 1;
    else if (strcmp(name, "--spp") == 0)
        return sscanf(value, "%d%c", &view->spp, &rest) == 1 && view->spp >= 1;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &view->width, &view->height, &rest) == 2;
    else if (strcmp(name, "--radius") == 0)
        return sscanf(value, "%lf%c", &bench->radius_share, &rest) == 1 &&
               bench->radius_share > 0.0;
    else if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else if (strcmp(name, "--scenes") == 0)
        bench->folder = value;
    else
        return false;
    return true;
}

// An open court, a built one with drapes and carvings, and an object: those of the files that are
// there.
static void take_usual_scenes(struct bench *bench)
{
    static const char *const files[] = { "sponza.glb", "bunny.glb" };
    static char paths[2][PATH];
    bench->scenes.names[bench->scenes.count++] = "@atrium";
    for (int i = 0; i < 2; i++) {
        snprintf(paths[i], PATH, "%s/%s", bench->folder, files[i]);
        FILE *file = fopen(paths[i], "rb");
        if (file)
            bench->scenes.names[bench->scenes.count++] = paths[i];
        else
            fprintf(stderr, "paper-vo: without %s, which is not there\n", paths[i]);
        if (file) fclose(file);
    }
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    if (!command_line_parse(argc, argv, parse_option, bench, &bench->scenes)) return false;
    if (bench->term_count == 0)
        for (int i = 0; i < USUAL_TERMS; i++) bench->terms[bench->term_count++] = usual_terms[i];
    if (bench->scenes.count == 0) take_usual_scenes(bench);
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = { .view = { .width = 640, .height = 360, .frames = 20, .spp = 64 },
                                  .radius_share = 0.02 };
    const char *folder = getenv("AFTERGLOW_SCENES");
    bench.folder = folder && folder[0] ? folder : "scenes";
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: paper-vo [--gi TERM]... [--frames N] [--size WxH] [--radius SHARE] "
                        "[--spp N] [--device NAME] [--scenes DIR] [SCENE]...\n");
        return 2;
    }
    struct vo_view *view = &bench.view;
    enum ag_result result = ag_context_create(NULL, &view->context);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench.device_name;
    if (result == AG_OK) result = ag_device_create(view->context, &desc, &view->device);
    for (int i = 0; i < bench.scenes.count && result == AG_OK; i++)
        result = measure_scene(&bench, bench.scenes.names[i]);
    if (result != AG_OK)
        fprintf(stderr, "paper-vo: %s (%s)\n", ag_context_last_error(view->context),
                ag_result_string(result));
    ag_device_destroy(view->device);
    ag_context_destroy(view->context);
    return result == AG_OK ? 0 : 1;
}

// The tests of Giuffrida 2016, section 6: what dnrt adds to a source beside ambient occlusion in
// screen space, in time and in error against the reference.
//
//     paper-dnrt [--only TEST] [--source SPEC] [--options KEY=VALUE,…] [--scenes DIR] [--out DIR]
//     [--spp N] [--image-width N] [--frames N] [--size WxH] [--csv FILE] [--device NAME]
//
// 1: sizes and coefficients of volumes, ten objects; 2: one, five and ten objects; 3: a corridor,
// and the sign of the change; 4: Sponza; bake: times of bakes.
#include "csv.h"
#include "paper_dnrt/scenes.h"
#include "paper_dnrt/view.h"
#include "plot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define CORNELL  "@cornell:light=point,blocks=false,closed=true,objects=%d"
#define CORRIDOR "@corridor:object=true"

enum { PATH_SIZE = 1024, COUNTS = 3, METHODS = 4 };
static const int COUNT[COUNTS] = { 1, 5, 10 };
static const char *const DELTA[METHODS] = { "", "ssao", "hbao", "dnrt" };

struct dnrt_bench {
    struct bench bench;
    const char *only, *source, *options, *scenes, *out;
    int spp, image_width;
};

static void print_gi(const struct dnrt_bench *b, const char *delta, const char *options,
                     char out[BENCH_TEXT])
{
    const bool dnrt = strcmp(delta, "dnrt") == 0 && (options[0] || b->options);
    snprintf(out, BENCH_TEXT, "%s%s%s%s%s%s%s", b->source, delta[0] ? "+" : "", delta,
             dnrt ? ":" : "", dnrt ? options : "", dnrt && options[0] && b->options ? "," : "",
             dnrt && b->options ? b->options : "");
}

static void start_view(const struct dnrt_bench *b, struct dnrt_view *view)
{
    *view = (struct dnrt_view){ .bench = &b->bench,
                                .width = b->image_width,
                                .height = b->image_width * b->bench.height / b->bench.width,
                                .spp = b->spp };
}

// ---- output

static void print_heading(const struct dnrt_view *view, const char *what)
{
    const struct bench *bench = view->bench;
    printf(
        "\n%s: times at %dx%d, least of %d frames on %s; errors at %dx%d, %d samples, noise %.3f, "
        "%d objects\n\n",
        what, bench->width, bench->height, bench->frames, bench->info.name, view->width,
        view->height, view->spp, view->noise, view->object_count);
}

static void print_errors(const struct dnrt_method *m)
{
    printf("%.4g | %.4f | %.4g | %.4f |\n", m->near.mae, m->near.flip, m->around.mae,
           m->around.flip);
    fflush(stdout);
}

static void write_row(const struct dnrt_view *view, const char *test, const struct dnrt_method *m)
{
    FILE *csv = view->bench->csv;
    if (!csv) return;
    csv_text(csv, test);
    csv_text(csv, m->gi);
    fprintf(csv, "%d,%d,%d,%.4f,%.4f,%.4f,%.4f,%.6g,%.6f,%.6g,%.6f\n", view->object_count,
            view->bench->width, view->bench->height, m->ms, m->stage_ms[0], m->stage_ms[1],
            m->stage_ms[2], m->near.mae, m->near.flip, m->around.mae, m->around.flip);
}

// ---- the source, ssao, hbao and dnrt

static enum ag_result measure_methods(const struct dnrt_bench *b, struct dnrt_view *view,
                                      const char *test, struct dnrt_method methods[METHODS])
{
    enum ag_result result = AG_OK;
    for (int m = 0; m < METHODS; m++) {
        methods[m] = (struct dnrt_method){ .term = DELTA[m] };
        print_gi(b, DELTA[m], "", methods[m].gi);
    }
    for (int m = 0; m < METHODS && result == AG_OK; m++)
        result = dnrt_view_errors(view, &methods[m]);
    if (result == AG_OK) result = dnrt_view_times(view, false, methods, METHODS);
    if (result != AG_OK) return result;
    print_heading(view, test);
    printf("| | ms | of `hbao` | mae | FLIP | mae around | FLIP around |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int m = 0; m < METHODS; m++) {
        printf("| %s | %.2f | %.2f | ", methods[m].gi, methods[m].ms,
               methods[m].ms / methods[2].ms);
        print_errors(&methods[m]);
        write_row(view, test, &methods[m]);
    }
    printf("\nlight %.3f, volumes %.3f, apply %.3f ms", methods[3].stage_ms[0],
           methods[3].stage_ms[1], methods[3].stage_ms[2]);
    struct dnrt_method changing = { .term = "dnrt" };
    snprintf(changing.gi, sizeof changing.gi, "%s", methods[3].gi);
    result = dnrt_view_times(view, true, &changing, 1);
    printf("; with lights that change: %.3f, %.3f, %.3f\n", changing.stage_ms[0],
           changing.stage_ms[1], changing.stage_ms[2]);
    fflush(stdout);
    return result;
}

// ---- test 1

static enum ag_result measure_sizes(const struct dnrt_bench *b)
{
    struct dnrt_view view;
    char name[BENCH_TEXT];
    snprintf(name, sizeof name, CORNELL, 10);
    start_view(b, &view);
    enum ag_result result = dnrt_view_open(&view, name, NULL);
    print_heading(&view, "test 1");
    printf("| size | coefficients | bits | bytes | ms | new light, ms | mae | FLIP | mae around | "
           "FLIP around |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < 12 && result == AG_OK; i++) {
        const int size = 16 << i % 3, coefficients = i / 3 % 2 ? 9 : 4, bits = i / 6 ? 8 : 16;
        struct dnrt_method method = { .term = "dnrt" }, changing;
        char options[64];
        snprintf(options, sizeof options, "size=%d,coefficients=%d,bits=%d", size, coefficients,
                 bits);
        print_gi(b, "dnrt", options, method.gi);
        changing = method;
        result = dnrt_view_errors(&view, &method);
        if (result == AG_ERROR_UNSUPPORTED) { // volumes beyond the device's largest buffer
            printf("| %d | %d | %d | - | - | - | - | - | - | - |\n", size, coefficients, bits);
            result = AG_OK;
            continue;
        }
        if (result == AG_OK) result = dnrt_view_times(&view, false, &method, 1);
        if (result == AG_OK) result = dnrt_view_times(&view, true, &changing, 1);
        if (result != AG_OK) break;
        printf("| %d | %d | %d | %d | %.2f | %.2f | ", size, coefficients, bits,
               size * size * size * 3 * coefficients * bits / 8, method.ms, changing.ms);
        print_errors(&method);
        write_row(&view, "1", &method);
    }
    dnrt_view_close(&view);
    return result;
}

// ---- test 2

static enum ag_result write_plot(const struct dnrt_bench *b, double ms[METHODS][COUNTS])
{
    char path[PATH_SIZE];
    const double x[COUNTS] = { 1, 5, 10 };
    struct plot_series series[METHODS - 1];
    if (!b->out) return AG_OK;
    mkdir(b->out, 0777); // writing the file reports an error
    for (int m = 1; m < METHODS; m++)
        series[m - 1] = (struct plot_series){ DELTA[m], x, ms[m], COUNTS };
    const struct plot plot = { .title = "Time against the number of dynamic objects",
                               .note = "closed Cornell box, after Giuffrida 2016, table 8",
                               .x_label = "objects",
                               .y_label = "time (ms)",
                               .series = series,
                               .series_count = METHODS - 1 };
    snprintf(path, sizeof path, "%s/objects.svg", b->out);
    if (plot_write(path, &plot)) return AG_OK;
    fprintf(stderr, "paper-dnrt: %s: %s\n", path, strerror(errno));
    return AG_ERROR_FILE;
}

static enum ag_result measure_counts(const struct dnrt_bench *b)
{
    static double ms[METHODS][COUNTS];
    enum ag_result result = AG_OK;
    for (int i = 0; i < COUNTS && result == AG_OK; i++) {
        struct dnrt_view view;
        struct dnrt_method methods[METHODS];
        char name[BENCH_TEXT];
        snprintf(name, sizeof name, CORNELL, COUNT[i]);
        start_view(b, &view);
        result = dnrt_view_open(&view, name, NULL);
        if (result == AG_OK) result = measure_methods(b, &view, "test 2", methods);
        for (int m = 0; m < METHODS; m++) ms[m][i] = methods[m].ms;
        dnrt_view_close(&view);
    }
    return result == AG_OK ? write_plot(b, ms) : result;
}

// ---- test 3

// The change by the object before it and beyond it, as seen from the light in the middle, over the
// mean light there, in percent for each colour.
static void print_change(const struct dnrt_view *view, const struct ag_image *with,
                         const struct ag_image *without, const char *name)
{
    const float *centre = view->objects[0].centre;
    double change[2][3] = { { 0 } }, mean[2] = { 0 };
    for (int i = 0; i < view->width * view->height; i++) {
        const float *p = view->position->pixels + 3 * i;
        if (view->around->pixels[i] <= 0.0f) continue;
        const int beyond = (p[0] - centre[0]) * centre[0] + (p[2] - centre[2]) * centre[2] > 0.0f;
        for (int c = 0; c < 3; c++) {
            const double before = (double)without->pixels[without->channels * i + c];
            change[beyond][c] += (double)with->pixels[with->channels * i + c] - before;
            mean[beyond] += before / 3.0;
        }
    }
    printf("| %s |", name);
    for (int s = 0; s < 2; s++)
        for (int c = 0; c < 3; c++) printf(" %+.1f |", 100.0 * change[s][c] / mean[s]);
    putchar('\n');
}

static enum ag_result measure_sign(const struct dnrt_bench *b, struct dnrt_view *view)
{
    struct ag_context *context = b->bench.context;
    struct ag_image *reference = NULL, *source = NULL, *dnrt = NULL;
    char gi[BENCH_TEXT], dnrt_gi[BENCH_TEXT];
    print_gi(b, "", "", gi);
    print_gi(b, "dnrt", "", dnrt_gi);
    enum ag_result result = dnrt_view_render(view, dnrt_gi, &dnrt);
    if (result == AG_OK) result = ag_scene_remove_instance(view->scene, view->objects[0].instance);
    if (result == AG_OK) result = dnrt_view_trace(view, &reference, NULL);
    if (result == AG_OK) result = dnrt_view_render(view, gi, &source);
    if (result == AG_OK) {
        printf("\nchange of the indirect light by the object, %% of the mean\n\n"
               "| | red, before it | green | blue | red, beyond | green | blue |\n"
               "|---|---|---|---|---|---|---|\n");
        print_change(view, view->reference, reference, "reference");
        print_change(view, dnrt, source, dnrt_gi);
        fflush(stdout);
    }
    ag_image_destroy(context, reference);
    ag_image_destroy(context, source);
    ag_image_destroy(context, dnrt);
    return result;
}

static enum ag_result measure_corridor(const struct dnrt_bench *b)
{
    struct dnrt_view view;
    struct dnrt_method methods[METHODS];
    start_view(b, &view);
    enum ag_result result = dnrt_view_open(&view, CORRIDOR, "object");
    if (result == AG_OK) result = measure_methods(b, &view, "test 3", methods);
    if (result == AG_OK && b->spp > 0) result = measure_sign(b, &view);
    dnrt_view_close(&view);
    return result;
}

// ---- test 4

static enum ag_result measure_sponza(const struct dnrt_bench *b)
{
    struct dnrt_view view;
    struct dnrt_method methods[METHODS];
    struct ag_scene *scene = NULL;
    char path[PATH_SIZE];
    struct stat info;
    snprintf(path, sizeof path, "%s/sponza.glb", b->scenes);
    if (stat(path, &info) != 0) {
        printf("\ntest 4: skipped, there is no %s\n", path);
        return AG_OK;
    }
    start_view(b, &view);
    enum ag_result result = dnrt_open_sponza(&b->bench, path, &scene, &view.frame);
    view.scene = scene;
    if (result == AG_OK) result = dnrt_view_open_scene(&view, scene);
    if (result == AG_OK) result = measure_methods(b, &view, "test 4", methods);
    dnrt_view_close(&view);
    return result;
}

// ---- bakes

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum ag_result measure_bake(const struct dnrt_bench *b, struct ag_scene *scene, int size,
                                   int coefficients)
{
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    struct ag_bake_estimate estimate;
    char gi[BENCH_TEXT], options[64];
    snprintf(options, sizeof options, "size=%d,coefficients=%d", size, coefficients);
    print_gi(b, "dnrt", options, gi);
    ag_bake_desc_default(&desc);
    desc.technique = "dnrt";
    enum ag_result result = ag_bake_create(scene, gi, &desc, &bake);
    if (result == AG_OK) result = ag_bake_estimate_cost(bake, false, &estimate);
    const double wall = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    if (result == AG_OK) result = ag_bake_run(bake, NULL, NULL);
    const double processor = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    if (result == AG_OK)
        printf("| %d | %d | %.1f | %.1f | %.1f | %.2f | %.2f |\n", size, coefficients,
               estimate.rays * 1e-6, processor, seconds(CLOCK_MONOTONIC) - wall,
               estimate.rays * 1e-6 / processor, (double)estimate.file_bytes * 1e-6);
    fflush(stdout);
    ag_bake_destroy(bake);
    return result;
}

static enum ag_result measure_bakes(const struct dnrt_bench *b)
{
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    char name[BENCH_TEXT];
    snprintf(name, sizeof name, CORNELL, 10);
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    printf(
        "\nbakes of ten meshes of about 1500 triangles\n\n| size | coefficients | million rays | "
        "processor, s | wall, s | million rays a second | MB |\n|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < 4 && result == AG_OK; i++)
        result = measure_bake(b, scene, 16 << i % 2, i / 2 ? 9 : 4);
    ag_scene_destroy(scene);
    return result;
}

// ---- command line

static const char *const TESTS[] = { "bake", "1", "2", "3", "4" };
enum { TEST_COUNT = sizeof TESTS / sizeof TESTS[0] };

static enum ag_result measure_test(void *user, const char *name)
{
    static enum ag_result (*const tests[TEST_COUNT])(const struct dnrt_bench *) = {
        measure_bakes, measure_sizes, measure_counts, measure_corridor, measure_sponza
    };
    for (int t = 0; t < TEST_COUNT; t++)
        if (strcmp(name, TESTS[t]) == 0) return tests[t](user);
    return AG_OK;
}

static bool is_test(const char *name)
{
    for (int t = 0; t < TEST_COUNT; t++)
        if (strcmp(name, TESTS[t]) == 0) return true;
    return false;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct dnrt_bench *b = user;
    if (strcmp(name, "--spp") == 0) return parse_int(value, 0, 1000000, &b->spp);
    if (strcmp(name, "--image-width") == 0) return parse_int(value, 16, 8192, &b->image_width);
    if (strcmp(name, "--only") == 0 && is_test(value))
        b->only = value;
    else if (strcmp(name, "--source") == 0)
        b->source = value;
    else if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--scenes") == 0)
        b->scenes = value;
    else if (strcmp(name, "--out") == 0)
        b->out = value;
    else
        return false;
    return true;
}

static bool set_defaults(void *user)
{
    struct dnrt_bench *b = user;
    const char *scenes = getenv("AFTERGLOW_SCENES");
    if (!b->scenes) b->scenes = scenes && scenes[0] ? scenes : "scenes";
    for (int t = 0; t < TEST_COUNT; t++)
        if (!b->only || strcmp(b->only, TESTS[t]) == 0)
            b->bench.scenes.names[b->bench.scenes.count++] = TESTS[t];
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-dnrt",
        .usage = "[--only bake|1|2|3|4] [--source SPEC] [--options KEY=VALUE,...] [--scenes DIR] "
                 "[--out DIR] [--spp N] [--image-width N]",
        .options = BENCH_SIZE | BENCH_CSV,
        .csv_header = "test,gi,objects,width,height,ms,light_ms,volumes_ms,apply_ms,near_mae,"
                      "near_flip,around_mae,around_flip",
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_test,
    };
    static struct dnrt_bench b = { .bench = { .width = 1366, .height = 768, .frames = 10 },
                                   .source = "radiosity",
                                   .spp = 256,
                                   .image_width = 320 };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

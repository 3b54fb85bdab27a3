// Delta radiance transfer beside modular radiance transfer, one operator added after the other
// (Loos 2015, sections 5.3 to 5.5): time of each stage, memory, time of creation and error.
//
//     paper-drt [--spp N] [--bounces N] [--options …] [--frames N] [--size WxH] [--csv FILE]
//     [SCENE]…
//
// Frames of all variants alternate. Errors are those of irradiance against the reference, both with
// N bounces.
#include "bakes.h"
#include "bench.h"
#include "csv.h"

#include <stdio.h>
#include <string.h>

enum { VARIANTS = 5, STAGES = 9, GI_SIZE = 1024 };

// Each has one operator more than the one before. The second has geometry images of walls alone.
static const struct {
    const char *name, *technique, *options;
} VARIANT[VARIANTS] = {
    { "mrt", "mrt", ",remainder=false" },
    { "walls", "drt", ",occlusion=false,reflection=false" },
    { "dUb", "drt", ",reflection=false" },
    { "dUc", "drt", ",gather=false" },
    { "Cb", "drt", "" },
};

static const char *const STAGE[STAGES] = { "direct",      "clutter",     "b",
                                           "bounces",     "reconstruct", "light_map",
                                           "clutter_map", "probes",      "apply" };
// The stages that transfer light.
enum { FIRST_TRANSFER = 1, LAST_TRANSFER = 7 };

struct drt_bench {
    struct bench bench;
    const char *options;
    int spp, bounces;
};

struct variant {
    char gi[GI_SIZE];
    double stage_ms[STAGES], create_ms; // stages: medians
    uint64_t bytes;                     // of the technique
    struct ag_metrics error;
};

struct view {
    const struct drt_bench *b;
    const char *name;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    struct ag_image *reference;
    struct ag_renderer *renderers[VARIANTS];
    struct variant variants[VARIANTS];
};

static double transfer_ms(const struct variant *v)
{
    double sum = 0.0;
    for (int i = FIRST_TRANSFER; i <= LAST_TRANSFER; i++) sum += v->stage_ms[i];
    return sum;
}

static double energy(const struct variant *v)
{
    const double *a = v->error.mean_a, *b = v->error.mean_b;
    return (a[0] + a[1] + a[2]) / (b[0] + b[1] + b[2]);
}

// ---- measurement

static enum ag_result trace(struct view *view)
{
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    ag_reference_desc_default(&desc);
    desc.width = view->b->bench.width;
    desc.height = view->b->bench.height;
    desc.camera = view->frame.camera;
    desc.bounces = view->b->bounces;
    fprintf(stderr, "%s: path tracing\n", view->name);
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, view->b->spp, NULL, NULL);
    if (result == AG_OK)
        result = ag_reference_read(reference, "irradiance_emitters_sky", &view->reference);
    ag_reference_destroy(reference);
    return result;
}

static void print_gi(const struct drt_bench *b, int i, char out[GI_SIZE])
{
    snprintf(out, GI_SIZE, "%s:bounces=%d%s%s%s", VARIANT[i].technique, b->bounces,
             VARIANT[i].options, b->options ? "," : "", b->options ? b->options : "");
}

// The bake is in the cache by then.
static enum ag_result create(struct view *view, int i)
{
    const struct bench *bench = &view->b->bench;
    struct variant *v = &view->variants[i];
    struct bench_bakes bakes;
    print_gi(view->b, i, v->gi);
    enum ag_result result = bench_bakes_prepare(&bakes, bench->context, view->scene, v->gi);
    bench_bakes_finish(&bakes);
    const double begun = bench_now_ms();
    if (result == AG_OK)
        result = bench_create_renderer(bench, view->scene, v->gi, "keep_maps=false",
                                       &view->renderers[i]);
    v->create_ms = bench_now_ms() - begun;
    if (result == AG_OK) v->bytes = bench_memory_of(view->renderers[i], VARIANT[i].technique);
    return result;
}

static enum ag_result measure_error(struct view *view, struct ag_renderer *renderer,
                                    struct ag_metrics *out)
{
    struct ag_context *context = view->b->bench.context;
    struct ag_compare_desc desc;
    struct ag_image *image = NULL;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = ag_image_auto_exposure(view->reference);
    enum ag_result result = ag_renderer_read(renderer, "irradiance", &image);
    if (result == AG_OK) result = ag_image_metrics(context, image, view->reference, &desc, out);
    ag_image_destroy(context, image);
    return result;
}

static enum ag_result measure(struct view *view)
{
    static struct pass_time passes[VARIANTS][PASSES_MAX];
    int counts[VARIANTS];
    enum ag_result result = trace(view);
    for (int i = 0; i < VARIANTS && result == AG_OK; i++) result = create(view, i);
    if (result == AG_OK)
        result = passes_measure_all(view->renderers, VARIANTS, &view->frame, view->b->bench.frames,
                                    passes, counts);
    for (int i = 0; i < VARIANTS && result == AG_OK; i++) {
        struct variant *v = &view->variants[i];
        passes_of_stages(passes[i], counts[i], v->gi, STAGE, STAGES, v->stage_ms);
        result = measure_error(view, view->renderers[i], &v->error);
    }
    return result;
}

// ---- output

enum figure { TRANSFER, OVER_MRT, CREATED, MEGABYTES, RELMSE, FLIP, ENERGY, FIGURES };

static double figure_of(const struct view *view, int i, enum figure figure)
{
    const struct variant *v = &view->variants[i];
    const double values[FIGURES] = {
        [TRANSFER] = transfer_ms(v),
        [OVER_MRT] = 100.0 * (transfer_ms(v) / transfer_ms(&view->variants[0]) - 1.0),
        [CREATED] = 1e-3 * v->create_ms,
        [MEGABYTES] = 1e-6 * (double)v->bytes,
        [RELMSE] = v->error.relmse,
        [FLIP] = v->error.flip,
        [ENERGY] = energy(v),
    };
    return values[figure];
}

static void print_view(const struct view *view)
{
    static const char *const figures[FIGURES] = { "transfer, ms", "over mrt, %", "created, s", "MB",
                                                  "relmse",       "flip",        "energy" };
    const struct bench *bench = &view->b->bench;
    printf("%s, %dx%d, medians of %d frames on %s; ms\n%-13s", view->name, bench->width,
           bench->height, bench->frames, bench->info.name, "");
    for (int i = 0; i < VARIANTS; i++) printf(" %9s", VARIANT[i].name);
    for (int s = 0; s < STAGES; s++) {
        printf("\n%-13s", STAGE[s]);
        for (int i = 0; i < VARIANTS; i++) printf(" %9.3f", view->variants[i].stage_ms[s]);
    }
    for (int f = 0; f < FIGURES; f++) {
        printf("\n%-13s", figures[f]);
        for (int i = 0; i < VARIANTS; i++) printf(" %9.4f", figure_of(view, i, (enum figure)f));
    }
    printf("\n\n");
    fflush(stdout);
}

static void write_csv(const struct view *view)
{
    FILE *csv = view->b->bench.csv;
    for (int i = 0; i < VARIANTS; i++) {
        const struct variant *v = &view->variants[i];
        csv_text(csv, view->name);
        csv_text(csv, VARIANT[i].name);
        csv_text(csv, v->gi);
        for (int s = 0; s < STAGES; s++) fprintf(csv, "%.4f,", v->stage_ms[s]);
        fprintf(csv, "%.4f,%.1f,%llu,%.6f,%.6f,%.5f\n", transfer_ms(v), v->create_ms,
                (unsigned long long)v->bytes, v->error.relmse, v->error.flip, energy(v));
    }
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct drt_bench *b = user;
    static struct view view;
    view = (struct view){ .b = b, .name = name };
    enum ag_result result = bench_open_scene(&b->bench, name, &view.scene, &view.frame);
    if (result == AG_OK) result = measure(&view);
    if (result == AG_OK) print_view(&view);
    if (result == AG_OK && b->bench.csv) write_csv(&view);
    for (int i = 0; i < VARIANTS; i++) ag_renderer_destroy(view.renderers[i]);
    ag_image_destroy(b->bench.context, view.reference);
    ag_scene_destroy(view.scene);
    return result;
}

// ---- command line

static bool parse_option(void *user, const char *name, const char *value)
{
    struct drt_bench *b = user;
    if (strcmp(name, "--spp") == 0) return parse_int(value, 1, 1000000, &b->spp);
    if (strcmp(name, "--bounces") == 0) return parse_int(value, 1, 16, &b->bounces);
    if (strcmp(name, "--options") != 0) return false;
    b->options = value;
    return true;
}

static bool set_defaults(void *user)
{
    struct drt_bench *b = user;
    default_scenes(&b->bench.scenes, "@maze:blocks=5,pillars=4,light=point", "@cornell");
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-drt",
        .usage = "[--spp N] [--bounces N] [--options KEY=VALUE,...]",
        .options = BENCH_SIZE | BENCH_CSV | BENCH_SCENES,
        .csv_header = "scene,variant,gi,direct_ms,clutter_ms,b_ms,bounces_ms,reconstruct_ms,"
                      "light_map_ms,clutter_map_ms,probes_ms,apply_ms,transfer_ms,create_ms,bytes,"
                      "relmse,flip,energy",
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct drt_bench b = { .bench = { .width = 160, .height = 90, .frames = 20 },
                                  .spp = 256,
                                  .bounces = 8 };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

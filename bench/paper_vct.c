// The times of Hong 2015, figures 53 to 55 and 70 to 75: light in mips against a sparse voxel
// octree, 25 cones per pixel against cones shared by blocks of 5 × 5 pixels, and their share of a
// frame. Each frame voxelizes the whole scene, as in the paper.
//
//     paper-vct [--resolution N]… [--only FIGURES] [--options KEY=VALUE,…] [--frames N]
//     [--size WxH] [--csv FILE] [--device NAME] [SCENE]…
#include "bench.h"
#include "csv.h"
#include "paper_vct_measure.h"

#include <stdio.h>
#include <string.h>

enum { MAX_RESOLUTIONS = 8 };

#define BOTH(...)                                                                                  \
    {                                                                                              \
        { __VA_ARGS__, NULL },                                                                     \
        {                                                                                          \
            __VA_ARGS__, NULL                                                                      \
        }                                                                                          \
    }

// Figures 53, 54 and 55. The octree uses texel lists for the bounce only.
static const struct vct_stage construction[] = {
    { "voxelization", BOTH("vct.mark", "vct.list", "vct.outermost", "vct.add") },
    { "nodes: marking, allocation", { { NULL }, { "vct.nodes", NULL } } },
    { "light injection", BOTH("vct.inject") },
    { "filling", { { "vct.texels", "vct.fill", NULL }, { "vct.leaves", NULL } } },
    { "averaging of borders", { { NULL }, { "vct.borders", NULL } } },
    { "mip-mapping", BOTH("vct.mips") },
};
enum { CONSTRUCTION = sizeof construction / sizeof construction[0] };

// Figures 70 and 74, with the tracing.
static const struct vct_stage tracing[] = {
    { "cones", BOTH("vct.cones") },
    { "discontinuities", BOTH("vct.edges") },
    { "gathering", BOTH("vct.gather") },
    { "blur", BOTH("vct.blur") },
    { "specular cone", BOTH("vct.specular") },
};
enum { TRACING = sizeof tracing / sizeof tracing[0] };

// Figures 73 and 75. Voxels are lit from shadow maps, so there are no reflective ones.
static const struct vct_stage pipeline[] = {
    { "G-buffer", BOTH("gbuffer") },
    { "shadow maps", BOTH("shadow.") },
    { "voxelization", BOTH("vct.mark", "vct.list", "vct.outermost", "vct.add") },
    { "light injection", BOTH("vct.inject") },
    { "mips", BOTH("vct.texels", "vct.fill", "vct.mips") },
    { "light of sky and emitters", BOTH("vct.bounce") },
    { "cone tracing",
      BOTH("vct.cones", "vct.edges", "vct.gather", "vct.blur", "vct.upsample", "vct.specular") },
    { "direct light, image", BOTH("direct", "exposure", "composite") },
};
enum { PIPELINE = sizeof pipeline / sizeof pipeline[0] };

struct figure {
    const char *numbers, *title;
    const char *methods[VCT_METHODS];
    const char *options[VCT_METHODS];
    const struct vct_stage *stages;
    int stage_count;
};
static const struct figure figures[] = {
    { "53-55",
      "voxelization and voxel lighting",
      { "mips", "octree" },
      { "storage=mips", "storage=svo" },
      construction,
      CONSTRUCTION },
    { "70,74",
      "tracing 25 cones",
      { "raw", "interleaved" },
      { "interleave=1", "interleave=5" },
      tracing,
      TRACING },
    { "73,75",
      "a frame",
      { "raw", "interleaved" },
      { "interleave=1", "interleave=5" },
      pipeline,
      PIPELINE },
};
enum { FIGURES = sizeof figures / sizeof figures[0] };

struct vct_bench {
    struct bench bench;
    int resolutions[MAX_RESOLUTIONS], resolution_count;
    const char *options, *only;
};

// ---- output

static void print_ms(double ms)
{
    if (ms > 0.0)
        printf(" %12.3f", ms);
    else
        printf(" %12s", "-");
}

static void print_row(const char *name, double first, double second)
{
    printf("  %-28s", name);
    print_ms(first);
    print_ms(second);
    if (first > 0.0 && second > 0.0) printf(" %8.2f", second / first);
    putchar('\n');
}

static void print_figure(const struct figure *figure, const struct vct_method *m)
{
    printf("figures %s: %s\n  %-28s %12s %12s %8s\n", figure->numbers, figure->title, "ms",
           figure->methods[0], figure->methods[1], "ratio");
    for (int s = 0; s < figure->stage_count; s++)
        print_row(figure->stages[s].name, m[0].ms[s], m[1].ms[s]);
    print_row("together", m[0].total_ms, m[1].total_ms);
    if (figure->stages == pipeline)
        print_row("frames a second", 1e3 / m[0].total_ms, 1e3 / m[1].total_ms);
    print_row("MiB of vct", (double)m[0].bytes / 1048576.0, (double)m[1].bytes / 1048576.0);
    fflush(stdout);
}

static void write_rows(const struct bench *bench, const char *scene, int resolution,
                       const struct figure *figure, const struct vct_method *m)
{
    for (int k = 0; k < VCT_METHODS; k++)
        for (int s = 0; s <= figure->stage_count; s++) {
            bool total = s == figure->stage_count;
            csv_text(bench->csv, figure->numbers);
            csv_text(bench->csv, scene);
            fprintf(bench->csv, "%d,%s,", resolution, figure->methods[k]);
            csv_text(bench->csv, total ? "together" : figure->stages[s].name);
            fprintf(bench->csv, "%d,%d,%d,%.6f,%llu\n", bench->width, bench->height, bench->frames,
                    total ? m[k].total_ms : m[k].ms[s], (unsigned long long)m[k].bytes);
        }
}

// ---- measurement

static enum ag_result measure_figure(const struct vct_bench *b, const char *name,
                                     struct ag_scene *scene, const struct ag_frame_desc *frame,
                                     int resolution, const struct figure *figure)
{
    char gi[VCT_METHODS][BENCH_TEXT];
    struct vct_measurement measurement = { .bench = &b->bench,
                                           .scene = scene,
                                           .frame = frame,
                                           .stages = figure->stages,
                                           .stage_count = figure->stage_count };
    for (int k = 0; k < VCT_METHODS; k++) {
        snprintf(gi[k], sizeof gi[k],
                 "vct:trace=cones,temporal=false,resolution=%d,bounces=1,%s%s%s", resolution,
                 figure->options[k], b->options ? "," : "", b->options ? b->options : "");
        measurement.gi[k] = gi[k];
    }
    struct vct_method methods[VCT_METHODS];
    enum ag_result result = vct_measure(&measurement, methods);
    if (result != AG_OK) return result;
    print_figure(figure, methods);
    if (b->bench.csv) write_rows(&b->bench, name, resolution, figure, methods);
    return AG_OK;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct vct_bench *b = user;
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    for (int r = 0; r < b->resolution_count && result == AG_OK; r++) {
        printf("%s, %d voxels, %dx%d, minimum of %d frames on %s\n", name, b->resolutions[r],
               b->bench.width, b->bench.height, b->bench.frames, b->bench.info.name);
        for (int f = 0; f < FIGURES && result == AG_OK; f++)
            if (!b->only || strcmp(b->only, figures[f].numbers) == 0)
                result = measure_figure(b, name, scene, &frame, b->resolutions[r], &figures[f]);
        putchar('\n');
    }
    ag_scene_destroy(scene);
    return result;
}

// ---- command line

static bool is_figure(const char *numbers)
{
    for (int f = 0; f < FIGURES; f++)
        if (strcmp(figures[f].numbers, numbers) == 0) return true;
    return false;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct vct_bench *b = user;
    if (strcmp(name, "--resolution") == 0)
        return append_int(value, 1, 4096, b->resolutions, &b->resolution_count, MAX_RESOLUTIONS);
    if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--only") == 0 && is_figure(value))
        b->only = value;
    else
        return false;
    return true;
}

static bool set_defaults(void *user)
{
    struct vct_bench *b = user;
    if (b->resolution_count == 0)
        for (int r = 64; r <= 256; r *= 2) b->resolutions[b->resolution_count++] = r;
    default_scenes(&b->bench.scenes, "@atrium", "@cornell:light=point");
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-vct",
        .usage = "[--resolution N]... [--only 53-55|70,74|73,75] [--options KEY=VALUE,...]",
        .options = BENCH_SIZE | BENCH_CSV | BENCH_SCENES,
        .csv_header = "figures,scene,resolution,method,stage,width,height,frames,ms,bytes",
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct vct_bench b = { .bench = { .width = 640, .height = 360, .frames = 5 } };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

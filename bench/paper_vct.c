// The times of Hong 2015, figures 53 to 55 and 70 to 75: light kept in mips against a sparse voxel
// octree, each pixel tracing 25 cones against blocks of 5 × 5 that share them, and what that is of
// a frame. All voxels are made anew in every frame, as in the paper.
//
//     paper-vct [--resolution N]… [--only FIGURES] [--options KEY=VALUE,…] [--frames N]
//     [--size WxH] [--csv FILE] [--device NAME] [SCENE]…
#include "command_line.h"
#include "csv.h"
#include "paper_vct_measure.h"

#include <stdio.h>
#include <string.h>

enum { MOST_RESOLUTIONS = 8, TEXT = 256 };

#define BOTH(...)                                                                                  \
    {                                                                                              \
        { __VA_ARGS__, NULL },                                                                     \
        {                                                                                          \
            __VA_ARGS__, NULL                                                                      \
        }                                                                                          \
    }

// Figures 53, 54 and 55. Lists of texels serve the mips, and in the octree only the bounce.
static const struct vct_stage construction[] = {
    { "voxelisation", BOTH("vct.mark", "vct.list", "vct.add") },
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

// Figures 73 and 75. Voxels ask shadow maps, so that there are no reflective ones.
static const struct vct_stage pipeline[] = {
    { "G-buffer", BOTH("gbuffer") },
    { "shadow maps", BOTH("shadow.") },
    { "voxelisation", BOTH("vct.mark", "vct.list", "vct.add") },
    { "light injection", BOTH("vct.inject") },
    { "mips", BOTH("vct.texels", "vct.fill", "vct.mips") },
    { "light of sky and glow", BOTH("vct.bounce") },
    { "cone tracing",
      BOTH("vct.cones", "vct.edges", "vct.gather", "vct.blur", "vct.fit", "vct.specular") },
    { "direct light, picture", BOTH("direct", "exposure", "composite") },
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
      "making voxels and their light",
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

struct bench {
    struct ag_context *context;
    struct ag_device *device;
    struct bench_scenes scenes;
    int resolutions[MOST_RESOLUTIONS], resolution_count;
    int width, height, frames;
    const char *options, *only, *device_name, *csv_path;
    FILE *csv;
};

// ---- what comes out

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
    print_row("together", m[0].all_ms, m[1].all_ms);
    if (figure->stages == pipeline)
        print_row("frames a second", 1e3 / m[0].all_ms, 1e3 / m[1].all_ms);
    print_row("MiB of vct", (double)m[0].bytes / 1048576.0, (double)m[1].bytes / 1048576.0);
    fflush(stdout);
}

static void write_rows(const struct bench *bench, const char *scene, int resolution,
                       const struct figure *figure, const struct vct_method *m)
{
    for (int k = 0; k < VCT_METHODS; k++)
        for (int s = 0; s <= figure->stage_count; s++) {
            bool all = s == figure->stage_count;
            csv_text(bench->csv, figure->numbers);
            csv_text(bench->csv, scene);
            fprintf(bench->csv, "%d,%s,", resolution, figure->methods[k]);
            csv_text(bench->csv, all ? "together" : figure->stages[s].name);
            fprintf(bench->csv, "%d,%d,%d,%.6f,%llu\n", bench->width, bench->height, bench->frames,
                    all ? m[k].all_ms : m[k].ms[s], (unsigned long long)m[k].bytes);
        }
}

// ---- the run

static enum ag_result measure_figure(struct bench *bench, const char *name, struct ag_scene *scene,
                                     const struct ag_frame_desc *frame, int resolution,
                                     const struct figure *figure)
{
    char gi[VCT_METHODS][TEXT];
    struct vct_measurement how = { .device = bench->device,
                                   .scene = scene,
                                   .frame = frame,
                                   .width = bench->width,
                                   .height = bench->height,
                                   .frames = bench->frames,
                                   .stages = figure->stages,
                                   .stage_count = figure->stage_count };
    for (int k = 0; k < VCT_METHODS; k++) {
        snprintf(gi[k], sizeof gi[k], "vct:resolution=%d,bounces=1,keep_static=false,%s%s%s",
                 resolution, figure->options[k], bench->options ? "," : "",
                 bench->options ? bench->options : "");
        how.gi[k] = gi[k];
    }
    struct vct_method methods[VCT_METHODS];
    enum ag_result result = vct_measure(&how, methods);
    if (result != AG_OK) return result;
    print_figure(figure, methods);
    if (bench->csv) write_rows(bench, name, resolution, figure, methods);
    return AG_OK;
}

static enum ag_result measure_scene(struct bench *bench, const char *name)
{
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    struct ag_device_info device;
    ag_frame_desc_default(&frame);
    ag_device_get_info(bench->device, &device);
    enum ag_result result = ag_scene_load(bench->context, name, &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL);
    for (int r = 0; r < bench->resolution_count && result == AG_OK; r++) {
        printf("%s, %d voxels, %dx%d, least of %d frames on %s\n", name, bench->resolutions[r],
               bench->width, bench->height, bench->frames, device.name);
        for (int f = 0; f < FIGURES && result == AG_OK; f++)
            if (!bench->only || strcmp(bench->only, figures[f].numbers) == 0)
                result =
                    measure_figure(bench, name, scene, &frame, bench->resolutions[r], &figures[f]);
        putchar('\n');
    }
    ag_scene_destroy(scene);
    return result;
}

static enum ag_result run(struct bench *bench)
{
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench->device_name;
    enum ag_result result = ag_device_create(bench->context, &desc, &bench->device);
    if (bench->csv)
        fputs("figures,scene,resolution,method,stage,width,height,frames,ms,bytes\n", bench->csv);
    for (int i = 0; i < bench->scenes.count && result == AG_OK; i++)
        result = measure_scene(bench, bench->scenes.names[i]);
    return result;
}

static bool is_figure(const char *numbers)
{
    for (int f = 0; f < FIGURES; f++)
        if (strcmp(figures[f].numbers, numbers) == 0) return true;
    return false;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    char rest;
    if (strcmp(name, "--resolution") == 0 && bench->resolution_count < MOST_RESOLUTIONS)
        return sscanf(value, "%d%c", &bench->resolutions[bench->resolution_count++], &rest) == 1;
    if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &bench->frames, &rest) == 1 && bench->frames >= 1 &&
               bench->frames <= 1000;
    if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &bench->width, &bench->height, &rest) == 2;
    if (strcmp(name, "--options") == 0)
        bench->options = value;
    else if (strcmp(name, "--only") == 0 && is_figure(value))
        bench->only = value;
    else if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else if (strcmp(name, "--csv") == 0)
        bench->csv_path = value;
    else
        return false;
    return true;
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    if (!command_line_parse(argc, argv, parse_option, bench, &bench->scenes)) return false;
    if (bench->resolution_count == 0)
        for (int r = 64; r <= 256; r *= 2) bench->resolutions[bench->resolution_count++] = r;
    command_line_usual_scenes(&bench->scenes, "@atrium", "@cornell:light=point");
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = { .width = 640, .height = 360, .frames = 5 };
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: paper-vct [--resolution N]... [--only 53-55|70,74|73,75] "
                        "[--options KEY=VALUE,...] "
                        "[--frames 1..1000] [--size WxH] [--csv FILE] [--device NAME] "
                        "[SCENE]...\n");
        return 2;
    }
    if (!csv_open(bench.csv_path, &bench.csv)) return 1;
    enum ag_result result = ag_context_create(NULL, &bench.context);
    if (result == AG_OK) result = run(&bench);
    if (result != AG_OK)
        fprintf(stderr, "paper-vct: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    const bool written = csv_close(bench.csv, bench.csv_path);
    return result == AG_OK && written ? 0 : 1;
}

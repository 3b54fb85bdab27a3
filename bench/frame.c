// What a frame costs: milliseconds of GPU time for each pass, median and 95th percentile, for each
// sum of techniques side by side.
//
//     frame [--gi SUM]… [--frames N] [--size WxH] [--device NAME] [--csv FILE] [SCENE]…
#include "command_line.h"
#include "csv.h"
#include "passes.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

enum { MAX_SUMS = 8 };

struct pass {
    char name[48];
    struct pass_time by_sum[MAX_SUMS]; // count 0: the sum does not have the pass
};

struct bench {
    const char *sums[MAX_SUMS];
    struct bench_scenes scenes;
    int sum_count, width, height, frames;
    const char *device_name, *csv_path;
    FILE *csv;
    struct ag_context *context;
    struct ag_device *device;
    struct pass passes[PASSES_MAX]; // of the scene at hand
    int pass_count;
};

// ---- measuring

static struct pass *pass_of(struct bench *bench, const char *name)
{
    for (int i = 0; i < bench->pass_count; i++)
        if (strcmp(bench->passes[i].name, name) == 0) return &bench->passes[i];
    if (bench->pass_count == PASSES_MAX) return NULL;
    struct pass *pass = &bench->passes[bench->pass_count++];
    *pass = (struct pass){ 0 };
    snprintf(pass->name, sizeof pass->name, "%.*s", (int)sizeof pass->name - 1, name);
    return pass;
}

static enum ag_result measure_sum(struct bench *bench, struct ag_scene *scene,
                                  const struct ag_frame_desc *frame, int sum)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.gi = bench->sums[sum];
    struct ag_renderer *renderer = NULL;
    struct pass_time times[PASSES_MAX];
    int count = 0;
    enum ag_result result = ag_renderer_create(bench->device, scene, &desc, &renderer);
    if (result == AG_OK) result = passes_measure(renderer, frame, bench->frames, times, &count);
    ag_renderer_destroy(renderer);
    for (int i = 0; i < count; i++) {
        struct pass *pass = pass_of(bench, times[i].name);
        if (pass) pass->by_sum[sum] = times[i];
    }
    return result;
}

// ---- what comes out

static void print_table(const struct bench *bench, const char *scene)
{
    struct ag_device_info device;
    ag_device_get_info(bench->device, &device);
    printf("%s, %dx%d, %d frames on %s; ms, median and p95\n", scene, bench->width, bench->height,
           bench->frames, device.name);
    printf("%-24s", "");
    for (int s = 0; s < bench->sum_count; s++) printf("  %18.18s", bench->sums[s]);
    putchar('\n');
    for (int p = 0; p < bench->pass_count; p++) {
        const struct pass *pass = &bench->passes[p];
        printf("%-24s", pass->name);
        for (int s = 0; s < bench->sum_count; s++) {
            if (pass->by_sum[s].count > 0)
                printf("  %9.3f%9.3f", pass->by_sum[s].median_ms, pass->by_sum[s].p95_ms);
            else
                printf("  %9s%9s", "-", "-");
        }
        putchar('\n');
    }
    putchar('\n');
    fflush(stdout);
}

static void write_csv(const struct bench *bench, const char *scene)
{
    for (int s = 0; s < bench->sum_count; s++) {
        for (int p = 0; p < bench->pass_count; p++) {
            const struct pass *pass = &bench->passes[p];
            if (pass->by_sum[s].count == 0) continue;
            csv_text(bench->csv, scene);
            csv_text(bench->csv, bench->sums[s]);
            csv_text(bench->csv, pass->name);
            fprintf(bench->csv, "%d,%d,%d,%.6f,%.6f\n", bench->width, bench->height,
                    pass->by_sum[s].count, pass->by_sum[s].median_ms, pass->by_sum[s].p95_ms);
        }
    }
}

// ---- the run

static enum ag_result measure_scene(struct bench *bench, const char *name)
{
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    bench->pass_count = 0;
    enum ag_result result = ag_scene_load(bench->context, name, &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL);
    for (int s = 0; s < bench->sum_count && result == AG_OK; s++)
        result = measure_sum(bench, scene, &frame, s);
    ag_scene_destroy(scene);
    if (result != AG_OK) return result;
    print_table(bench, name);
    if (bench->csv) write_csv(bench, name);
    return AG_OK;
}

static enum ag_result run(struct bench *bench)
{
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench->device_name;
    enum ag_result result = ag_device_create(bench->context, &desc, &bench->device);
    if (bench->csv) fputs("scene,gi,pass,width,height,frames,median_ms,p95_ms\n", bench->csv);
    for (int i = 0; i < bench->scenes.count && result == AG_OK; i++)
        result = measure_scene(bench, bench->scenes.names[i]);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    char rest;
    if (strcmp(name, "--gi") == 0 && bench->sum_count < MAX_SUMS)
        bench->sums[bench->sum_count++] = value;
    else if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &bench->frames, &rest) == 1 && bench->frames >= 1 &&
               bench->frames <= PASSES_MAX_FRAMES;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &bench->width, &bench->height, &rest) == 2;
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
    if (bench->sum_count == 0) {
        static const char *const usual[] = { "none", "ambient", "lpv" };
        for (int i = 0; i < 3; i++) bench->sums[bench->sum_count++] = usual[i];
    }
    command_line_usual_scenes(&bench->scenes, "@atrium", "@cornell:light=point");
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = { .width = 640, .height = 360, .frames = 20 };
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr,
                "usage: frame [--gi SUM]... [--frames 1..%d] [--size WxH] [--device NAME] "
                "[--csv FILE] [SCENE]...\n",
                PASSES_MAX_FRAMES);
        return 2;
    }
    if (!csv_open(bench.csv_path, &bench.csv)) return 1;
    enum ag_result result = ag_context_create(NULL, &bench.context);
    if (result == AG_OK) result = run(&bench);
    if (result != AG_OK)
        fprintf(stderr, "frame: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    const bool written = csv_close(bench.csv, bench.csv_path);
    return result == AG_OK && written ? 0 : 1;
}

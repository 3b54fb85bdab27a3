// GPU time of a frame, pass by pass: median and 95th percentile in milliseconds, for several GI
// specs side by side.
//
//     frame [--gi SPEC]… [--frames N] [--size WxH] [--device NAME] [--csv FILE] [SCENE]…
#include "bench.h"
#include "csv.h"

#include <stdio.h>
#include <string.h>

enum { MAX_SPECS = 8 };

struct pass {
    char name[48];
    struct pass_time by_spec[MAX_SPECS]; // count 0: this spec does not have the pass
};

struct frame_bench {
    struct bench bench;
    const char *specs[MAX_SPECS];
    int spec_count;
    struct pass passes[PASSES_MAX]; // of the current scene
    int pass_count;
};

static struct pass *pass_of(struct frame_bench *b, const char *name)
{
    for (int i = 0; i < b->pass_count; i++)
        if (strcmp(b->passes[i].name, name) == 0) return &b->passes[i];
    if (b->pass_count == PASSES_MAX) return NULL;
    struct pass *pass = &b->passes[b->pass_count++];
    *pass = (struct pass){ 0 };
    snprintf(pass->name, sizeof pass->name, "%.*s", (int)sizeof pass->name - 1, name);
    return pass;
}

static enum ag_result measure_spec(struct frame_bench *b, struct ag_scene *scene,
                                   const struct ag_frame_desc *frame, int spec)
{
    struct ag_renderer *renderer = NULL;
    struct pass_time times[PASSES_MAX];
    int count = 0;
    enum ag_result result =
        bench_create_renderer(&b->bench, scene, b->specs[spec], "keep_maps=false", &renderer);
    if (result == AG_OK) result = passes_measure(renderer, frame, b->bench.frames, times, &count);
    ag_renderer_destroy(renderer);
    for (int i = 0; i < count; i++) {
        struct pass *pass = pass_of(b, times[i].name);
        if (pass) pass->by_spec[spec] = times[i];
    }
    return result;
}

static void print_table(const struct frame_bench *b, const char *scene)
{
    printf("%s, %dx%d, %d frames on %s; ms, median and p95\n", scene, b->bench.width,
           b->bench.height, b->bench.frames, b->bench.info.name);
    printf("%-24s", "");
    for (int s = 0; s < b->spec_count; s++) printf("  %18.18s", b->specs[s]);
    putchar('\n');
    for (int p = 0; p < b->pass_count; p++) {
        const struct pass *pass = &b->passes[p];
        printf("%-24s", pass->name);
        for (int s = 0; s < b->spec_count; s++) {
            if (pass->by_spec[s].count > 0)
                printf("  %9.3f%9.3f", pass->by_spec[s].median_ms, pass->by_spec[s].p95_ms);
            else
                printf("  %9s%9s", "-", "-");
        }
        putchar('\n');
    }
    putchar('\n');
    fflush(stdout);
}

static void write_csv(const struct frame_bench *b, const char *scene)
{
    for (int s = 0; s < b->spec_count; s++) {
        for (int p = 0; p < b->pass_count; p++) {
            const struct pass_time *time = &b->passes[p].by_spec[s];
            if (time->count == 0) continue;
            csv_text(b->bench.csv, scene);
            csv_text(b->bench.csv, b->specs[s]);
            csv_text(b->bench.csv, b->passes[p].name);
            fprintf(b->bench.csv, "%d,%d,%d,%.6f,%.6f\n", b->bench.width, b->bench.height,
                    time->count, time->median_ms, time->p95_ms);
        }
    }
}

static enum ag_result measure_scene(void *user, const char *name)
{
    struct frame_bench *b = user;
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    b->pass_count = 0;
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    for (int s = 0; s < b->spec_count && result == AG_OK; s++)
        result = measure_spec(b, scene, &frame, s);
    ag_scene_destroy(scene);
    if (result != AG_OK) return result;
    print_table(b, name);
    if (b->bench.csv) write_csv(b, name);
    return AG_OK;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct frame_bench *b = user;
    return strcmp(name, "--gi") == 0 && append_text(value, b->specs, &b->spec_count, MAX_SPECS);
}

static bool set_defaults(void *user)
{
    static const char *const specs[] = { "none", "ambient", "lpv" };
    struct frame_bench *b = user;
    default_texts(specs, 3, b->specs, &b->spec_count);
    default_scenes(&b->bench.scenes, "@atrium", "@cornell:light=point");
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "frame",
        .usage = "[--gi SPEC]...",
        .options = BENCH_SIZE | BENCH_CSV | BENCH_SCENES,
        .csv_header = "scene,gi,pass,width,height,frames,median_ms,p95_ms",
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct frame_bench b = { .bench = { .width = 640, .height = 360, .frames = 20 } };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

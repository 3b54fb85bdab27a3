// Efficiency of a bake on 1 to 256 processes: the measured times of its tasks, dealt out as rank 0
// of ag_bake_run_team does.
//
//     scaling [--gi SPEC] [--spp N] [--repeat N]… [--threads N] [--bandwidth GBIT] [--csv FILE]
//     [SCENE]…
//
// Each process has one thread, which is the hardest case: rank 0 has the most others to serve. spp:
// paths per texel of a light map; 0, the default: the data of the technique. repeat: N times the
// work of the first wave, as a light map with N times the paths has: in tasks of 16384 paths, or of
// a tile of 16 texels where that has more; default 1. threads: of the measurement. The model has,
// per wave, the tasks in their order; 3 ms for a task to be given to an idle thread at the end;
// results that pass the link of rank 0 one after the other; and inputs, which it sends to every
// rank. Each rank repeats the plan of the bake, with its charts, and the scene's rays.
#include "bench.h"

#include <jansson.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_RANKS = 256, MOST_REPEATS = 8 };
static const double LATENCY_S = 3e-3;
static const double FETCH_S = 0.02; // of src/bake/lead.c

struct scaling {
    const char *gi, *csv;
    int spp, threads;
    int repeats[MOST_REPEATS], repeat_count;
    double bytes_per_s;
};

// The parts of a run on some ranks, in seconds. `alone`: one rank works, or each repeats the same.
struct shares {
    double wall, alone, longest_tail, inputs, results;
};

// ---- the model

static bool is_of_wave(const json_t *stage, int wave)
{
    return (int)json_number_value(json_object_get(stage, "wave")) == wave;
}

static double sum_of(const json_t *stages, int wave, const char *name)
{
    double sum = 0.0;
    const json_t *stage;
    size_t s;
    json_array_foreach(stages, s,
                       stage) if ((int)json_number_value(json_object_get(stage, "wave")) == wave)
        sum += json_number_value(json_object_get(stage, name));
    return sum;
}

struct dealing {
    double free_at[MOST_RANKS];
    int ranks;
    size_t left; // tasks
    double end, last_begin;
};

// To the rank that is free first. A rank has its next task already, but for the last ones.
static void deal_task(struct dealing *d, double seconds)
{
    int first = 0;
    for (int r = 1; r < d->ranks; r++)
        if (d->free_at[r] < d->free_at[first]) first = r;
    d->last_begin = d->free_at[first];
    const bool waits = first > 0 && d->left <= 2 * (size_t)d->ranks;
    d->left--;
    d->free_at[first] += seconds + (waits ? LATENCY_S : 0.0);
    d->end = fmax(d->end, d->free_at[first]);
}

// As src/lightmap/rows.c and gather.h have them.
enum { PATHS_PER_TASK = 16384, TEXELS_OF_TILE = 16 };

// Tasks into which one that is repeated is divided.
static int pieces_of(const struct scaling *b, int repeat)
{
    const int tiles = b->spp > 0 ? PATHS_PER_TASK / (TEXELS_OF_TILE * b->spp) : repeat;
    return tiles < 1 ? 1 : tiles < repeat ? tiles : repeat;
}

static struct dealing deal(const struct scaling *b, const json_t *stages, int wave, int repeat,
                           int ranks)
{
    const int times = wave == 0 ? pieces_of(b, repeat) : 1;
    const double longer = wave == 0 ? (double)repeat / times : 1.0;
    struct dealing d = { .ranks = ranks };
    d.left = (size_t)sum_of(stages, wave, "tasks") * (size_t)times;
    const json_t *stage, *seconds;
    size_t s, i;
    for (int again = 0; again < times; again++)
        json_array_foreach(stages, s, stage) json_array_foreach(
            json_object_get(stage, "task_seconds"), i, seconds) if (is_of_wave(stage, wave))
            deal_task(&d, longer * json_number_value(seconds));
    return d;
}

static void replay_wave(const struct scaling *b, const json_t *stages, int wave, int repeat,
                        int ranks, struct shares *out)
{
    const double work = sum_of(stages, wave, "seconds"), tasks = sum_of(stages, wave, "tasks");
    const double send = FETCH_S + sum_of(stages, wave, "input_bytes") / b->bytes_per_s;
    const double worth = wave == 0 ? ranks : 1.0 + floor(sqrt(work / send));
    const int on = tasks > 1 ? (int)fmin(ranks, worth) : 1;
    const struct dealing d = deal(b, stages, wave, repeat, on);
    const double others = on - 1;
    const double inputs = others * sum_of(stages, wave, "input_bytes") / b->bytes_per_s;
    const double results = others / on * sum_of(stages, wave, "result_bytes") / b->bytes_per_s;
    out->inputs += inputs;
    out->results += fmax(0.0, results - d.end);
    out->longest_tail += on > 1 ? d.end - d.last_begin : 0.0;
    if (on == 1) out->alone += d.end;
    out->wall += inputs + fmax(d.end, results);
}

static struct shares replay(const struct scaling *b, const json_t *report, int repeat, int ranks)
{
    const json_t *stages = json_object_get(report, "stages");
    const json_t *last = json_array_get(stages, json_array_size(stages) - 1);
    const int waves = 1 + (int)json_number_value(json_object_get(last, "wave"));
    struct shares out = { .wall = json_number_value(json_object_get(report, "prepare_seconds")) +
                                  json_number_value(json_object_get(report, "plan_seconds")) };
    out.alone = out.wall;
    for (int wave = 0; wave < waves; wave++) replay_wave(b, stages, wave, repeat, ranks, &out);
    return out;
}

// ---- the measurement

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static json_t *measure(const struct scaling *b, struct ag_context *context, const char *name)
{
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    const char *text = NULL;
    ag_bake_desc_default(&desc);
    desc.threads = b->threads;
    desc.lightmap_samples = b->spp;
    enum ag_result result = ag_scene_load(context, name, &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    const double begun = now_s();
    if (result == AG_OK) result = ag_bake_create(scene, b->gi, &desc, &bake);
    const double planned_s = now_s() - begun;
    if (result == AG_OK) result = ag_bake_run(bake, NULL, NULL);
    if (result == AG_OK) result = ag_bake_report(bake, &text);
    if (result != AG_OK) fprintf(stderr, "scaling: %s\n", ag_context_last_error(context));
    json_t *report = text ? json_loads(text, 0, NULL) : NULL;
    if (report) json_object_set_new(report, "plan_seconds", json_real(planned_s));
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    return report;
}

static void print_row(FILE *file, const struct scaling *b, const char *scene, const json_t *report,
                      int repeat, int ranks)
{
    const struct shares one = replay(b, report, repeat, 1), many = replay(b, report, repeat, ranks);
    fprintf(file, "%s,%s,%d,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f\n", scene, b->gi, b->spp * repeat,
            ranks, many.wall, one.wall / many.wall / ranks, many.alone, many.longest_tail,
            many.inputs, many.results);
}

static bool run_scene(const struct scaling *b, struct ag_context *context, const char *scene,
                      FILE *file)
{
    json_t *report = measure(b, context, scene);
    if (!report) return false;
    for (int i = 0; i < b->repeat_count; i++)
        for (int ranks = 1; ranks <= MOST_RANKS; ranks *= 2)
            print_row(file, b, scene, report, b->repeats[i], ranks);
    fflush(file);
    json_decref(report);
    return true;
}

// ---- the program

static bool parse(void *user, const char *name, const char *value)
{
    struct scaling *b = user;
    int gigabits = 0;
    if (strcmp(name, "--gi") == 0) return (b->gi = value) != NULL;
    if (strcmp(name, "--csv") == 0) return (b->csv = value) != NULL;
    if (strcmp(name, "--spp") == 0) return parse_int(value, 0, 1000000, &b->spp);
    if (strcmp(name, "--repeat") == 0)
        return append_int(value, 1, 1000000, b->repeats, &b->repeat_count, MOST_REPEATS);
    if (strcmp(name, "--threads") == 0) return parse_int(value, 1, 1024, &b->threads);
    if (strcmp(name, "--bandwidth") != 0 || !parse_int(value, 1, 1000, &gigabits)) return false;
    b->bytes_per_s = gigabits * 1e9 / 8.0;
    return true;
}

int main(int argc, char **argv)
{
    struct scaling b = { .gi = "radiosity", .threads = 1, .bytes_per_s = 1e10 / 8.0 };
    struct bench_scenes scenes = { 0 };
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    if (!command_line_parse(argc, argv, parse, &b, &scenes)) return 2;
    default_scenes(&scenes, "@atrium", "@cornell");
    if (b.repeat_count == 0) b.repeats[b.repeat_count++] = 1;
    ag_context_desc_default(&desc);
    if (ag_context_create(&desc, &context) != AG_OK) return 1;
    FILE *file = b.csv ? fopen(b.csv, "w") : stdout;
    bool ok = file != NULL;
    if (ok)
        fprintf(file, "scene,gi,spp,ranks,seconds,efficiency,rank_0_alone_s,last_tasks_s,inputs_s,"
                      "results_s\n");
    for (int i = 0; ok && i < scenes.count; i++) ok = run_scene(&b, context, scenes.names[i], file);
    if (b.csv && file) ok = fclose(file) == 0 && ok;
    ag_context_destroy(context);
    return ok ? 0 : 1;
}

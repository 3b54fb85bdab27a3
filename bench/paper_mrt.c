// Repeats tables and figures of B. J. Loos, "Modular Radiance Transfer", 2015: table 3.2 (modes of
// the closed cube), table 3.3 (times of two mazes), figure 3.13 (time against the number of
// blocks) and figure 4.13 (the same by part of the run time).
//
//     paper-mrt [--out DIR] [--only 3.2|3.3|mazes] [--options …] [--most N] [--seeds N] [--runs N]
//     [--frames N]
//
// Writes table-3.2.csv, table-3.3.csv, figure-3.13.csv, figure-4.13.csv and .svg of the figures.
#include "bakes.h"
#include "bench.h"
#include "csv.h"
#include "paper_mrt_solver.h"
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 1024, STEP = 5, MOST = 125, SIZES = MOST / STEP };

// One bounce of a point light. The light version is that of the paper's tablet.
static const char FULL[] = "mrt:bounces=1,emitters=false";
static const char LIGHT[] =
    "mrt:bounces=1,emitters=false,texels=6,modes=12,response_modes=12,vector=false";

// Parts of a frame, which are passes of the renderer.
enum { PARTS = 5 };
static const char *const PART_NAMES[PARTS] = { "direct", "b", "bounces", "reconstruct",
                                               "light_map" };

struct mrt_bench {
    struct bench bench;
    const char *out, *only, *options;
    int most, seeds, runs;
};

struct maze_time {
    int blocks;
    struct paper_solver_time solver;
    double create_ms;      // of the renderer, with geometry images, scene and pipelines
    double part_ms[PARTS]; // medians
};

static double transfer_ms(const struct maze_time *time)
{
    return time->part_ms[1] + time->part_ms[2] + time->part_ms[3];
}

// ---- measurement

// With the options of the command line.
static const char *gi_of(const struct mrt_bench *b, const char *gi, char out[PATH_SIZE])
{
    snprintf(out, PATH_SIZE, "%s%s%s", gi, b->options ? "," : "", b->options ? b->options : "");
    return out;
}

// A bake of the maze; its dictionary is that of all scenes.
static enum ag_result open_bakes(const struct mrt_bench *b, const char *gi, struct ag_scene **scene,
                                 struct bench_bakes *bakes, struct paper_dictionary **dictionary)
{
    enum ag_result result = ag_scene_load(b->bench.context, "@maze", scene);
    if (result == AG_OK) result = bench_bakes_prepare(bakes, b->bench.context, *scene, gi);
    if (result == AG_OK) result = paper_dictionary_open(bakes->owned[0], dictionary);
    return result;
}

static enum ag_result measure_parts(const struct mrt_bench *b, const char *gi, const char *maze,
                                    struct maze_time *out)
{
    static struct pass_time passes[PASSES_MAX];
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    struct ag_renderer *renderer = NULL;
    int count = 0;
    enum ag_result result = bench_open_scene(&b->bench, maze, &scene, &frame);
    const double begun = bench_now_ms();
    if (result == AG_OK)
        result = bench_create_renderer(&b->bench, scene, gi, "keep_maps=false", &renderer);
    out->create_ms = bench_now_ms() - begun;
    if (result == AG_OK) result = passes_measure(renderer, &frame, b->bench.frames, passes, &count);
    passes_of_stages(passes, count, gi, PART_NAMES, PARTS, out->part_ms);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    return result;
}

static enum ag_result measure_maze(const struct mrt_bench *b, const char *gi,
                                   const struct paper_dictionary *dictionary, int blocks, int seed,
                                   struct maze_time *out)
{
    char maze[BENCH_TEXT];
    *out = (struct maze_time){ .blocks = blocks };
    snprintf(maze, sizeof maze, "@maze:blocks=%d,seed=%d,light=point", blocks, seed);
    enum ag_result result = paper_solver_measure(dictionary, blocks, seed, b->runs, &out->solver);
    return result == AG_OK ? measure_parts(b, gi, maze, out) : result;
}

// ---- output

static FILE *open_table(const struct mrt_bench *b, const char *name, const char *header,
                        char path[PATH_SIZE])
{
    FILE *file = NULL;
    snprintf(path, PATH_SIZE, "%s/%s", b->out, name);
    return csv_open(path, header, &file) ? file : NULL;
}

static enum ag_result close_table(FILE *file, const char *path)
{
    return csv_close(file, path) ? AG_OK : AG_ERROR_FILE;
}

// ---- table 3.2

static enum ag_result write_modes(const struct mrt_bench *b, const struct ag_bake *bake)
{
    static const struct {
        const char *name, *sigma;
        int paper[3];
    } operators[] = { { "F", "sigma_F", { 164, 240, 313 } },
                      { "Ld", "sigma_L", { 22, 41, 62 } },
                      { "M", "sigma_M", { 1, 5, 8 } } };
    static const int percent[3] = { 80, 90, 95 };
    char path[PATH_SIZE];
    FILE *file = open_table(b, "table-3.2.csv", "operator,percent,modes,paper_modes", path);
    if (!file) return AG_ERROR_FILE;
    printf("table 3.2: modes for 80, 90, 95 %% of the energy (paper)\n");
    for (int i = 0; i < 3; i++) {
        printf("%-4s", operators[i].name);
        for (int p = 0; p < 3; p++) {
            const int modes = paper_mrt_modes(bake, operators[i].sigma, 0.01 * percent[p]);
            fprintf(file, "%s,%d,%d,%d\n", operators[i].name, percent[p], modes,
                    operators[i].paper[p]);
            printf("  %4d (%d)", modes, operators[i].paper[p]);
        }
        printf("\n");
    }
    return close_table(file, path);
}

// Without enrichment, as in the paper; interfaces are not needed.
static enum ag_result measure_modes(const struct mrt_bench *b)
{
    static const char gi[] = "mrt:enrich=false,lightfield_rounds=0,lightfield_positions=4,"
                             "lightfield_directions=6,lightfield_supersampling=1";
    struct ag_scene *scene = NULL;
    struct ag_bake *bake = NULL;
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    desc.full_report = true;
    enum ag_result result = ag_scene_load(b->bench.context, "@maze", &scene);
    if (result == AG_OK) result = ag_bake_create(scene, gi, &desc, &bake);
    if (result == AG_OK) result = ag_bake_run(bake, NULL, NULL);
    if (result == AG_OK) result = write_modes(b, bake);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    return result;
}

// ---- table 3.3

// Milliseconds of the paper: tablet or x86, GPU; 11 and 41 blocks.
struct version {
    const char *name, *gi;
    double cpu_ms[2], gpu_ms[2];
};
static const struct version VERSIONS[] = {
    { "full", FULL, { 1.4, 6.2 }, { 0.4, 1.0 } },
    { "light", LIGHT, { 2.0, 12.9 }, { NAN, NAN } },
};

static void print_paper(FILE *file, double ms)
{
    if (isnan(ms))
        fputc(',', file);
    else
        fprintf(file, ",%.1f", ms);
}

static enum ag_result measure_version(const struct mrt_bench *b, const struct version *version,
                                      FILE *file)
{
    static const int blocks[2] = { 11, 41 };
    char text[PATH_SIZE];
    const char *gi = gi_of(b, version->gi, text);
    struct ag_scene *scene = NULL;
    struct bench_bakes bakes = { .count = 0 };
    struct paper_dictionary *dictionary = NULL;
    enum ag_result result = open_bakes(b, gi, &scene, &bakes, &dictionary);
    for (int i = 0; i < 2 && result == AG_OK; i++) {
        struct maze_time time;
        result = measure_maze(b, gi, dictionary, blocks[i], 1, &time);
        if (result != AG_OK) break;
        fprintf(file, "%s,%d,%d,%d,%.2f,%.1f,%.4f,%.4f", version->name,
                paper_dictionary_texels(dictionary), paper_dictionary_modes(dictionary), blocks[i],
                time.solver.level_ms, time.create_ms, time.solver.solve_ms, transfer_ms(&time));
        print_paper(file, version->cpu_ms[i]);
        print_paper(file, version->gpu_ms[i]);
        fputc('\n', file);
        printf("%-6s %3d %10.3f %10.3f %10.1f %10.1f %12.1f\n", version->name, blocks[i],
               time.solver.solve_ms, transfer_ms(&time), time.solver.level_ms, time.create_ms,
               version->cpu_ms[i]);
    }
    paper_dictionary_close(dictionary);
    bench_bakes_finish(&bakes);
    ag_scene_destroy(scene);
    return result;
}

static enum ag_result measure_table(const struct mrt_bench *b)
{
    char path[PATH_SIZE];
    enum ag_result result = AG_OK;
    FILE *file =
        open_table(b, "table-3.3.csv",
                   "version,texels,modes,blocks,level_ms,create_ms,cpu_ms,gpu_ms,paper_cpu_ms,"
                   "paper_gpu_ms",
                   path);
    if (!file) return AG_ERROR_FILE;
    printf("table 3.3: ms of the transfer stages, of creating T_b→r and of the renderer\n");
    printf("%-6s %3s %10s %10s %10s %10s %12s\n", "", "n", "cpu", "gpu", "T_b→r", "renderer",
           "paper's cpu");
    for (size_t i = 0; i < sizeof VERSIONS / sizeof *VERSIONS && result == AG_OK; i++)
        result = measure_version(b, &VERSIONS[i], file);
    const enum ag_result written = close_table(file, path);
    return result == AG_OK ? written : result;
}

// ---- figures

// Means over the seeds.
struct curves {
    int count;
    double blocks[SIZES], cpu_ms[SIZES], gpu_ms[SIZES], part_ms[PARTS][SIZES];
};

// Coefficient of determination of the least-squares line.
static double r_squared(const double *x, const double *y, int n)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (int i = 0; i < n; i++) {
        sx += x[i];
        sy += y[i];
        sxx += x[i] * x[i];
        sxy += x[i] * y[i];
        syy += y[i] * y[i];
    }
    const double covariance = n * sxy - sx * sy;
    return covariance * covariance / ((n * sxx - sx * sx) * (n * syy - sy * sy));
}

static void add_time(const struct mrt_bench *b, const struct maze_time *time, struct curves *curves)
{
    const int at = curves->count - 1;
    const double share = 1.0 / b->seeds;
    curves->blocks[at] = time->blocks;
    curves->cpu_ms[at] += share * time->solver.solve_ms;
    curves->gpu_ms[at] += share * transfer_ms(time);
    for (int p = 0; p < PARTS; p++) curves->part_ms[p][at] += share * time->part_ms[p];
}

static enum ag_result measure_mazes(const struct mrt_bench *b, const char *gi,
                                    const struct paper_dictionary *dictionary, FILE *total,
                                    FILE *parts, struct curves *curves)
{
    enum ag_result result = AG_OK;
    for (int blocks = STEP; blocks <= b->most && result == AG_OK; blocks += STEP) {
        curves->count++;
        for (int seed = 1; seed <= b->seeds && result == AG_OK; seed++) {
            struct maze_time time;
            result = measure_maze(b, gi, dictionary, blocks, seed, &time);
            if (result != AG_OK) break;
            add_time(b, &time, curves);
            fprintf(total, "%d,%d,%d,%.2f,%.4f,%.4f\n", blocks, seed, time.solver.links,
                    time.solver.level_ms, time.solver.solve_ms, transfer_ms(&time));
            fprintf(parts, "%d,%d", blocks, seed);
            for (int p = 0; p < PARTS; p++) fprintf(parts, ",%.4f", time.part_ms[p]);
            fputc('\n', parts);
        }
    }
    return result;
}

static bool draw(const struct mrt_bench *b, const char *name, const struct plot *plot)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", b->out, name);
    if (plot_write(path, plot)) return true;
    fprintf(stderr, "paper-mrt: %s: %s\n", path, strerror(errno));
    return false;
}

static bool draw_total(const struct mrt_bench *b, const struct curves *c)
{
    char note[BENCH_TEXT], gpu[BENCH_TEXT];
    const double of_cpu = r_squared(c->blocks, c->cpu_ms, c->count),
                 of_gpu = r_squared(c->blocks, c->gpu_ms, c->count);
    snprintf(gpu, sizeof gpu, "solver=gpu on %.60s", b->bench.info.name);
    snprintf(note, sizeof note,
             "after Loos 2015, figure 3.13; one bounce; seeds for each size: %d; R² of a line: "
             "%.4f, %.4f",
             b->seeds, of_cpu, of_gpu);
    printf("R² of a line: cpu %.4f, gpu %.4f\n", of_cpu, of_gpu);
    const struct plot_series series[] = { { "solver=cpu", c->blocks, c->cpu_ms, c->count },
                                          { gpu, c->blocks, c->gpu_ms, c->count } };
    return draw(b, "figure-3.13.svg",
                &(struct plot){ .title = "Indirect light of random mazes",
                                .note = note,
                                .x_label = "number of blocks",
                                .y_label = "time of b, r and reconstruction (ms)",
                                .series = series,
                                .series_count = 2 });
}

static bool draw_parts(const struct mrt_bench *b, const struct curves *c)
{
    struct plot_series series[PARTS];
    char note[BENCH_TEXT];
    for (int p = 0; p < PARTS; p++)
        series[p] = (struct plot_series){ PART_NAMES[p], c->blocks, c->part_ms[p], c->count };
    snprintf(note, sizeof note,
             "after Loos 2015, figure 4.13; one bounce; seeds for each size: %d; %.60s", b->seeds,
             b->bench.info.name);
    return draw(b, "figure-4.13.svg",
                &(struct plot){ .title = "Parts of the run time in random mazes",
                                .note = note,
                                .x_label = "number of blocks",
                                .y_label = "time (ms)",
                                .series = series,
                                .series_count = PARTS });
}

static enum ag_result write_mazes(const struct mrt_bench *b, const char *gi,
                                  const struct paper_dictionary *dictionary)
{
    static struct curves curves;
    char total_path[PATH_SIZE], parts_path[PATH_SIZE];
    FILE *total =
        open_table(b, "figure-3.13.csv", "blocks,seed,links,level_ms,cpu_ms,gpu_ms", total_path);
    FILE *parts =
        total ? open_table(b, "figure-4.13.csv",
                           "blocks,seed,direct_ms,b_ms,bounces_ms,reconstruct_ms,light_map_ms",
                           parts_path)
              : NULL;
    enum ag_result result = AG_ERROR_FILE;
    if (parts) result = measure_mazes(b, gi, dictionary, total, parts, &curves);
    if (parts && close_table(parts, parts_path) != AG_OK) result = AG_ERROR_FILE;
    if (total && close_table(total, total_path) != AG_OK) result = AG_ERROR_FILE;
    if (result == AG_OK && !(draw_total(b, &curves) && draw_parts(b, &curves)))
        result = AG_ERROR_FILE;
    return result;
}

static enum ag_result measure_figures(const struct mrt_bench *b)
{
    struct ag_scene *scene = NULL;
    struct bench_bakes bakes = { .count = 0 };
    struct paper_dictionary *dictionary = NULL;
    char text[PATH_SIZE];
    const char *gi = gi_of(b, FULL, text);
    enum ag_result result = open_bakes(b, gi, &scene, &bakes, &dictionary);
    if (result == AG_OK) result = write_mazes(b, gi, dictionary);
    paper_dictionary_close(dictionary);
    bench_bakes_finish(&bakes);
    ag_scene_destroy(scene);
    return result;
}

// ---- command line

static const struct {
    const char *name;
    enum ag_result (*measure)(const struct mrt_bench *b);
} SECTIONS[] = { { "3.2", measure_modes }, { "3.3", measure_table }, { "mazes", measure_figures } };
enum { SECTION_COUNT = sizeof SECTIONS / sizeof *SECTIONS };

static enum ag_result measure_section(void *user, const char *name)
{
    for (int i = 0; i < SECTION_COUNT; i++)
        if (strcmp(SECTIONS[i].name, name) == 0) return SECTIONS[i].measure(user);
    return AG_ERROR_ARGUMENT;
}

static void print_header(void *user)
{
    const struct mrt_bench *b = user;
    printf("%s; cpu: least of %d runs, gpu: medians of %d frames\n", b->bench.info.name, b->runs,
           b->bench.frames);
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct mrt_bench *b = user;
    if (strcmp(name, "--out") == 0)
        b->out = value;
    else if (strcmp(name, "--only") == 0)
        b->only = value;
    else if (strcmp(name, "--options") == 0)
        b->options = value;
    else if (strcmp(name, "--most") == 0)
        return parse_int(value, 2 * STEP, MOST, &b->most);
    else if (strcmp(name, "--seeds") == 0)
        return parse_int(value, 1, 100, &b->seeds);
    else if (strcmp(name, "--runs") == 0)
        return parse_int(value, 1, 100000, &b->runs);
    else
        return false;
    return true;
}

static bool set_defaults(void *user)
{
    struct mrt_bench *b = user;
    struct bench_scenes *sections = &b->bench.scenes;
    for (int i = 0; i < SECTION_COUNT; i++)
        if (!b->only || strcmp(b->only, SECTIONS[i].name) == 0)
            sections->names[sections->count++] = SECTIONS[i].name;
    mkdir(b->out, 0777); // csv_open reports an error
    return sections->count > 0;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "paper-mrt",
        .usage = "[--out DIR] [--only 3.2|3.3|mazes] [--options KEY=VALUE,...] [--most BLOCKS]\n"
                 "    [--seeds N] [--runs N]",
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .print_header = print_header,
        .measure_scene = measure_section,
    };
    static struct mrt_bench b = {
        .bench = { .frames = 5, .width = 64, .height = 36 },
        .out = "paper-mrt",
        .most = 100,
        .seeds = 3,
        .runs = 50,
    };
    return bench_main(&program, &b.bench, &b, argc, argv);
}

// Modes, levels and solver of mrt, inside the library: a renderer does not tell their times.
#include "paper_mrt_solver.h"

#include "bench.h"

#include "api/bake_state.h"
#include "core/rng.h"
#include "techniques/mrt/dictionary/transfer.h"
#include "techniques/mrt/level/solver.h"
#include "techniques/mrt/mrt_state.h"

#include <math.h>
#include <stdio.h>

int paper_mrt_modes(const struct ag_bake *bake, const char *sigma, double share)
{
    struct host *host = &bake->context->host;
    char name[64];
    snprintf(name, sizeof name, "cube/0/%s", sigma);
    const struct tensor *tensor = tensors_find(bake_reported(bake->bake), name);
    const size_t count = tensor ? (size_t)tensor->shape[0] : 0;
    double *values = host_alloc(host, count, sizeof *values);
    if (!values) return 0;
    for (size_t i = 0; i < count; i++) values[i] = (double)((const float *)tensor->data)[i];
    const int modes = mrt_modes_for_energy(values, count, share);
    host_free(host, values);
    return modes;
}

// ---- the dictionary

struct paper_dictionary {
    struct ag_context *context;
    struct host *host;
    struct mrt_dictionary dictionary;
    struct mrt_level_options level;
};

enum ag_result paper_dictionary_open(const struct ag_bake *bake, struct paper_dictionary **out)
{
    struct host *host = &bake->context->host;
    const struct mrt_options *options = bake->spec.options[bake->term];
    struct mrt_dictionary_options dictionary;
#define OPTION(type, name, ...) dictionary.name = options->name;
#include "techniques/mrt/dictionary/dictionary_options.def"
#undef OPTION
    struct paper_dictionary *d = *out = host_alloc(host, 1, sizeof *d);
    if (!d) return api_done(bake->context, false);
    d->context = bake->context;
    d->host = host;
    d->level.max_depth = options->depth;
    return api_done(bake->context, mrt_dictionary_init(host, bake_tensors(bake->bake), &dictionary,
                                                       &d->dictionary));
}

void paper_dictionary_close(struct paper_dictionary *d)
{
    if (!d) return;
    mrt_dictionary_finish(d->host, &d->dictionary);
    host_free(d->host, d);
}

int paper_dictionary_texels(const struct paper_dictionary *d)
{
    return d->dictionary.options.texels;
}

int paper_dictionary_modes(const struct paper_dictionary *d)
{
    return d->dictionary.options.modes;
}

// ---- a maze

struct maze {
    struct mrt_block_map map;
    struct mrt_level level;
    struct mrt_solver solver;
    float *light, *indirect; // RGB of each texel
};

static bool read_map(struct host *host, int blocks, int seed, struct mrt_block_map *map)
{
    char name[64];
    snprintf(name, sizeof name, "@maze:blocks=%d,seed=%d", blocks, seed);
    struct scene *scene = scene_load(host, name);
    const bool ok = scene && mrt_block_map_of_scene(host, scene, map);
    scene_destroy(scene);
    return ok;
}

// Random light: times do not depend on it.
static bool make_light(struct host *host, struct maze *maze)
{
    const size_t values = 3 * (size_t)maze->level.first_texel[maze->map.count];
    struct rng rng = rng_for(0, 0, 0);
    maze->light = host_alloc(host, values, sizeof *maze->light);
    maze->indirect = host_alloc(host, values, sizeof *maze->indirect);
    if (!maze->light || !maze->indirect) return false;
    for (size_t i = 0; i < values; i++) maze->light[i] = rng_float(&rng);
    return true;
}

static bool make_level(const struct paper_dictionary *d, struct maze *maze, double *ms)
{
    const double begun = bench_now_ms();
    const bool ok = mrt_level_init(d->host, &maze->map, &d->dictionary, &d->level, &maze->level) &&
                    mrt_solver_init(d->host, &maze->level, &maze->solver);
    *ms = bench_now_ms() - begun;
    return ok;
}

static double least_ms(struct maze *maze, int runs)
{
    double least = INFINITY;
    for (int i = 0; i < runs; i++) {
        const double begun = bench_now_ms();
        mrt_solve(&maze->solver, maze->light, maze->indirect);
        least = fmin(least, bench_now_ms() - begun);
    }
    return least;
}

enum ag_result paper_solver_measure(const struct paper_dictionary *d, int blocks, int seed,
                                    int runs, struct paper_solver_time *out)
{
    struct maze maze = { 0 };
    const bool ok = read_map(d->host, blocks, seed, &maze.map) &&
                    make_level(d, &maze, &out->level_ms) && make_light(d->host, &maze);
    if (ok) {
        out->links = maze.level.first_link[maze.level.entry_count];
        out->solve_ms = least_ms(&maze, runs);
    }
    host_free(d->host, maze.light);
    host_free(d->host, maze.indirect);
    mrt_solver_finish(&maze.solver);
    mrt_level_finish(&maze.level);
    mrt_block_map_finish(&maze.map);
    return api_done(d->context, ok);
}

// Common parts of the stages of a dictionary's bake: sizes, order of waves, matrices of tensors.
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"

// Waves. Each reduction of the lightfield basis takes three: a Gram matrix, its eigenvectors, the
// new basis; each round of enrichment propagates the basis first.
enum {
    WAVE_GATHER,
    WAVE_MODES,
    WAVE_ELEMENTS,
    WAVE_LIGHTFIELDS,
    WAVE_REDUCE, // + 4 · round
    WAVES_PER_ROUND = 4,
};

struct mrt_bake_job {
    struct mrt_dictionary_options options;
    struct host *host;       // while the tasks run
    struct mrt_rays rays[3]; // by enum mrt_measure
    enum mrt_maze maze;
    int shapes, turns, entered; // of the dictionary; of an interface; that light enters
    int baked;                  // shapes but for the right bend, which is the left one in a mirror
    const char *family;         // of names: "cube" or "tube"
    uint64_t k_b, k_l, k_r;
    uint64_t texels;            // of the closed cube
    uint64_t entered_texels;    // of a shape that light enters
    uint64_t probes;            // p³
    uint64_t openings, samples; // of all shapes; of a lightfield
    struct mrt_lightfield lightfield;
    int wave_final; // the basis is complete
};

static inline int mrt_wave_of_round(int round)
{
    return WAVE_REDUCE + WAVES_PER_ROUND * round;
}

static inline struct mrt_shape mrt_bake_shape(const struct mrt_bake_job *job, int i)
{
    return mrt_dictionary_shape(job->maze, job->options.texels, i);
}

// The argument of a stage of a shape: i in mrt_bake_shape, and the measure of its rays.
struct mrt_shape_stage {
    int shape;
    enum mrt_measure measure;
};
// Argument of a stage, allocated in the plan. NULL: out of memory.
const struct mrt_shape_stage *mrt_shape_stage(struct bake_plan *plan, int shape,
                                              enum mrt_measure measure);

enum { MRT_POINTS_PER_TASK = 16 };
static inline size_t mrt_point_tasks(uint64_t points)
{
    return (size_t)((points + MRT_POINTS_PER_TASK - 1) / MRT_POINTS_PER_TASK);
}

// Rows are all axes but the last. `at` is not to be written for an input.
struct matrix_f32 mrt_tensor_matrix(const struct tensor *tensor);
// NULL (and false): no such tensor.
bool mrt_bake_input(const struct bake_task *task, const char *name, struct matrix_f32 *out);
// The rows of an output that this task fills.
struct matrix_f32 mrt_bake_output(const struct bake_task *task, int output, uint64_t *first_row);

// The tensor FAMILY/I/WHAT of an earlier wave.
bool mrt_bake_shape_input(const struct bake_task *task, int shape, const char *what,
                          struct matrix_f32 *out);

// Adds the gather rows of the points of a task's first output: of texels, of a tube those of the
// representatives of its orbits (tube_symmetry.h), or of probes.
bool mrt_bake_gather(const struct bake_task *task, const struct mrt_shape *shape,
                     enum mrt_measure measure, const struct matrix_f32 *out);

bool mrt_interface_bake(struct bake_plan *plan, const struct mrt_bake_job *job);
// Names of tensors: H_rlf and its Σ after the last round.
struct mrt_last_basis {
    const char *basis, *sigma;
};
// Stages of waves wave_final + 1 and + 2. Tubes have none. `last` outlives the plan.
bool mrt_hole_products(struct bake_plan *plan, const struct mrt_bake_job *job,
                       const struct mrt_last_basis *last);
bool mrt_hole_operators(struct bake_plan *plan, const struct mrt_bake_job *job,
                        const struct mrt_last_basis *last);

// The plan of a bake, a list of stages: included by X_bake.c. README.md beside this file has an
// example.
//
// A stage is a number of independent tasks and the tensors that they fill. Stages are in waves 0,
// 1, …: tasks of a wave run in any order, on any thread or machine, and read only the inputs of the
// bake and the tensors of earlier waves. Tasks of wave 0 can therefore be spread over shards.
#pragma once

#include "bake/tensors.h"
#include "core/hash.h"

struct bake_plan;
struct bake_run;
struct bake_task;

// How the results of a stage's tasks become one tensor.
enum bake_reduction {
    BAKE_ROWS, // each task writes its own rows (axis 0): see bake_rows
    BAKE_SUM,  // F32: every task has a whole zeroed tensor; added up in the order of the tasks
};

// How long a tensor stays: until the end of this wave, or one of
enum {
    BAKE_SAVED = 1 << 30, // it is part of the bake file
    BAKE_REPORTED,        // not in the file, but there for the technique's bake_report after a run
};

struct bake_output {
    const char *name; // unique in the plan
    enum tensor_type type;
    int rank;
    uint64_t shape[TENSOR_MAX_RANK];
    enum bake_reduction reduction;
    int keep; // BAKE_SAVED, BAKE_REPORTED or the last wave that reads it
};
// An output of floats: its shape is the last arguments.
#define BAKE_F32(reduction, name, keep, ...)                                                       \
    ((struct bake_output){ name,                                                                   \
                           TENSOR_F32,                                                             \
                           sizeof((uint64_t[]){ __VA_ARGS__ }) / 8,                                \
                           { __VA_ARGS__ },                                                        \
                           reduction,                                                              \
                           keep })
// The members of a stage that list these outputs.
#define BAKE_OUTPUTS(...)                                                                          \
    .outputs = (const struct bake_output[]){ __VA_ARGS__ },                                        \
    .output_count =                                                                                \
        sizeof((const struct bake_output[]){ __VA_ARGS__ }) / sizeof(struct bake_output)

struct bake_stage {
    const char *name; // unique in the plan, shown to the user: "cube/1 gather"
    int wave;         // not below that of the stage before
    int part;         // of bake_plan_part; 0: without parts
    size_t task_count;
    // Fills the outputs of one task. false: host_fail(task->host, …), or cancelled. Deterministic:
    // the result depends on the arguments of the bake, task->seed and earlier waves alone.
    bool (*run)(const struct bake_task *task);
    const void *argument; // for run
    const struct bake_output *outputs;
    int output_count; // at most BAKE_MAX_OUTPUTS
    // Rows that one task fills together: 0 … n − 1, n … 2n − 1 and so on. 0: any.
    uint32_t rows_together;
    // Costs of one task, for estimates. flops: floating-point operations of dense linear algebra.
    // others: work that is neither, in rays that take as long. scratch_bytes: memory beyond the
    // outputs.
    double rays, flops, others, texels;
    size_t scratch_bytes;
};
enum { BAKE_MAX_OUTPUTS = 16 };

// Adds a stage; copies names and outputs, not *argument. False: out of memory, or a wrong stage
// (the message says what).
bool bake_plan_add(struct bake_plan *plan, const struct bake_stage *stage);
// The host for messages while planning. Planning is fast: it allocates no large memory, traces no
// ray and builds no acceleration structure; `prepare` and the tasks do.
struct host *bake_plan_host(const struct bake_plan *plan);
// Zeroed memory that lives as long as the plan, for names, arguments and the job.
void *bake_plan_alloc(struct bake_plan *plan, size_t count, size_t size);
char *bake_plan_name(struct bake_plan *plan, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
// The hash of what the bake depends on besides the options of effect REBAKE and the seed: see
// bake/scene_key.h. Without a call the bake is independent of the scene.
void bake_plan_depends(struct bake_plan *plan, struct hash128 key);

// A part of the bake that other scenes may have, too, as a mesh: all stages of a plan with parts
// are of one, and read tensors of the same part alone. key: what the part depends on besides the
// options of effect REBAKE and the seed; names of its stages and tensors follow from it, so that
// they are the same in every plan, and of this part alone. Each part is a file of a cache. Returns
// its number, from 1; that of the same key where it exists, *exists; 0 without memory.
int bake_plan_part(struct bake_plan *plan, struct hash128 key, bool *exists);
// Whether its tensors are there, from a file: `prepare` need not prepare it.
bool bake_plan_part_is_loaded(const struct bake_plan *plan, int part);

// A light map that the bake is for, so that estimates can say how fine it is.
struct bake_light_map {
    uint32_t charts;
    float texels_per_m, utilisation; // utilisation: texels over places of the atlas
    // Adds the stages at another density to an empty plan; job: of the bake's own plan. For advice
    // where memory is short; NULL: there is none.
    bool (*plan_at)(struct bake_plan *plan, const void *job, float texels_per_m);
};
void bake_plan_set_light_map(struct bake_plan *plan, struct bake_light_map map);

// State shared by all tasks, read-only while they run. `prepare` (may be NULL) runs once on the
// calling thread before the first task, `finish` (may be NULL) after the last one, also after a
// failed prepare.
struct bake_job {
    void *job;
    bool (*prepare)(void *job, struct host *host);
    void (*finish)(void *job);
    // Frees the memory that planning and preparing keep between runs: called once, when the plan
    // ends; may be NULL.
    void (*destroy)(void *job);
    // For the estimate: memory that planning and `prepare` take; and, in place of it, what is taken
    // when the complete results become files. 0: no more than the results.
    size_t bytes, files_bytes;
};
void bake_plan_set_job(struct bake_plan *plan, const struct bake_job *job);

// ---- in a task

struct bake_task {
    struct host *host;    // messages and memory of this task; usable on its thread
    const void *argument; // of the stage
    const void *job;      // of the plan
    size_t index;         // 0 … count − 1
    size_t count;         // tasks of the stage
    uint64_t seed;        // of the bake's seed, the stage's name and the index
    uint64_t bake_seed;   // for random numbers that must not depend on the number of tasks
    // For each output of the stage: BAKE_ROWS: the task's rows, BAKE_SUM: the whole tensor. Zeroed.
    void *const *out;
    const struct bake_output *outputs;
    uint32_t rows_together; // of the stage
    struct bake_run *run;   // private
};

// The rows of a tensor that task `index` of `count` fills: first … first + *rows − 1 of `total`.
// Even parts, in order.
static inline uint64_t bake_rows(uint64_t total, size_t index, size_t count, uint64_t *rows)
{
    const uint64_t part = total / count, more = total % count;
    const uint64_t first = part * index + (index < more ? index : more);
    *rows = part + (index < more ? 1 : 0);
    return first;
}
// The same where groups of `together` rows are one task's.
static inline uint64_t bake_rows_together(uint64_t total, uint32_t together, size_t index,
                                          size_t count, uint64_t *rows)
{
    if (together < 2) return bake_rows(total, index, count, rows);
    uint64_t groups, first = bake_rows((total + together - 1) / together, index, count, &groups);
    first = first * together < total ? first * together : total;
    *rows = groups * together < total - first ? groups * together : total - first;
    return first;
}
// Tasks of at least one row each for that much work, some of which is a task.
static inline size_t bake_task_count(uint64_t rows, uint64_t work, uint64_t of_task)
{
    const uint64_t tasks = (work + of_task - 1) / of_task;
    return (size_t)(tasks < rows ? tasks : rows);
}
// The rows of output `output` that this task fills, and their number.
uint64_t bake_task_rows(const struct bake_task *task, int output, uint64_t *rows);
// Row `row` of those, from 0.
void *bake_row(const struct bake_task *task, int output, uint64_t row);
// A tensor of an earlier wave. NULL (host_fail) where no earlier wave makes it, or its `keep` has
// passed.
const struct tensor *bake_task_input(const struct bake_task *task, const char *name);
// Has the user asked to stop? Tasks that take longer than half a second poll it and return false.
bool bake_task_cancelled(const struct bake_task *task);

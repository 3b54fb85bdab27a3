// The structs behind bake.h and plan.h, for the files of this folder.
#pragma once

#include "bake/bake.h"
#include "bake/safetensors.h"
#include "core/arena.h"

#include <pthread.h>

struct planned_output {
    struct bake_output what;
    size_t bytes;       // of the whole tensor
    struct tensor view; // of the complete tensor; data NULL: not complete, or no longer kept
    char *data;         // the tensor; NULL before its wave and after `keep`
    char *parts;        // BAKE_SUM: the tensor of each task, until they are added up
    int read_by_wave;   // the newest whose tasks have read it; under the mutex
};

// A part that other scenes may have, too (plan.h).
struct planned_part {
    struct hash128 key;
    bool loaded; // its stages are done, without the tensors that no file has
};

struct planned_stage {
    struct bake_stage what; // outputs: NULL, see below
    struct planned_output *outputs;
    uint64_t seed;
    // Under the mutex while tasks run.
    bool *done; // [task_count]
    size_t done_count;
    double seconds;      // sum over finished tasks
    float *task_seconds; // [task_count]; NaN: not run by this process or its team
    // First stage of a wave: of tensors of earlier waves that its tasks have read, each once.
    uint64_t input_bytes;
};

struct bake_plan {
    struct host *host;
    struct arena arena;
    struct planned_stage *stages;
    int stage_count, capacity;
    struct planned_part *parts; // [part_count]; the number of a part is from 1
    int part_count, part_capacity;
    int waves;      // number of waves
    int waves_done; // whose results are complete and reduced
    struct bake_job job;
    struct bake_light_map light_map; // zero: there is none
    bool depends_on_scene;
    struct hash128 scene;
};

struct bake {
    struct host *host;
    struct bake_identity identity; // its texts are in the arena
    struct bake_plan plan;
    pthread_mutex_t mutex;  // of the state that running tasks change
    pthread_mutex_t memory; // of the host's allocator while tasks run
    double seconds;         // wall time of all runs; NaN: unknown
    double prepare_seconds; // of the newest run's job.prepare
    // Content of the merged partial files; zero: none was merged.
    struct merged {
        bool some;
        int waves;                // complete ones
        size_t missing, expected; // tasks of the wave that they have in part
    } merged;
    char *checkpoint; // that was read, or would have been; NULL: none
    // The result, once complete: of the plan's outputs, or of a file.
    struct safetensors file;
    struct tensor *tensors; // saved ones, then reported ones
    size_t saved_count, reported_count;
    struct tensors saved, all;
};

// ---- results.c: memory of the outputs

uint64_t output_rows(const struct bake_output *output);
// The memory that a task writes to, and its size.
char *output_block(const struct planned_stage *stage, const struct planned_output *output,
                   size_t task, size_t *bytes);
// The sizes of all blocks of a task, bytes[output_count], and their sum.
size_t output_block_sizes(const struct planned_stage *stage, size_t task, size_t *bytes);
// Allocates the outputs of a wave's tasks; keeps those that exist.
bool results_begin(struct bake *bake, int wave);
// Adds up sums and frees tensors that no later wave reads.
bool results_reduce(struct bake *bake, int wave);
// Is every task of the wave done?
bool results_wave_is_done(const struct bake *bake, int wave);
void results_free(struct bake *bake);
// Makes bake->saved and bake->all, after the last wave.
bool results_collect(struct bake *bake);
// As a run leaves it, after tasks have been taken from a file: reduces waves whose tasks are all
// there, and collects the tensors after the last.
bool results_complete_waves(struct bake *bake);
// Whether it was loaded with its part.
bool results_are_loaded(const struct bake *bake, const struct planned_stage *stage);
// A complete tensor; NULL: none of this name.
const struct tensor *results_find(const struct bake *bake, const char *name);

// ---- run.c

// probe: only one task of each kind in wave 0.
bool run_bake(struct bake *bake, const struct bake_run_options *options, bool probe);
struct lead;
// As rank 0 of a team: lead.h.
bool run_bake_led(struct bake *bake, const struct bake_run_options *options, struct lead *lead);

// ---- checkpoint.c

// Takes the finished tasks of a checkpoint and of its journal, unless that has been done.
bool bake_resume(struct bake *bake, const char *path);
// Removes the journal beside a checkpoint.
void bake_forget_journal(struct host *host, const char *checkpoint);

// ---- estimate.c

uint64_t estimate_peak_memory(const struct bake *bake, int threads);

// ---- advice.c

// A density of the light map, as %.3g has it, at which the bake needs at most `limit`: the largest
// within some percent. 0: none was found. Charts are made several times.
double advised_density(const struct bake *bake, uint64_t needed, uint64_t limit, int threads);

// ---- progress.c: times, predicted from those of finished tasks and the costs in the plan

struct prediction {
    double per_ray_s, per_flop_s;
};
// Measures the speed of linear algebra, some milliseconds.
double prediction_flop_seconds(struct host *host);
struct prediction prediction_now(const struct bake *bake, double per_flop_s);
// Wall time of the missing tasks of this run on `threads` threads, each of its own processor.
double prediction_left(const struct bake *bake, const struct prediction *prediction,
                       const struct bake_run_options *options, int threads);
// The same of the missing tasks of a wave.
double prediction_wave(const struct bake *bake, const struct prediction *prediction, int wave,
                       const struct bake_run_options *options, int threads);

// ---- split.c: shards

// The wave that shards split; plan.waves: none that is left is worth it.
int split_wave(const struct bake *bake);
// The tasks of a stage that a run with these options covers now: first … first + *count − 1.
size_t run_tasks(const struct bake *bake, const struct bake_stage *stage,
                 const struct bake_run_options *options, size_t *count);

// ---- partial.c: finished tasks in a file

// The finished tasks of a stage at some moment, copied under the mutex.
struct finished_tasks {
    bool *done; // [task_count]
    double seconds;
};
// stages: one for each of the plan.
bool partial_write(struct host *host, const struct bake *bake, const char *path,
                   const struct finished_tasks *stages, double seconds);
// Takes the finished tasks of a partial file; messages and memory by `host`.
bool partial_read(struct host *host, struct bake *bake, const char *path);

// ---- parts.c; parts are numbered from 1

// Takes the parts that a checked file has and no file before. False: out of memory.
bool parts_take(struct bake *bake, const struct tensors *set);
// Whether a bake has all tensors that the parts of another one save.
bool parts_fit(const struct bake *bake, const struct bake *wanted);
// Whether these are all tensors that a part saves; 0: all parts.
bool part_is_in(const struct bake *bake, int part, const struct tensors *set);
// Its share of the wall time, by the times of the stages; NaN: unknown.
double part_seconds(const struct bake *bake, int part);
// Its saved tensors, of a complete bake; the caller frees them. NULL: out of memory.
struct tensor *part_tensors(const struct bake *bake, int part, size_t *count);

// ---- identity.c: identity in metadata

enum { BAKE_MAX_METADATA = 16, BAKE_TEXT = 64 };
struct identity_text {
    char version[BAKE_TEXT], seed[BAKE_TEXT], seconds[BAKE_TEXT], scale[BAKE_TEXT];
    char scene[HASH128_TEXT], content[HASH128_TEXT];
    struct tensor_metadata metadata[BAKE_MAX_METADATA];
    size_t count;
};
#define IDENTITY_BAKE "bake"
// The metadata of a file of this bake. seconds NaN: not recorded. kind: IDENTITY_BAKE, "partial".
void identity_print(const struct bake *bake, const char *kind, double seconds,
                    struct identity_text *out);
// With the key of a part in place of the scene's.
void identity_print_part(const struct bake *bake, int part, double seconds,
                         struct identity_text *out);
// Adds seconds of the stages: of a part, 0: of all, and the scene's name. False: out of memory.
bool identity_add_run(struct bake *bake, int part, struct identity_text *text);
void identity_key(const struct identity_text *text, char out[HASH128_TEXT]);
// The seconds of a stage that the file states; NaN: none.
double identity_stage_seconds(const struct tensors *set, const char *stage);
// "cannot use PATH: " and why.
bool identity_fail(struct host *host, const char *path, const char *why);
// Adds the hash of all metadata and tensors, and writes.
bool identity_write(struct host *host, const char *path, struct identity_text *text,
                    const struct tensor *at, size_t count);
// Refuses a file of another kind or identity, or whose hash differs.
bool identity_check(struct host *host, const struct bake *bake, const char *kind, const char *path,
                    const struct tensors *set);
// afterglow.seconds of a file; NaN: none.
double identity_seconds(const struct tensors *set);

// A bake: the plan of a technique for certain options, its identity, and its tensors once it has
// run or was read from a file.
#pragma once

#include "bake/plan.h"
#include "bake/report.h"

struct bake;

// The identity of a bake. A file of another identity is refused; the seed may differ.
struct bake_identity {
    const char *technique;
    int version;
    const char *options; // of effect REBAKE, written out: "texels=16,modes=64"
    uint64_t seed;
    const char *program; // its version, for files only
    // GI spec and scene, so that partial files can be merged without them; may be NULL.
    const char *gi, *scene_name;
    float scene_scale; // metres per unit of its file; 0: 1
    bool of_light;     // the scene's hash includes its light, for messages
};

// An empty plan; `bake` owns it. Copies the identity. NULL: out of memory.
struct bake *bake_create(struct host *host, const struct bake_identity *identity);
void bake_destroy(struct bake *bake); // accepts NULL
struct bake_plan *bake_plan_of(struct bake *bake);

// The hash of technique, version, options, scene and seed: the file's name in a cache.
void bake_key(const struct bake *bake, char out[HASH128_TEXT]);

// Does a bake serve where another one is wanted? All of the identity but the seed and the program;
// of parts it may have more.
bool bake_fits(const struct bake *bake, const struct bake *wanted);

// ---- before

struct bake_estimate {
    double texels, rays, seconds;           // of the part, with a shard
    uint64_t file_bytes, peak_memory_bytes; // without the scene
    struct bake_light_map light_map;        // zero: there is none
};
// probe: measures a few tasks, which takes about a second, and keeps their results; without it
// `seconds` is NaN. options: as for the run that follows.
struct bake_run_options;
bool bake_estimate(struct bake *bake, const struct bake_run_options *options, bool probe,
                   struct bake_estimate *out);

// ---- the run

struct bake_progress {
    const char *stage; // being worked on; "" after the last
    double done;       // share of the whole time, 0…1
    double seconds_left;
    bool stopping; // asked to stop; checkpoint written; waiting for running tasks
};

struct bake_run_options {
    int threads;               // 0: all cores
    int shard, shard_count;    // run only this part (split.c); count 0: everything
    const char *checkpoint;    // file to resume from and to keep; NULL: none
    double checkpoint_every_s; // 0: only when cancelled
    uint64_t max_memory_bytes; // refuse a larger estimate; 0: no limit
    // About ten times a second on the calling thread; false cancels. After that the checkpoint is
    // written, and further calls have `stopping` set: a program may end itself in one of them.
    bool (*progress)(void *user, const struct bake_progress *progress);
    void *user;
    const struct bake_team *team; // NULL: this process alone
};
// The processes that run a bake together, as the program reaches them; see ag_bake_team.
enum bake_news { BAKE_NOTHING, BAKE_MESSAGE, BAKE_LOST };
struct bake_team {
    int rank, count;
    bool (*send)(void *user, int to, const void *data, size_t bytes);
    enum bake_news (*receive)(void *user, int *from, const void **data, size_t *bytes);
    void *user;
};

// Runs the missing tasks. FAIL_CANCELLED: `progress` returned false; finished tasks are kept, also
// in the checkpoint. A checkpoint of another identity, or a damaged one, is ignored with a warning.
// It is read once, and removed by bake_save and bake_save_partial.
// With a team, rank 0 deals out the tasks and completes the bake, others run those that they are
// given; theirs stays incomplete. README.md has the protocol.
bool bake_run(struct bake *bake, const struct bake_run_options *options);
// Removes the checkpoint where its result is kept in another way.
void bake_forget_checkpoint(struct bake *bake);
bool bake_is_complete(const struct bake *bake);

// Partial files: a checkpoint of the finished tasks, by --shard. `merge` adds the tasks of a file;
// bake_run then does the rest, or with a shard a part of the next wave that is worth splitting.
bool bake_save_partial(struct bake *bake, const char *path);
bool bake_merge(struct bake *bake, const char *path);
// The costliest stage of the wave that a run with a shard would split now; NULL: the remaining
// stages are not worth splitting.
const char *bake_split_stage(const struct bake *bake);

// The bake that a partial file is a part of: new texts owned by the caller, and the seed.
struct bake_origin {
    char *technique, *options, *gi, *scene_name;
    float scene_scale; // NaN: the file's is no number
    uint64_t seed;
};
void bake_origin_finish(struct host *host, struct bake_origin *origin);
bool bake_partial_origin(struct host *host, const char *path, struct bake_origin *out);

// ---- the result

// The tensors of a complete bake, in the order of the plan; NULL otherwise.
const struct tensors *bake_tensors(const struct bake *bake);
// With the BAKE_REPORTED ones after a run, for bake_report.
const struct tensors *bake_reported(const struct bake *bake);
// Writes the file, which has the same bytes for the same identity. record_run: add
// afterglow.seconds and those of the stages to its metadata, which differ from run to run, and the
// scene's name, which differs from caller to caller.
bool bake_save(struct bake *bake, const char *path, bool record_run);
// Reads a file of this identity; otherwise FAIL_FORMAT and one sentence with the difference. Parts
// are taken from a bake of any scene; FAIL_FORMAT until all are there, and those that the file has
// are kept: bake_run does the others.
bool bake_load(struct bake *bake, const char *path);

// ---- parts: what other scenes may have, too, each a file of a cache (bake_plan_part). A bake
// without parts has one, all of it.

int bake_part_count(const struct bake *bake);
void bake_part_key(const struct bake *bake, int part, char out[HASH128_TEXT]); // from 0
bool bake_part_is_complete(const struct bake *bake, int part);
bool bake_part_is_loaded(const struct bake *bake, int part); // from a file
// Reads the file of a part, or one that has it. FAIL_FORMAT, and nothing is taken: it has not.
bool bake_load_part(struct bake *bake, int part, const char *path);
// As bake_save, of the part alone; its bytes do not depend on the other parts.
bool bake_save_part(struct bake *bake, int part, const char *path, bool record_run);

// The technique that a bake file names.
bool bake_file_technique(struct host *host, const char *path, char *out, size_t size);

struct bake_stage_info {
    const char *name;
    double seconds; // sum over its tasks, of all runs; NaN after bake_load of a file without them
    size_t tasks;
    int wave;
    const float *task_seconds; // [tasks]; NaN: of a task that this object has not run
    uint64_t result_bytes;     // of its tasks
    uint64_t input_bytes;      // first of its wave: what the wave has read of earlier ones
};
int bake_stage_count(const struct bake *bake);
struct bake_stage_info bake_stage_info(const struct bake *bake, int stage);
// Wall time of all runs; that of the run that made it after bake_load, NaN if the file has none.
double bake_seconds(const struct bake *bake);
double bake_prepare_seconds(const struct bake *bake); // of the newest run, before its tasks
uint64_t bake_bytes(const struct bake *bake);         // of the file's tensors
const char *bake_options_text(const struct bake *bake);

// differences.c: "rays is 256, not 512, …" for those options of a file that are not as wanted.
void option_differences(const char *of_file, const char *wanted, char *out, size_t size);

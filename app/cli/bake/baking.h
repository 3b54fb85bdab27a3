// Bakes of a command: a given file, a cached one, or a run with a progress bar.
#pragma once

#include "cli/cache/cache.h"
#include "cli/output.h"

enum { MAX_BAKES = 3 };

struct baking {
    struct session *session;
    struct ag_bake *bake;
    const char *technique;         // owned by the bake
    char path[PATH_SIZE];          // of its file; "": kept in memory only
    char kept[PATH_SIZE];          // the same for messages: of several parts their folder
    bool in_cache;                 // the path is in the cache; each part has a file of its own
    bool must_keep;                // fail where the cache has no room for it
    char no_cache[CACHE_WHY_SIZE]; // why the path is ""
    bool loaded;                   // from a file, not run
    bool settled;                  // the other ranks of the team know that it is complete
    bool from_cache;               // that file is in the cache
    bool updates;                  // an earlier light map
    bool of_reference;             // the samples of the path-traced reference, not data
    double estimate_seconds;       // of the whole run, before it; NaN: nothing was estimated
    uint64_t scene_bytes;          // of the process before the bake was planned
    uint64_t estimate_bytes;       // of the process at most; 0: nothing was estimated
};
// Creates the bake of one technique of the spec. path NULL: a file in the cache. desc: see
// ag_bake_create.
enum status baking_begin(struct baking *b, struct session *session, const char *gi,
                         const struct ag_bake_desc *desc, const char *path);
// The samples of a reference, kept in a checkpoint beside the file that the caller writes.
enum status baking_begin_reference(struct baking *b, struct session *session,
                                   const struct ag_reference_desc *of, int samples,
                                   const char *path);
void baking_end(struct baking *b); // accepts zero
// Wrong usage of --shard and --merge. file: a merged bake is written to -o.
enum status baking_check_parts(const struct arguments *arguments, bool file);
// The origin that the first of the merged parts states.
enum status baking_origin(const struct session *session, struct ag_bake_origin *out);
enum status baking_merge(struct baking *b); // adds the tasks of all parts
// Reads the file of `path`, or of the cache. False: there is none, or it does not fit, which a note
// says.
bool baking_load(struct baking *b);
// Says what it needs and runs with a progress bar. After Ctrl-C it fails; what was finished is kept
// in the checkpoint.
enum status baking_complete(struct baking *b, bool shard);
// The same, and writes the file. shard: a partial one.
enum status baking_run(struct baking *b, bool shard);

// Whether another process of the team has the results: this one only runs tasks for it.
bool baking_is_followed(const struct arguments *arguments);
// Runs the tasks that rank 0 deals out, until it has ended.
enum status baking_follow(struct baking *b);
// Tells the others that a bake is complete without a run, so that they go on.
enum status baking_settle(struct baking *b);

// The bakes that the techniques of a GI spec need, for a renderer.
struct bakes {
    struct baking at[MAX_BAKES];
    const struct ag_bake *bakes[MAX_BAKES]; // for ag_renderer_desc
    int count;
    bool loaded;    // all of them
    double seconds; // NaN: not known
    uint64_t bytes;
};
// Fails unless each --bake file is of a technique of one of the GI specs, and of another one.
enum status bakes_check_files(const struct session *session, const char *const *gis, int gi_count);
// From --bake, the cache or a run, unless --no-bake forbids it.
enum status bakes_prepare(struct bakes *bakes, struct session *session, const char *gi);
void bakes_finish(struct bakes *bakes); // accepts zero

/// Bakes: what a technique precomputes for a scene and its options. A bake is created, then run or
/// loaded from a file, then given to renderers. Techniques that need one: see ag_technique_get.
///
/// A bake file is a safetensors file: named arrays that Python's safetensors.numpy.load_file reads.
/// It belongs to one technique, its bake version, its options of effect "rebake" and, for
/// techniques that depend on it, the geometry and materials of one scene; others are refused.
#ifndef AFTERGLOW_BAKE_H
#define AFTERGLOW_BAKE_H

#include <afterglow/scene.h>

AG_BEGIN

struct ag_bake;

struct ag_bake_desc {
    const char *technique; ///< which of the GI spec's techniques; default NULL: the only that bakes
    double time_s;         ///< animation time of the scene; default 0
    int animation;         ///< see ag_scene_camera; default 0
    uint64_t seed;         ///< of all random numbers; default 0
    int threads;           ///< default 0: all cores; the result does not depend on it
    int shard, shard_count; ///< run only this part, 0…shard_count−1; default count 0: everything
    double checkpoint_every_s; ///< with a checkpoint; default 30; 0: only when cancelled
    uint64_t max_memory_bytes; ///< refuse to run if more would be needed; default 0: no limit
    bool full_report;          ///< also compute what only ag_bake_report shows; default false
    /// Paths of a texel, 1 to 1000000: bakes not the data of the technique, but its light map
    /// (lightmap.h). Lights and sky are those at ag_bake_create. Default 0: the data
    int lightmap_samples;
    /// For dnrt: all instances of the scene are objects, as those of an asset that scenes will have
    /// as movable ones; default false: those that are dynamic.
    bool all_objects;
    /// With lightmap_samples of at least 32: gather each chart until its noise is at most this,
    /// 0…1, and at most lightmap_samples paths of a texel. The noise is the root of the mean
    /// variance of the chart's texels over their mean light, both of luminance and without direct
    /// light of punctual lights; light below 1 % of the map's mean counts as that. Default 0: all
    /// texels have lightmap_samples paths
    float lightmap_noise;
    /// With lightmap_samples: the folder of an earlier light map of the scene (ag_lightmap_write).
    /// Texels that no change of the scene since then reaches keep its light; see
    /// docs/lightmaps.md. AG_ERROR_FORMAT or AG_ERROR_FILE from ag_bake_create where that cannot
    /// be: bake all then. Default NULL: all is baked
    const char *update_folder;
    uint64_t reserved[6]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_bake_desc_default(struct ag_bake_desc *desc);

/// The index-th technique of a GI spec that needs a bake; *name is NULL past the last.
/// Thread: the context's.
AG_API enum ag_result ag_bake_technique(struct ag_context *context, const char *gi, int index,
                                        const char **name);
/// The technique that files of that bake name: mrt for drt, which has the same bake.
/// Thread: the context's.
AG_API enum ag_result ag_bake_technique_in_file(struct ag_context *context, const char *gi,
                                                int index, const char **name);
/// The technique that a bake file names, at most 31 characters. Thread: the context's.
AG_API enum ag_result ag_bake_file_technique(struct ag_context *context, const char *path,
                                             char name[32]);

/// Nothing is computed yet. Until the bake is destroyed, only lights and sky of the scene may
/// change; the scene may be destroyed before. desc NULL: the defaults. AG_ERROR_ARGUMENT where no
/// technique of the spec bakes. Thread: the context's.
AG_API enum ag_result ag_bake_create(struct ag_scene *scene, const char *gi,
                                     const struct ag_bake_desc *desc, struct ag_bake **out);
/// Also before renderers that were created with it: they keep nothing of it. Thread: the context's.
AG_API void ag_bake_destroy(struct ag_bake *bake);

struct ag_bake_estimate {
    double texels, rays;        ///< 0 where the technique has none
    double seconds;             ///< NaN without a probe
    uint64_t file_bytes;        ///< of the finished file
    uint64_t peak_memory_bytes; ///< beyond the scene; of a light map until its files are written
    uint32_t charts;            ///< of a light map; 0 where the technique has none
    float texels_per_m;         ///< of a light map, on all charts
    float utilisation;          ///< of a light map: texels on surfaces over all of its atlas
    uint64_t reserved[2];       ///< 0; see ABI in types.h
};
/// Estimates the resources of ag_bake_run. probe: run a few tasks, about a second, to estimate the
/// time; their results are kept. Thread: the context's.
AG_API enum ag_result ag_bake_estimate_cost(struct ag_bake *bake, bool probe,
                                            struct ag_bake_estimate *out);
#ifndef __cplusplus
/// Former name of ag_bake_estimate_cost, which hid the struct in C++; the next minor version is
/// without it. Thread: the context's.
AG_API AG_DEPRECATED enum ag_result ag_bake_estimate(struct ag_bake *bake, bool probe,
                                                     struct ag_bake_estimate *out);
#endif

/// A file that keeps finished tasks, also while running; ag_bake_run resumes it, ag_bake_save
/// and ag_bake_save_partial remove it. NULL: none, as at first. Thread: the context's.
AG_API enum ag_result ag_bake_set_checkpoint(struct ag_bake *bake, const char *path);

struct ag_bake_progress {
    const char *stage;    ///< being worked on
    double done;          ///< share of the whole time, 0…1
    double seconds_left;  ///< estimated
    bool stopping;        ///< cancelled, the checkpoint is written; running tasks come to their end
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Computes what is missing, on all cores, and returns when it is done. `progress` (may be NULL) is
/// called about ten times a second on this thread, also while `stopping`; if it returns false, the
/// call ends with AG_ERROR_CANCELLED, usually within a second. What was finished is kept, in this
/// object and in the checkpoint; a later call continues with it. The same scene, options and
/// seed give the same bytes whatever the threads, shards and interruptions. Thread: the context's.
AG_API enum ag_result
ag_bake_run(struct ag_bake *bake,
            bool (*progress)(void *user, const struct ag_bake_progress *progress), void *user);

/// News of ag_bake_team.receive.
enum ag_bake_news {
    AG_BAKE_NOTHING, ///< no message has arrived
    AG_BAKE_MESSAGE, ///< one from *from
    AG_BAKE_LOST,    ///< *from has ended, and no more messages of it come
};
/// Processes that run a bake together: how a program sends messages between them, by MPI, sockets
/// or pipes. Messages of two ranks arrive in the order in which they were sent.
struct ag_bake_team {
    int rank;  ///< of this process, 0…count−1; default 0
    int count; ///< of processes; default 1
    /// Sends bytes to a process; they may change once it returns. False: that process has ended.
    bool (*send)(void *user, int to, const void *data, size_t bytes);
    /// The next message, without waiting for one; its bytes stay valid until the next call. With
    /// AG_BAKE_LOST they are why, text without a zero, or none. At most ten seconds of silence at
    /// the end of a run are waited for, but a rank that ends during the run must be told.
    enum ag_bake_news (*receive)(void *user, int *from, const void **data, size_t *bytes);
    void *user;           ///< for both
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// One process. Thread: any.
AG_API void ag_bake_team_default(struct ag_bake_team *team);
/// ag_bake_run on several processes or machines: all call it with a bake of the same scene,
/// options, seed and version. Rank 0 deals out tasks as the others become free, works itself, and
/// completes its bake: the same bytes as ag_bake_run. The others run what they are given, and
/// return when rank 0 has ended; their bakes stay incomplete. The callbacks of `team` are called on
/// this thread.
///
/// With a checkpoint, rank 0 writes each result to PATH.tasks beside it as it arrives, which
/// ag_bake_run resumes, too: a process that is killed costs its running tasks alone. Tasks of a
/// rank that is lost run on others. If `progress` of any rank returns false, all end, with
/// AG_ERROR_CANCELLED. AG_ERROR_ARGUMENT on all where ranks bake different things, which the
/// message names, or with a shard. Thread: the context's.
AG_API enum ag_result
ag_bake_run_team(struct ag_bake *bake, const struct ag_bake_team *team,
                 bool (*progress)(void *user, const struct ag_bake_progress *progress), void *user);

/// Writes the file of a complete bake and removes its checkpoint. record_seconds: add
/// ag_bake_info.seconds to the file, which differ from run to run, and the name of the scene.
/// Thread: the context's.
AG_API enum ag_result ag_bake_save(struct ag_bake *bake, const char *path, bool record_seconds);
/// Writes the data of a complete bake for other programs into an existing folder: of ort,
/// index.json and the images that it names (docs/techniques/ort.md). Files of the same names are
/// replaced, each completely or not at all, index.json last. AG_ERROR_ARGUMENT where the bake is
/// incomplete, a light map, or of a technique without such data (ag_technique_info.exports_bake).
/// Thread: the context's.
AG_API enum ag_result ag_bake_export(const struct ag_bake *bake, const char *folder);
/// Reads a file, untrusted, instead of a run. AG_ERROR_FORMAT if it is damaged or of another
/// technique, version, scene or options; its seed may be any. A bake of several parts takes those
/// that it lacks from a bake of any scene. AG_ERROR_FORMAT where some are still missing: those of
/// the file stay, and ag_bake_run does the others alone. Thread: the context's.
AG_API enum ag_result ag_bake_load(struct ag_bake *bake, const char *path);
/// Removes the checkpoint, as ag_bake_save does, where the result is kept in another way.
/// Thread: the context's.
AG_API enum ag_result ag_bake_remove_checkpoint(struct ag_bake *bake);
/// Writes the finished tasks of a shard. A shard runs its part of the first tasks of the bake; with
/// all parts merged, its part of the next tasks that are worth splitting, and so on until
/// ag_bake_info.split_stage is NULL. A bake without a shard does the rest. Thread: the context's.
AG_API enum ag_result ag_bake_save_partial(struct ag_bake *bake, const char *path);
/// Adds the finished tasks of such a file, untrusted; ag_bake_run does the rest.
/// Thread: the context's.
AG_API enum ag_result ag_bake_merge(struct ag_bake *bake, const char *path);
struct ag_bake_origin {
    char gi[4096];         ///< GI spec
    char scene_name[4096]; ///< as given to ag_scene_load_with
    uint64_t seed;
    /// Paths per texel of a light map; 0: it is not one. Its merge needs the light of the parts.
    int lightmap_samples;
    float scene_scale;    ///< ag_scene_load_desc.scale
    float lightmap_noise; ///< ag_bake_desc.lightmap_noise
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// The bake that such a file is a part of, for ag_bake_create. Thread: the context's.
AG_API enum ag_result ag_bake_partial_origin(struct ag_context *context, const char *path,
                                             struct ag_bake_origin *out);

/// The result of an update of a light map.
struct ag_bake_update_info {
    uint64_t texels;       ///< of both sides of surfaces
    uint64_t texels_again; ///< of those, baked again
    /// Instances that were moved, added or removed, or whose material has changed.
    int instances_changed;
    bool lights_changed; ///< punctual lights
    double seconds;      ///< of the bake, as in ag_bake_info
    /// Estimated for a bake of all texels as if each took as long as those that were baked again,
    /// which is too long where these have the longer paths; NaN: too few.
    double full_seconds;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Requires a complete bake with ag_bake_desc.update_folder. Thread: the context's.
AG_API enum ag_result ag_bake_get_update(const struct ag_bake *bake,
                                         struct ag_bake_update_info *out);

struct ag_bake_info {
    /// Owned by the bake. technique: as in its file, mrt for drt, which has the same bake.
    const char *technique, *options;
    char key[33];   ///< names what it depends on: a file KEY.safetensors in a cache
    bool complete;  ///< run to its end, or loaded
    double seconds; ///< wall time of all runs; NaN: loaded from a file that does not state it
    uint64_t bytes; ///< of its arrays; 0 until complete
    /// The costliest stage of those that a run with a shard would split now; NULL: what is left
    /// is not worth splitting.
    const char *split_stage;
    int part_count;       ///< see ag_bake_get_part; at least 1
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_bake_get_info(const struct ag_bake *bake, struct ag_bake_info *out);
/// A part of a bake that bakes of other scenes share: of dnrt that of a mesh with its material, its
/// stretch and its pose, which does not depend on the scene. A bake of another technique is one
/// part, whose key is that of the bake. A cache keeps a file for each part.
struct ag_bake_part {
    char key[33];         ///< names what it depends on: a file KEY.safetensors in a cache
    bool complete;        ///< run to its end, or loaded
    bool loaded;          ///< from a file
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// index: 0 to ag_bake_info.part_count − 1. Thread: the context's.
AG_API enum ag_result ag_bake_get_part(const struct ag_bake *bake, int index,
                                       struct ag_bake_part *out);
/// Reads a part, and others that the file has, untrusted; ag_bake_run does the rest.
/// AG_ERROR_FORMAT as for ag_bake_load, or where the file lacks the part. Thread: the context's.
AG_API enum ag_result ag_bake_load_part(struct ag_bake *bake, int index, const char *path);
/// As ag_bake_save, of a part of a complete bake: the same bytes whatever the other parts.
/// Thread: the context's.
AG_API enum ag_result ag_bake_save_part(struct ag_bake *bake, int index, const char *path,
                                        bool record_seconds);
/// The report as a JSON document: technique, options, stages with their seconds, seconds,
/// peak_memory_bytes of the process, bytes, and more members of some techniques. Owned by the bake,
/// valid until the next call with it. Requires a complete bake. Thread: the context's.
AG_API enum ag_result ag_bake_report(struct ag_bake *bake, const char **json);

AG_END

#endif
